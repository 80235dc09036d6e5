"""A database of its own for every test, copied from one that was migrated once."""

import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from affcli.store import Store, open_store


@pytest.fixture(scope="session")
def empty_database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database of this schema without records; nobody writes to it."""
    path = tmp_path_factory.mktemp("store") / "empty.db"
    with open_store(path, create=True, write=True):
        pass
    with closing(sqlite3.connect(path)) as driver:
        # Migrations leave pages on which nothing stands, so that nothing there can be damaged.
        driver.execute("VACUUM")
    return path


@pytest.fixture
def database(empty_database: Path, tmp_path: Path) -> Path:
    """A database without records, for this test alone."""
    return Path(shutil.copy(empty_database, tmp_path / "test.db"))


@pytest.fixture
def store(database: Path) -> Iterator[Store]:
    """`database`, open for writing, without waiting for the disk."""
    with open_store(database, create=False, write=True) as opened:
        opened.database._driver.execute("PRAGMA synchronous = OFF")
        yield opened
