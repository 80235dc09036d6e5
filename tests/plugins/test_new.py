"""``affcli new planner``, ``explorer`` and ``world`` write packages that work at once."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.cli.program import done, names_in, refused
from tests.plugins.conftest import Install

USES = {
    "planner": ("solve", "--goal", "2", "--start", "1", "--planner", "my-own:threshold=0.4"),
    "explorer": ("learn", "--tool", "stick", "--behaviors", "20", "--explorer", "my-own"),
    "world": ("learn", "--tool", "stick", "--behaviors", "20", "--world", "my-own:friction=0.1"),
}


@pytest.mark.parametrize("kind", USES)
def test_a_package_to_begin_with_works_and_keeps_its_contract(
    kind: str, tmp_path: Path, install: Install, learned: Path
) -> None:
    said = done("new", kind, "my-own", cwd=tmp_path).err
    assert f"pip install ./my-own && affcli list {kind}s" in said
    folder = tmp_path / "my-own"
    assert names_in(folder) == ["affcli_my_own.py", "pyproject.toml"]
    project = tomllib.loads((folder / "pyproject.toml").read_text())["project"]
    offered = {k.removeprefix("affcli."): v for k, v in project["entry-points"].items()}
    install("affcli_my_own", (folder / "affcli_my_own.py").read_text(), offered)
    checked = done("check", "--part", kind, "--name", "my-own", "--json").result
    assert {one["outcome"] for one in checked["tests"]} == {"passed"}
    assert checked["part"] == "my-own@affcli-my-own-0.1"
    if kind == "planner":
        done("solve", "--goal", "2", "--planner", "my-own", "--db", learned)
    else:
        done(*USES[kind], "--db", learned)


def test_pip_installs_it_from_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    done("new", "planner", "my-own", cwd=tmp_path)
    site = tmp_path / "site"
    words = ("--no-deps", "--no-build-isolation", "--target", str(site), str(tmp_path / "my-own"))
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "-q", *words]
    subprocess.run(pip, check=True, capture_output=True, stdin=subprocess.DEVNULL)
    monkeypatch.syspath_prepend(site)
    listed = done("list", "planners", "--json").results
    assert {one["name"]: one["package"] for one in listed}["my-own"] == "affcli-my-own-0.1"


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("nested-query", "there is one"),
        ("Mine", "not a name of a part"),
        ("../x", "not a name of a part"),
        ("a:b=1", "not a name of a part"),
        ("a@2", "not a name of a part"),
        ("a" * 41, "not a name of a part"),
        ("2x", "no name for a module of Python"),
        ("class", "no name for a module of Python"),
        ("json", "Python has a module of that name"),
        ("numpy", "Python has a module of that name"),
        ("affcli", "Python has a module of that name"),
    ],
)
def test_a_name_that_no_part_can_have_is_refused(name: str, why: str, tmp_path: Path) -> None:
    assert why in refused(4, "new", "planner", name, cwd=tmp_path)
    assert names_in(tmp_path) == []


def test_nothing_is_written_over(tmp_path: Path) -> None:
    done("new", "world", "ice", cwd=tmp_path)
    before = (tmp_path / "ice" / "affcli_ice.py").read_bytes()
    assert "exists already" in refused(4, "new", "world", "ice", cwd=tmp_path)
    (tmp_path / "ice" / "affcli_ice.py").write_text("# mine")
    done("new", "world", "ice", "--force", cwd=tmp_path)
    assert (tmp_path / "ice" / "affcli_ice.py").read_bytes() == before
    (tmp_path / "file").write_text("")
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "mine.py").write_text("")
    for words in (("src",), ("b", "--out", "src", "--force"), ("b", "--out", "ice", "--force")):
        assert "is not empty" in refused(4, "new", "world", *words, cwd=tmp_path)
    assert names_in(tmp_path / "src") == ["mine.py"]
    assert "name another folder" in refused(4, "new", "world", "b", "--out", "file", cwd=tmp_path)
