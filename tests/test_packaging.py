"""The wheel: built, installed beside nothing of the checkout, and put to work elsewhere."""

import os
import sqlite3
import subprocess
import sys
import sysconfig
import venv
import zipfile
from contextlib import closing
from pathlib import Path

import pytest

import affcli

ROOT = Path(__file__).parents[1]


def ran(*command: str | Path, cwd: Path) -> str:
    """Run a command outside of the checkout and return what it wrote to stdout."""
    kept = {k: v for k, v in os.environ.items() if k not in {"PYTHONPATH", "AFFCLI_DB"}}
    ended = subprocess.run(
        command,
        cwd=cwd,
        env=kept | {"PIP_DISABLE_PIP_VERSION_CHECK": "1"},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert ended.returncode == 0, f"{command}\n{ended.stdout}\n{ended.stderr}"
    return ended.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built with what is installed: no network."""
    folder = tmp_path_factory.mktemp("dist")
    build = ("-m", "build", "--wheel", "--no-isolation", "--outdir", folder, ROOT)
    ran(sys.executable, *build, cwd=folder)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment with the wheel, and the libraries of this one, but not its affcli."""
    folder = tmp_path_factory.mktemp("elsewhere") / "venv"
    venv.create(folder, symlinks=True)
    # A folder that a .pth file names is searched, but its own .pth files, of which one makes the
    # checkout importable, are not read.
    scheme = {"base": str(folder), "platbase": str(folder)}
    packages = Path(sysconfig.get_path("purelib", "venv", scheme))
    (packages / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n")
    python = folder / "bin" / "python"
    install = ("install", "--quiet", "--no-index", "--no-deps", "--force-reinstall", wheel)
    ran(sys.executable, "-m", "pip", "--python", python, *install, cwd=folder)
    return folder


def test_the_wheel_holds_the_program_and_its_migrations(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = next(name for name in names if name.endswith(".dist-info/METADATA"))
        described = archive.read(metadata).decode()
    migrations = {f"affcli/{p.relative_to(ROOT)}" for p in (ROOT / "migrations").rglob("*.py")}
    assert migrations
    assert migrations <= set(names)
    assert "affcli/migrations/script.py.mako" in names
    assert "affcli/py.typed" in names
    modules = {str(path.relative_to(ROOT)) for path in (ROOT / "affcli").rglob("*.py")}
    assert modules <= set(names)
    page = {f"affcli/report/page/{p.name}" for p in (ROOT / "affcli/report/page").glob("*.*")}
    assert {Path(name).suffix for name in page} == {".py", ".j2", ".css", ".js"}
    assert page <= set(names)
    outside = [name for name in names if not name.startswith(("affcli/", "affcli-"))]
    assert outside == []
    assert f"\nVersion: {affcli.__version__}\n" in described
    assert "\nLicense-Expression: MIT\n" in described
    assert any(name.endswith("/licenses/LICENSE") for name in names)


def test_it_works_outside_of_the_checkout(installed: Path, tmp_path: Path) -> None:
    """The migrations of the package make the schema; nothing of the checkout is used."""
    program = installed / "bin" / "affcli"
    where = "import affcli.store.migrate as m; print(m.__file__); print(m.migrations_folder())"
    for line in ran(installed / "bin" / "python", "-c", where, cwd=tmp_path).splitlines():
        assert Path(line).is_relative_to(installed)
    assert ran(program, "--version", cwd=tmp_path) == f"affcli {affcli.__version__}\n"
    ran(program, "learn", "--tool", "stick", "--behaviors", "20", cwd=tmp_path)
    with closing(sqlite3.connect(tmp_path / "affcli.db")) as driver:
        assert driver.execute("SELECT tool, behaviors, status FROM learning_run").fetchall() == [
            ("stick", 20, "done")
        ]
        assert driver.execute("PRAGMA application_id").fetchone()[0] == 0x61666663
    shown = ran(program, "report", cwd=tmp_path)
    assert "Run 1: what the stick affords, by behavior" in shown
    ran(program, "report", "--html", "page.html", cwd=tmp_path)
    page = (tmp_path / "page.html").read_text()
    source = ROOT / "affcli" / "report" / "page"
    for name in ("style.css", "tables.js"):
        assert (source / name).read_text() in page
    assert "<title>What the robot learned: affcli.db</title>" in page
