"""Files that commands write: what links point to, who may read them, and nothing left behind."""

import subprocess
from pathlib import Path

import pytest

from affcli.cli.files import require_new, save
from affcli.errors import BadInputError
from tests.cli.program import (
    PROGRAM,
    ROOT,
    done,
    environment,
    names_in,
    one_printable_line,
    refused,
)


def test_what_a_link_points_to_is_written(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    for name in ("f.svg", "new.svg"):  # one is there, of the other there is only the link
        (tmp_path / name).symlink_to(f"real/{name}")
    (tmp_path / "real" / "f.svg").write_text("what stood there")
    for name in ("f.svg", "new.svg"):
        done("figure", "workspace", "--out", name, "--force", cwd=tmp_path)
        assert (tmp_path / name).is_symlink()
        assert "<svg" in (tmp_path / "real" / name).read_text()
    assert names_in(tmp_path / "real") == ["f.svg", "new.svg"]
    assert names_in(tmp_path) == ["f.svg", "new.svg", "real"]


def test_a_link_into_a_folder_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "a.svg").symlink_to("none/a.svg")
    with pytest.raises(BadInputError, match=r"cannot be written: .*; name another file"):
        save(tmp_path / "a.svg", b"")
    assert (tmp_path / "a.svg").is_symlink()


@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_stdout_is_no_file(name: str, tmp_path: Path) -> None:
    """Whatever it is sent to; who can write to it says how."""
    for dash, says in ((True, "to write to stdout give --out -"), (False, "name a file")):
        with pytest.raises(BadInputError, match=f"{name}: not a file .*; {says}$"):
            require_new(Path(name), force=True, dash=dash)
    refused(4, "figure", "workspace", "--out", name, "--force", cwd=tmp_path)
    assert "give --out -" in refused(4, "table", "export", "--out", name, cwd=tmp_path)


@pytest.mark.parametrize("args", [("doctor",), ("figure", "workspace", "--out", "f.png")])
def test_a_working_folder_that_is_gone_is_one_line(args: tuple[str, ...], tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    script = f'cd "{gone}" && rmdir "{gone}" && exec "$@"'
    ended = subprocess.run(
        ["/bin/sh", "-c", script, "sh", *PROGRAM, *args],
        env=environment(PYTHONPATH=str(ROOT)),
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ended.returncode, ended.stdout) == (4, "")
    assert "the working folder is gone; cd to one" in one_printable_line(ended.stderr)
