"""Upgrades that are killed, that run at once, or that fail."""

import hashlib
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from affcli.errors import DatabaseError
from affcli.store import backup, check, database_info, open_store, upgrade
from affcli.store.database_file import REVISION
from tests.store.processes import ROOT, child, finished

DATABASES = Path(__file__).parent / "databases"
"""A database of every past revision, made by the affcli of its time."""
PAST = [f"{number:04}" for number in range(1, int(REVISION))]


def old_database(revision: str, tmp_path: Path) -> Path:
    """Return a database of a past revision, for this test alone."""
    path = Path(shutil.copy(DATABASES / f"{revision}.db", tmp_path / "old.db"))
    path.chmod(0o644)
    return path


def everything(path: Path) -> str:
    """Return all that a database holds, as SQL."""
    with closing(sqlite3.connect(path)) as driver:
        return "\n".join(driver.iterdump())


def digest(path: Path) -> str:
    """Return what tells one content of a database from another."""
    return hashlib.sha256(everything(path).encode()).hexdigest()


@pytest.mark.fault(9)
@pytest.mark.torture
def test_a_kill_at_any_statement_of_an_upgrade_leaves_the_old_or_the_new(
    tmp_path: Path, torture: bool
) -> None:
    """And each time a copy of the old. From the first revision, so through all migrations."""
    revision = "0001"
    path = old_database(revision, tmp_path)
    upgraded = Path(shutil.copy(path, tmp_path / "upgraded.db"))
    upgrade(upgraded)
    old, new = digest(path), digest(upgraded)
    code, out, err = finished("killed_while_upgrading", path, "1" if torture else "7")
    assert (code, err) == (0, "")
    *deaths, end = [line.split() for line in out.splitlines()]
    assert len(deaths) > 5
    for _, status, found, sound in deaths:
        assert (int(status), found, sound) == (signal.SIGKILL, old, "ok")
    assert end[1:] == ["0", new, "ok"]
    copies = sorted(tmp_path.glob(f"old.db.{revision}*.backup"))
    assert copies
    assert {digest(copy) for copy in copies} == {old}


@pytest.mark.fault(8)
@pytest.mark.fault(9)
def test_eight_upgrades_at_once_are_one_and_its_copy_is_of_the_old(tmp_path: Path) -> None:
    path = old_database("0001", tmp_path)
    old = everything(path)
    with ExitStack() as stack:
        others = [stack.enter_context(child("upgrade_when_told", path)) for _ in range(8)]
        for other in others:
            assert other.stdin is not None
            other.stdin.write("go\n")
            other.stdin.flush()
        said = [other.communicate(timeout=60) for other in others]
    assert [(err, other.returncode) for (_, err), other in zip(said, others, strict=True)] == (
        [("", 0)] * 8
    )
    assert sorted(out.split() for out, _ in said) == (
        [[REVISION]] * 7 + [[REVISION, "old.db.0001.backup"]]
    )
    assert everything(tmp_path / "old.db.0001.backup") == old
    assert database_info(path).revision == REVISION
    assert [finding for finding in check(path) if finding.wrong] == []
    assert sorted(file.name for file in tmp_path.iterdir()) == ["old.db", "old.db.0001.backup"]


@pytest.mark.fault(12)
@pytest.mark.parametrize("revision", PAST)
def test_an_older_affcli_names_the_copy_from_before_the_upgrade(
    revision: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of several the latest; with it the older one goes on."""
    path = old_database(revision, tmp_path)
    old = everything(path)
    path.with_name(f"old.db.{revision}.backup").write_text("of an upgrade before")
    os.utime(path.with_name(f"old.db.{revision}.backup"), (0, 0))
    backup(path, path.with_name("old.db.backup"))
    told: list[Path] = []
    upgrade(path, copied=told.append)
    upgraded = path.read_bytes()
    for module in ("database_file", "opening", "health"):
        monkeypatch.setattr(f"affcli.store.{module}.REVISION", revision)
    for write in (False, True):
        with (
            pytest.raises(DatabaseError) as caught,
            open_store(path, create=write, write=write),
        ):
            pass
        assert caught.value.exit_code == 3
        assert str(caught.value) == (
            f"{path}: its schema is at revision {REVISION}, this affcli knows {revision}: install "
            f"a newer affcli, or go on with {told[0]}, from before the upgrade"
        )
    assert path.read_bytes() == upgraded
    assert everything(told[0]) == old


@pytest.mark.fault(12)
@pytest.mark.parametrize("revision", [*PAST, "base", "-1"])
def test_a_downgrade_is_refused_and_nothing_is_changed(revision: str, tmp_path: Path) -> None:
    """As whoever knows Alembic would ask for it."""
    path = old_database("0003", tmp_path)
    upgrade(path)
    before = path.read_bytes()
    ended = subprocess.run(
        [sys.executable, "-m", "alembic", "downgrade", revision],
        cwd=ROOT,
        env=os.environ | {"AFFCLI_DB": str(path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ended.returncode, ended.stdout) == (3, "")
    (line,) = ended.stderr.splitlines()
    assert line.startswith("affcli: nothing was changed: ")
    assert "FILE.REVISION.backup" in line
    assert path.read_bytes() == before


@pytest.mark.fault(10)
@pytest.mark.parametrize(
    ("added", "says"),
    [
        ("CREATE TABLE verification (mine TEXT)", "table verification already exists"),
        ("ALTER TABLE trial ADD COLUMN sensor TEXT", "duplicate column name: sensor"),
    ],
)
def test_what_a_migration_stumbles_over_is_named_and_the_copy_opens(
    added: str, says: str, tmp_path: Path
) -> None:
    """Something that another program has done to the database."""
    path = old_database("0001", tmp_path)
    with closing(sqlite3.connect(path, isolation_level=None)) as driver:
        driver.execute(added)
    before, told = everything(path), list[Path]()
    with pytest.raises(DatabaseError, match=says) as caught:
        upgrade(path, copied=told.append)
    message = str(caught.value)
    assert message.isprintable()
    assert f"could not be brought from revision 0001 to {REVISION}" in message
    assert str(told[0].name) in message
    assert everything(path) == everything(told[0]) == before


@pytest.mark.fault(10)
@pytest.mark.parametrize(
    "settings", ["{", "", "7", "[]", '{"arm":7}', '{"tools":{"part_width":"wide"}}']
)
@pytest.mark.parametrize(
    ("table", "whose"), [("learning_run", "learning run 3"), ("session", "session 3")]
)
def test_settings_that_cannot_be_read_are_named_and_nothing_is_changed(
    table: str, whose: str, settings: str, tmp_path: Path
) -> None:
    path = old_database("0003", tmp_path)
    with closing(sqlite3.connect(path, isolation_level=None)) as driver:
        driver.execute(f"UPDATE {table} SET settings = ? WHERE id = 3", [settings])
    before = everything(path)
    with pytest.raises(DatabaseError) as caught:
        upgrade(path)
    assert str(caught.value).endswith(
        f"old.db: could not be brought from revision 0003 to {REVISION}: {whose}: settings that "
        "are no JSON of affcli's; restore a copy; it is as it was"
    )
    assert everything(path) == before
