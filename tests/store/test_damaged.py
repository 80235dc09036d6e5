"""Damaged pages: found when the file is opened, or in a large one when they are read."""

import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from affcli.errors import DatabaseError
from affcli.store import Store, check, open_store
from affcli.store.database_file import CHECKED_UP_TO
from tests.factories import learning_spec
from tests.store.records import begun, learned

PAGE = 4096


def answers(store: Store) -> tuple[object, ...]:
    """Return what a report asks a database for."""
    runs = store.learning.runs()
    groups = [store.results.behavior_groups(run.id) for run in runs]
    tables = [list(store.learning.table(run.id)[0]) for run in runs]
    return runs, groups, tables


@pytest.fixture
def large(store: Store) -> Path:
    """A database that is too large to be checked whether it is opened."""
    for seed in range(3):
        learned(store, spec=learning_spec(seed=seed, behaviors=6000), count=6000)
    assert store.path.stat().st_size > CHECKED_UP_TO
    return store.path


@pytest.mark.fault(13)
@pytest.mark.torture
def test_a_flipped_page_of_a_large_file_is_found_or_does_not_matter(
    large: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """A reader gets the right answer or is told that the file is damaged; and `check` finds it."""
    with open_store(large, create=False, write=False) as sound:
        right = answers(sound)
    whole = large.read_bytes()
    pages = range(0, len(whole) // PAGE, 1 if torture else 97)
    noticed = found = 0
    for page in pages:
        place = slice(PAGE * page, PAGE * (page + 1))
        flipped = bytearray(whole)
        flipped[place] = bytes(255 - byte for byte in whole[place])
        large.write_bytes(flipped)
        noticed += not reads(large, right)
        found += damage_is_found(large)
        assert large.read_bytes() == flipped
    assert found == len(pages)
    assert noticed
    tell(
        f"{len(pages)} pages flipped one by one, {found} found by the check, {noticed} by a report"
    )


def reads(path: Path, right: tuple[object, ...]) -> bool:
    """Tell whether the right answers come; false when damage is told of instead."""
    try:
        with open_store(path, create=False, write=False) as store:
            got = answers(store)
    except DatabaseError:
        return False
    assert got == right
    return True


def damage_is_found(path: Path) -> bool:
    """Tell whether the check of the whole file finds something."""
    try:
        return any(finding.wrong for finding in check(path))
    except DatabaseError:
        return True


@pytest.mark.fault(13)
def test_a_damaged_name_that_sqlite_quotes_is_damage(database: Path) -> None:
    """Python's driver cannot decode what SQLite says then."""
    whole = database.read_bytes()
    spoilt = whole.replace(b"CREATE VIEW affordance_wide", b"CREATE VIEX affordance_wide")
    database.write_bytes(spoilt.replace(b"affordance_wide", b"affordance\xd2wide"))
    for write in (False, True):
        with (
            pytest.raises(DatabaseError, match=f"^{database}: damaged; restore a copy"),
            open_store(database, create=False, write=write),
        ):
            pytest.fail("it was opened")


def test_a_table_that_another_one_names_in_vain_is_damage(database: Path) -> None:
    """Emptied of its columns: SQLite finds that out when a row is to refer to it."""
    with closing(sqlite3.connect(database)) as driver, driver:
        driver.execute("DROP TABLE experiment")
        driver.execute("CREATE TABLE experiment (x)")
    with (
        open_store(database, create=False, write=True) as store,
        pytest.raises(DatabaseError, match=f"^{database}: damaged, .*foreign key mismatch"),
    ):
        begun(store, "reproduce")
