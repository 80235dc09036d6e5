"""What may stand at a path, and what is refused there (faults 11, 13, 14, 15)."""

import os
import sqlite3
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

import affcli.store
from affcli.errors import DatabaseError
from affcli.store import check, database_info, open_store, opening, run_sql, upgrade
from affcli.store.database_file import REVISION
from affcli.store.journal import journal_mode_for
from affcli.store.waiting import ATTEMPT
from tests.store.records import learned


def read(path: Path) -> None:
    with open_store(path, create=False, write=False) as store:
        store.learning.runs()


def write(path: Path) -> None:
    with open_store(path, create=True, write=True) as store:
        learned(store)


def query(path: Path) -> None:
    run_sql(path, "select 1")


EVERY_WAY = (read, write, query, database_info, upgrade)
READING = (read, query, database_info, upgrade)
Way = Callable[[Path], object]


def names_in(folder: Path) -> list[str]:
    """Return what is in a folder."""
    return [path.name for path in folder.iterdir()]


def refused(way: Way, path: Path, words: str) -> None:
    """Check that `way` is refused in one line that says `words`, and changes nothing."""
    before = path.read_bytes()
    with pytest.raises(DatabaseError, match=words) as caught:
        way(path)
    assert len(str(caught.value).splitlines()) == 1
    assert path.read_bytes() == before
    assert names_in(path.parent) == [path.name]


@pytest.mark.fault(15)
@pytest.mark.parametrize("way", READING)
def test_a_missing_file_is_not_made_by_reading(way: Way, tmp_path: Path) -> None:
    with pytest.raises(DatabaseError, match="no database there; `affcli learn` makes one"):
        way(tmp_path / "none.db")
    assert not names_in(tmp_path)


def test_a_file_that_goes_while_it_is_opened_is_not_made_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is looked for first, and can go after that."""
    monkeypatch.setattr(opening, "require_place", lambda *_, **__: None)
    with pytest.raises(DatabaseError), open_store(tmp_path / "gone.db", create=False, write=True):
        raise AssertionError
    assert not names_in(tmp_path)


def test_a_missing_file_is_made_by_writing(tmp_path: Path) -> None:
    write(tmp_path / "new.db")
    read(tmp_path / "new.db")
    assert names_in(tmp_path) == ["new.db"]


@pytest.mark.fault(14)
def test_an_empty_file_is_initialised_by_writing(tmp_path: Path) -> None:
    path = tmp_path / "empty.db"
    path.touch()
    write(path)
    assert database_info(path).counts["learning runs"] == 1


@pytest.mark.fault(14)
@pytest.mark.parametrize("way", READING)
def test_an_empty_file_stays_empty_when_read(way: Way, tmp_path: Path) -> None:
    path = tmp_path / "empty.db"
    path.touch()
    refused(way, path, "an empty file")


@pytest.mark.fault(13)
@pytest.mark.parametrize("way", EVERY_WAY)
@pytest.mark.parametrize(
    "content", [b"x", b"not a database\n" * 500, b"\0" * 4096, os.urandom(999)]
)
def test_what_is_no_database_is_refused(way: Way, content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_bytes(content)
    refused(way, path, "not a SQLite database")


@pytest.mark.fault(13)
@pytest.mark.parametrize("way", EVERY_WAY)
def test_a_truncated_database_is_refused(way: Way, database: Path) -> None:
    write(database)
    whole = database.read_bytes()
    for length in (*range(100, len(whole), 4999), len(whole) - 4096, len(whole) - 1):
        database.write_bytes(whole[:length])
        refused(way, database, "damaged|not a SQLite database")


@pytest.mark.fault(13)
@pytest.mark.parametrize("way", [read, write, query])
def test_a_flipped_page_is_found(way: Way, database: Path) -> None:
    write(database)
    whole = database.read_bytes()
    for page in range(len(whole) // 4096):
        place = slice(4096 * page, 4096 * (page + 1))
        flipped = bytearray(whole)
        flipped[place] = bytes(255 - byte for byte in whole[place])
        database.write_bytes(flipped)
        refused(way, database, "damaged|not a SQLite database|another program")


@pytest.mark.fault(14)
@pytest.mark.parametrize("way", EVERY_WAY)
@pytest.mark.parametrize(
    "statement",
    [
        "CREATE TABLE learning_run (id INTEGER)",
        "CREATE TABLE alembic_version (version_num TEXT)",
        "PRAGMA application_id = 7",
    ],
)
def test_another_programs_database_is_refused(way: Way, statement: str, tmp_path: Path) -> None:
    path = tmp_path / "other.db"
    with sqlite3.connect(path) as other:
        other.execute(statement)
    other.close()
    refused(way, path, "another program")


def stand_at(database: Path, revision: str) -> None:
    """Make the database say that its schema is at `revision`."""
    with sqlite3.connect(database) as driver:
        driver.execute("UPDATE alembic_version SET version_num = ?", [revision])
    driver.close()


@pytest.mark.fault(11)
@pytest.mark.parametrize("way", [read, write, query, upgrade])
@pytest.mark.parametrize("revision", ["0099", "ae1027a6acf", "9" * 5000, ""])
def test_a_schema_from_the_future_is_refused(way: Way, revision: str, database: Path) -> None:
    stand_at(database, revision)
    refused(way, database, f"at revision {revision[:9]}.*, this affcli knows {REVISION}")


@pytest.mark.parametrize("way", [read, write, query])
def test_an_older_schema_names_the_command_that_mends_it(way: Way, database: Path) -> None:
    stand_at(database, "0000")
    refused(way, database, f"at revision 0000, this affcli needs {REVISION}: run `affcli db upgra")


@pytest.mark.parametrize("way", EVERY_WAY)
@pytest.mark.parametrize(
    ("statement", "missing"),
    [
        ("DELETE FROM alembic_version", "alembic_version"),
        ("DROP TABLE alembic_version", "alembic_version"),
        ("DROP VIEW affordance_wide", "affordance_wide"),
        ("DROP TABLE step", "step"),
    ],
)
def test_what_somebody_took_away_is_named(
    way: Way, statement: str, missing: str, database: Path
) -> None:
    with sqlite3.connect(database) as driver:
        driver.execute(statement)
    driver.close()
    refused(way, database, f"damaged, its {missing} is missing; restore a copy")


def test_info_looks_at_any_revision(database: Path) -> None:
    write(database)
    info = database_info(database)
    assert (info.revision, info.code_revision) == (REVISION, REVISION)
    assert info.counts == {
        "experiments": 0,
        "sessions": 0,
        "learning runs": 1,
        "behaviors": 9,
        "affordances": 3,
        "trials": 0,
        "steps": 0,
        "verifications": 0,
        "replications": 0,
    }
    stand_at(database, "0099")
    assert database_info(database).revision == "0099"
    assert database_info(database).counts == {}


@pytest.mark.parametrize("way", EVERY_WAY)
def test_only_a_file_can_be_a_database(way: Way, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, Path("/dev/null"), tmp_path / "pipe"):
        with pytest.raises(DatabaseError, match="not a file"):
            way(path)


@pytest.mark.fault(21)
@pytest.mark.parametrize("way", EVERY_WAY)
@pytest.mark.parametrize("name", ["nul\0byte.db", "lone\ud800surrogate.db", "x" * 5000, "a/b/c.db"])
def test_impossible_paths_are_refused_in_one_line(way: Way, name: str, tmp_path: Path) -> None:
    with pytest.raises(DatabaseError) as caught:
        way(tmp_path / name)
    assert str(caught.value).isprintable()
    assert not names_in(tmp_path)


@pytest.mark.parametrize("name", ["50% of #1?.db", "two words.db", "päck.db", "a=b&mode=ro"])
def test_a_path_may_hold_what_a_uri_would_misread(name: str, tmp_path: Path) -> None:
    write(tmp_path / name)
    read(tmp_path / name)
    query(tmp_path / name)
    assert names_in(tmp_path) == [name]


def test_reading_changes_nothing(database: Path) -> None:
    write(database)
    before = database.read_bytes()
    for way in READING:
        way(database)
    assert database.read_bytes() == before


def test_a_store_opened_to_read_refuses_to_write(database: Path) -> None:
    with (
        open_store(database, create=False, write=False) as store,
        pytest.raises(DatabaseError, match="read-only"),
    ):
        learned(store)


@pytest.mark.parametrize(
    ("version", "mode"),
    [
        ((3, 37, 2), "delete"),
        ((3, 40, 1), "delete"),
        ((3, 44, 5), "delete"),
        ((3, 44, 6), "wal"),
        ((3, 45, 0), "delete"),
        ((3, 50, 6), "delete"),
        ((3, 50, 7), "wal"),
        ((3, 51, 0), "delete"),
        ((3, 51, 2), "delete"),
        ((3, 51, 3), "wal"),
        ((3, 52, 0), "wal"),
    ],
)
def test_wal_only_where_sqlite_mended_it(version: tuple[int, int, int], mode: str) -> None:
    assert journal_mode_for(version) == mode


def test_wal_is_used_and_left_again(database: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("affcli.store.journal.journal_mode_for", lambda version: "wal")
    write(database)
    assert database_info(database).journal_mode == "wal"
    read(database)
    query(database)
    monkeypatch.setattr("affcli.store.journal.journal_mode_for", lambda version: "delete")
    with open_store(database, create=False, write=True):
        pass
    assert database_info(database).journal_mode == "delete"


@pytest.mark.fault(5)
@pytest.mark.parametrize("way", [read, write, query, database_info, check, upgrade])
def test_every_way_in_waits_for_a_lock(way: Way, database: Path) -> None:
    """Another process commits meanwhile, and lets nobody read for longer than SQLite waits."""
    other = sqlite3.connect(database, isolation_level=None, check_same_thread=False)
    other.execute("BEGIN EXCLUSIVE")
    giving_back = threading.Timer(2 * ATTEMPT, other.execute, ["COMMIT"])
    giving_back.start()
    way(database)
    giving_back.join()
    other.close()


@pytest.mark.parametrize("name", affcli.store.__all__)
def test_the_room_has_each_name_that_it_promises(name: str) -> None:
    """They are imported when they are first asked for."""
    assert getattr(affcli.store, name) is not None
