"""What can be relied on where a database lies (fault 17)."""

import os
import re
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from affcli.store import Fact, database_info, environment, environment_facts
from affcli.store.database_file import REVISION
from affcli.store.environment import file_system

MOUNTS = """\
/dev/sda1 / ext4 rw 0 0
server:/home /home nfs4 rw 0 0
/dev/sdb1 /home/local xfs rw 0 0
//nas/lab /mnt/the\\040lab cifs rw 0 0
"""


def facts(path: Path) -> dict[str, Fact]:
    """Return what is said of a place; whatever is not well comes with what to do about it."""
    found = environment_facts(path)
    for fact in found:
        assert fact.value
        assert (
            fact.state == "ok"
            or fact.remedy
            or re.search(r"[:;] (?:run|install|name) ", fact.value)
        )
    return {fact.what: fact for fact in found}


@pytest.mark.fault(17)
@pytest.mark.parametrize(
    ("folder", "kind"),
    [("/var", "ext4"), ("/home/me", "nfs4"), ("/home/local/me", "xfs"), ("/mnt/the lab/x", "cifs")],
)
def test_the_file_system_is_that_of_the_innermost_mount(folder: str, kind: str) -> None:
    assert file_system(Path(folder), MOUNTS) == kind
    assert file_system(Path(folder), "") == ""


def test_here_all_is_well(database: Path) -> None:
    found = facts(database)
    assert set(found) == {"SQLite", "file system", "disk", "permissions", "database"}
    assert {fact.state for fact in found.values()} == {"ok"}
    assert not any(fact.remedy for fact in found.values())


@pytest.mark.fault(17)
@pytest.mark.parametrize(
    "kind",
    [
        *("nfs", "nfs4", "cifs", "smb3", "smbfs", "ncpfs"),
        *("afs", "9p", "lustre", "gpfs", "fuse.sshfs"),
    ],
)
def test_a_network_file_system_is_pointed_out(
    kind: str, database: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(environment, "file_system", lambda folder, mounts: kind)
    found = facts(database)["file system"]
    assert found.state == "look"
    assert "keep the database on a local disk" in found.remedy


@pytest.mark.fault(17)
def test_a_write_ahead_log_that_this_sqlite_cannot_be_trusted_with(
    database: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for mode, says in (("wal", "writers use a write-ahead"), ("delete", "not a write-ahead log")):
        monkeypatch.setattr(environment, "journal_mode_for", lambda version, mode=mode: mode)
        assert says in facts(database)["SQLite"].value
    info = database_info(database)
    changed = type(info)(**{f: getattr(info, f) for f in info.__slots__} | {"journal_mode": "wal"})
    monkeypatch.setattr(environment, "database_info", lambda path: changed)
    assert facts(database)["database"].state == "look"


def test_what_must_be_mended_says_how(database: Path, tmp_path: Path) -> None:
    nowhere = facts(tmp_path / "no" / "x.db")["folder"]
    assert (nowhere.state, nowhere.value) == ("bad", f"{tmp_path / 'no'}: does not exist")
    junk = tmp_path / "junk.db"
    junk.write_text("not a database, but longer than a header " * 20)
    assert facts(junk)["database"].state == "bad"
    old = tmp_path / "old.db"
    old.write_bytes((Path(__file__).parent / "databases" / "0001.db").read_bytes())
    assert facts(old)["database"].value.endswith(": run `affcli db upgrade`")
    assert facts(tmp_path / "new.db")["database"].state == "ok"
    assert not (tmp_path / "new.db").exists()


@pytest.mark.parametrize(("version", "state"), [((3, 36, 9), "look"), ((3, 37, 0), "ok")])
def test_an_sqlite_without_strict_tables_is_pointed_out(
    version: tuple[int, ...], state: str, database: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sqlite3, "sqlite_version_info", version)
    found = facts(database)["SQLite"]
    assert (found.state, found.value.partition(";")[0]) == (state, ".".join(map(str, version)))


@pytest.mark.parametrize("refused", ["folder", "file"])
def test_a_place_that_cannot_be_written_is_pointed_out(
    refused: str, database: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed = {"folder": database.parent, "file": database}[refused]
    monkeypatch.setattr(os, "access", lambda path, mode: mode != os.W_OK or path != closed)
    assert facts(database)["permissions"].state == "look"


def test_a_database_of_a_newer_affcli_is_pointed_out(database: Path) -> None:
    with closing(sqlite3.connect(database)) as driver, driver:
        driver.execute("UPDATE alembic_version SET version_num = '9999'")
    found = facts(database)["database"]
    assert found.state == "bad"
    assert found.value.endswith(": install a newer affcli")
    assert "its schema is at revision 9999" in found.value
    copy = database.with_name(f"{database.name}.{REVISION}.backup")
    copy.touch()
    said = facts(database)["database"].value
    assert said.endswith(f": install a newer affcli, or go on with {copy}, from before the upgrade")


def test_little_room_is_pointed_out(database: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(environment, "LITTLE_SPACE", 10**18)
    assert facts(database)["disk"].state == "look"
