"""Databases that were learned once; every test works on a copy of its own."""

import shutil
from pathlib import Path

import pytest

from affcli.store import open_store
from tests.cli.program import done

IMPATIENT = "[trial]\nmax_steps = 6\n"
"""Trials are given up soon."""
LEISURELY = f"[motion]\nhold = 25.0\n{IMPATIENT}"
"""The robot stands still for so long, too, that an hour holds some seventy behaviors."""


@pytest.fixture(scope="session")
def impatient(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Settings with which trials are short: every step is saved by itself, which takes time."""
    path = tmp_path_factory.mktemp("settings") / "impatient.toml"
    path.write_text(IMPATIENT)
    return path


@pytest.fixture(scope="session")
def leisurely(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Settings with which an hour, and a whole life, is computed in a moment."""
    path = tmp_path_factory.mktemp("settings") / "leisurely.toml"
    path.write_text(LEISURELY)
    return path


@pytest.fixture(scope="session")
def _empty(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("cli") / "empty.db"
    with open_store(path, create=True, write=True):
        pass
    return path


@pytest.fixture(scope="session")
def _learned(impatient: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("cli") / "learned.db"
    tools = ("--tool", "t-hook", "--tool", "stick", "--behaviors", "800")
    done("learn", *tools, "--config", impatient, "--db", path)
    return path


@pytest.fixture(scope="session")
def _used(_learned: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = Path(shutil.copy(_learned, tmp_path_factory.mktemp("cli") / "used.db"))
    done("solve", "--goal", "2", "--db", path)
    done("break-tool", "--db", path)
    return path


@pytest.fixture(scope="session")
def _reproduced(leisurely: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("cli") / "reproduced.db"
    done("reproduce", "--robots", "2", "--workers", "1", "--config", leisurely, "--db", path)
    return path


@pytest.fixture
def empty(_empty: Path, tmp_path: Path) -> Path:
    """A database without records, for this test alone."""
    return Path(shutil.copy(_empty, tmp_path / "empty.db"))


@pytest.fixture
def learned(_learned: Path, tmp_path: Path) -> Path:
    """A database in which a robot learned the T-hook and the stick, for this test alone."""
    return Path(shutil.copy(_learned, tmp_path / "learned.db"))


@pytest.fixture
def used(_used: Path, tmp_path: Path) -> Path:
    """`learned` after goal 2 was tried with both tools and the T-hook broke."""
    return Path(shutil.copy(_used, tmp_path / "used.db"))


@pytest.fixture
def reproduced(_reproduced: Path, tmp_path: Path) -> Path:
    """A database with a reproduction of two leisurely robots, for this test alone."""
    return Path(shutil.copy(_reproduced, tmp_path / "reproduced.db"))
