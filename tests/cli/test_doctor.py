"""``affcli doctor``, ``db backup`` and ``db check`` as commands."""

import shutil
import sqlite3
from pathlib import Path

from tests.cli.program import contents, done, names_in, refused

OLD = Path(__file__).parents[1] / "store" / "databases" / "0001.db"


def test_the_doctor_tells_what_is_here(learned: Path) -> None:
    found = {fact["what"]: fact for fact in done("doctor", "--db", learned, "--json").json}
    assert found["packages"]["value"].startswith("numpy 2")
    assert {fact["state"] for fact in found.values()} == {"ok"}
    shown = done("doctor", "--db", learned, COLUMNS="40").out
    assert all(len(line) <= 40 for line in shown.splitlines())


def test_the_doctor_says_what_to_do_and_fails(tmp_path: Path) -> None:
    old = shutil.copy(OLD, tmp_path / "old.db")
    ended = refused_with_output(3, "doctor", "--db", old)
    assert "affcli db upgrade" in " ".join(ended.split())


def refused_with_output(code: int, *args: str | Path) -> str:
    """Run a command that ends with this code, and return what it wrote to stdout."""
    from tests.cli.program import affcli

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
        finding["wrong"] == 0 for finding in done("db", "check", "--db", learned, "--json").json
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
