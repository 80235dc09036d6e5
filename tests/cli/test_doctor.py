"""``affcli doctor``, ``db backup`` and ``db check`` as commands."""

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from affcli.store.journal import journal_mode_for
from tests.cli.program import affcli, contents, done, names_in, refused, rows

OLD = Path(__file__).parents[1] / "store" / "databases" / "0001.db"


def test_the_doctor_tells_what_is_here(learned: Path) -> None:
    found = {fact["what"]: fact for fact in done("doctor", "--db", learned, "--json").results}
    assert found["packages"]["value"].startswith("numpy 2")
    assert {fact["state"] for fact in found.values()} == {"ok"}
    shown = done("doctor", "--db", learned, COLUMNS="40").out
    assert all(len(line) <= 40 for line in shown.splitlines())


@pytest.mark.fault(17)
@pytest.mark.skipif(
    journal_mode_for(sqlite3.sqlite_version_info) == "wal", reason="this SQLite is mended"
)
def test_the_doctor_points_out_a_write_ahead_log_that_is_not_safe_here(learned: Path) -> None:
    """As another program, or a newer SQLite, may leave one."""
    with closing(sqlite3.connect(learned)) as driver:
        driver.execute("PRAGMA journal_mode = wal")
        ended = done("doctor", "--db", learned, "--json")
    (fact,) = (fact for fact in ended.results if fact["what"] == "database")
    assert (fact["state"], "journal mode wal" in fact["value"]) == ("look", True)
    assert "one process at a time" in fact["remedy"]
    done("learn", "--tool", "l-stick", "--behaviors", "5", "--db", learned)
    assert rows(learned, "PRAGMA journal_mode") == [("delete",)]


@pytest.mark.fault(10)
def test_an_upgrade_that_fails_is_one_line_after_the_name_of_the_copy(tmp_path: Path) -> None:
    old = Path(shutil.copy(OLD, tmp_path / "old.db"))
    old.chmod(0o644)
    with closing(sqlite3.connect(old)) as driver:
        driver.execute("CREATE TABLE verification (mine TEXT)")
    before = contents(old)
    ended = affcli("db", "upgrade", "--db", old)
    assert ended.code == 3
    copied, failed = ended.err.splitlines()
    copy = Path(copied.removeprefix("a copy of it as it was: "))
    assert copy == tmp_path / "old.db.0001.backup"
    assert f"{old}: could not be brought from revision 0001 to " in failed
    assert "table verification already exists" in failed
    assert contents(old) == contents(copy) == before
    with closing(sqlite3.connect(copy)) as driver:  # what its owner does next
        driver.execute("DROP TABLE verification")
    done("db", "upgrade", "--db", copy)
    done("db", "check", "--db", copy)


def test_the_doctor_says_what_to_do_and_fails(tmp_path: Path) -> None:
    old = shutil.copy(OLD, tmp_path / "old.db")
    ended = refused_with_output(3, "doctor", "--db", old)
    assert "affcli db upgrade" in " ".join(ended.split())


def refused_with_output(code: int, *args: str | Path) -> str:
    """Run a command that ends with this code, and return what it wrote to stdout."""
    ended = affcli(*args)
    assert ended.code == code
    return ended.out


def test_a_backup_is_made_beside_the_database_and_never_over_something(learned: Path) -> None:
    said = done("db", "backup", "--db", learned).err
    copy = learned.with_name(f"{learned.name}.backup")
    assert str(copy) in said.replace("\n", "")
    assert contents(copy) == contents(learned)
    assert "exists already" in refused(4, "db", "backup", "--db", learned)
    done("db", "backup", "--db", learned, "--force")
    done("report", "--db", copy)
    assert "exists already" in refused(4, "db", "backup", "--db", learned, "--out", learned)
    assert "itself" in refused(3, "db", "backup", "--db", learned, "--out", learned, "--force")
    assert names_in(learned.parent) == sorted([learned.name, copy.name])


def test_check_ends_with_3_when_something_is_wrong(learned: Path) -> None:
    assert all(
        finding["wrong"] == 0 for finding in done("db", "check", "--db", learned, "--json").results
    )
    driver = sqlite3.connect(learned, isolation_level=None)
    driver.execute("update affordance set times_used = 7 where id = 1")
    driver.close()
    shown = refused_with_output(3, "db", "check", "--db", learned)
    assert "1 times not" in shown
    assert "affordance 1" in shown


def test_an_upgrade_names_the_copy_it_made(tmp_path: Path) -> None:
    old = Path(shutil.copy(OLD, tmp_path / "old.db"))
    old.chmod(0o644)
    said = done("db", "upgrade", "--db", old).err
    assert f"a copy of it as it was: {old}.0001.backup" in said
    assert names_in(tmp_path) == ["old.db", "old.db.0001.backup"]
    done("db", "check", "--db", old)
    done("solve", "--goal", "4", "--start", "all", "--tool", "t-hook", "--db", old)
