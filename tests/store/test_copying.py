"""Copies of a database: at one moment, sound, whole or not at all (faults 10, 18)."""

import resource
import shutil
import sqlite3
from pathlib import Path

import pytest

from affcli.errors import DatabaseError
from affcli.store import Store, backup, check, open_store, run_sql, upgrade
from affcli.store.database_file import REVISION
from tests.store.processes import child
from tests.store.records import LONG_RUN, NOW, VERSIONS, learned

OLD = Path(__file__).parent / "databases" / "0001.db"


def tables(path: Path) -> list[str]:
    """Return the whole database as SQL text."""
    with sqlite3.connect(path) as driver:
        text = list(driver.iterdump())
    driver.close()
    return text


def test_a_copy_holds_what_the_database_holds(store: Store, tmp_path: Path) -> None:
    learned(store)
    backup(store.path, tmp_path / "copy.db")
    assert tables(tmp_path / "copy.db") == tables(store.path)
    assert [p.name for p in tmp_path.iterdir() if p.name.startswith(".")] == []
    with open_store(tmp_path / "copy.db", create=False, write=True) as copy:
        assert copy.learning.runs() == store.learning.runs()


@pytest.mark.fault(18)
def test_a_copy_taken_while_others_write_is_of_one_moment(database: Path, tmp_path: Path) -> None:
    """Fault 18: a run saves chunk after chunk meanwhile; counts and chunks agree in every copy."""
    with open_store(database, create=False, write=True) as store:
        run = store.learning.begin(LONG_RUN, VERSIONS, NOW)
    seen: list[object] = []
    with child("append_in_chunks", database) as writer:
        assert writer.stdin is not None
        writer.stdin.write("go\n")
        writer.stdin.flush()
        while writer.poll() is None:
            copy = tmp_path / f"copy{len(seen)}.db"
            backup(database, copy)
            ((count, behaviors),) = run_sql(
                copy,
                "select (select count(*) from behavior), behaviors from learning_run "
                f"where id = {run.id}",
            ).rows
            assert count == behaviors
            assert all(finding.wrong == 0 for finding in check(copy))
            seen.append(behaviors)
        assert writer.communicate(timeout=60)[1] == ""
    assert seen
    assert seen == sorted(seen)  # type: ignore[type-var]


@pytest.mark.fault(10)
def test_before_an_upgrade_a_copy_is_made_and_named(tmp_path: Path) -> None:
    old = Path(shutil.copy(OLD, tmp_path / "old.db"))
    old.chmod(0o644)
    before, told = tables(old), list[Path]()
    upgrade(old, copied=told.append)
    assert told == [tmp_path / "old.db.0001.backup"]
    assert tables(told[0]) == before
    upgrade(old, copied=told.append)
    assert len(told) == 1
    # The copy can be put back, and is upgraded like the first; the copies keep apart.
    shutil.copy(told[0], old)
    assert upgrade(old, copied=told.append) == ("0001", REVISION)
    assert told[1] == tmp_path / "old.db.0001-2.backup"


@pytest.mark.fault(10)
def test_when_a_migration_fails_the_copy_was_named_before_and_opens(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Fault 10."""
    old = Path(shutil.copy(OLD, tmp_path / "old.db"))
    old.chmod(0o644)
    before, told = tables(old), list[Path]()

    def fails(connection: object) -> None:
        raise RuntimeError("a migration with a mistake in it")

    monkeypatch.setattr("affcli.store.opening.run_migrations", fails)
    with pytest.raises(RuntimeError, match="with a mistake"):
        upgrade(old, copied=told.append)
    assert tables(old) == before
    assert tables(told[0]) == before


@pytest.mark.parametrize("size", [0, 100, 20_000])
def test_a_damaged_database_is_not_copied(size: int, store: Store, tmp_path: Path) -> None:
    learned(store, 40)
    torn = tmp_path / "torn.db"
    torn.write_bytes(store.path.read_bytes()[:size])
    with pytest.raises(DatabaseError, match=r"torn\.db"):
        backup(torn, tmp_path / "copy.db")
    assert not (tmp_path / "copy.db").exists()


def test_what_is_not_there_is_not_copied(tmp_path: Path) -> None:
    with pytest.raises(DatabaseError, match=r"no\.db: no database there"):
        backup(tmp_path / "no.db", tmp_path / "copy.db")
    assert list(tmp_path.iterdir()) == []


def test_a_copy_does_not_replace_its_own_original(database: Path) -> None:
    before = database.read_bytes()
    with pytest.raises(DatabaseError, match="that is the database itself"):
        backup(database, database)
    assert database.read_bytes() == before


def test_where_no_copy_can_be_written_none_is(database: Path, tmp_path: Path) -> None:
    with pytest.raises(DatabaseError, match="no copy can be written there"):
        backup(database, tmp_path / "nowhere" / "copy.db")


@pytest.mark.fault(4)
def test_on_a_full_disk_what_stood_there_is_kept(store: Store, tmp_path: Path) -> None:
    learned(store, 60)
    copy = tmp_path / "copy.db"
    copy.write_text("what stood there")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (30_000, before[1]))
    try:
        with pytest.raises(DatabaseError, match="disk"):
            backup(store.path, copy)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert copy.read_text() == "what stood there"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["copy.db", "test.db"]
