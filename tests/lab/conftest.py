"""A database of its own for every test of this folder."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from affcli.store import Store, open_store


@pytest.fixture(scope="session")
def migrated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database without records, which nobody writes to."""
    path = tmp_path_factory.mktemp("lab") / "empty.db"
    with open_store(path, create=True, write=True):
        pass
    return path


@pytest.fixture
def store(migrated: Path, tmp_path: Path) -> Iterator[Store]:
    """A database without records, open for writing, without waiting for the disk."""
    path = Path(shutil.copy(migrated, tmp_path / "lab.db"))
    with open_store(path, create=False, write=True) as opened:
        opened.database._driver.execute("PRAGMA synchronous = OFF")
        yield opened
