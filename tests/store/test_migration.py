"""Migrations: where they are found, what they leave, what they need (faults 9, 11)."""

import re
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

import affcli
from affcli.errors import DatabaseError
from affcli.store import database_info, open_store, run_sql, upgrade
from affcli.store.database_file import REVISION
from affcli.store.migrate import migrations_folder
from tests.store.records import learned

LATER = f"{int(REVISION) + 1:04}"
"""The revision that comes after the newest."""
NEXT = f"""
from alembic import op

revision = "{LATER}"
down_revision = "{REVISION}"
branch_labels = depends_on = None


def upgrade() -> None:
    op.execute("ALTER TABLE learning_run ADD COLUMN remark TEXT")
    op.execute("CREATE TABLE later (id INTEGER PRIMARY KEY)")
    {{more}}
"""


@pytest.fixture
def later_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A later version of affcli, with a folder of migrations that holds one more."""
    folder = tmp_path / "100% later" / "migrations"
    shutil.copytree(migrations_folder(), folder, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "versions" / f"{LATER}_next.py").write_text(NEXT.format(more=""))
    monkeypatch.setattr("affcli.store.migrate.migrations_folder", lambda: folder)
    for module in ("database_file", "opening", "health"):
        monkeypatch.setattr(f"affcli.store.{module}.REVISION", LATER)
    return folder


def schema(path: Path) -> list[tuple[object, ...]]:
    """Return all definitions of a database."""
    return list(run_sql_raw(path, "SELECT type, name, sql FROM sqlite_master ORDER BY name"))


def run_sql_raw(path: Path, text: str) -> list[tuple[object, ...]]:
    """Run a query without affcli."""
    driver = sqlite3.connect(path)
    rows = driver.execute(text).fetchall()
    driver.close()
    return rows


def test_the_code_reads_the_newest_revision() -> None:
    versions = (migrations_folder() / "versions").glob("*.py")
    assert max(path.name[:4] for path in versions) == REVISION


def test_revisions_are_numbers_in_a_row() -> None:
    for path in (migrations_folder() / "versions").glob("*.py"):
        text = path.read_text()
        assert re.search(rf'^revision = "{path.name[:4]}"$', text, re.MULTILINE)
        before = int(path.name[:4]) - 1
        down = f'"{before:04}"' if before else "None"
        assert re.search(rf"^down_revision = {down}$", text, re.MULTILINE)


def test_packaged_migrations_go_before_those_of_the_checkout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    checkout = migrations_folder()
    package = tmp_path / "site" / "affcli"
    for folder in (package / "migrations", package.parent / "migrations"):
        folder.mkdir(parents=True)
    monkeypatch.setattr(affcli, "__file__", str(package / "__init__.py"))
    with pytest.raises(DatabaseError, match="migrations are missing; install it again"):
        migrations_folder()
    (package.parent / "migrations" / "env.py").touch()
    assert migrations_folder() == package.parent / "migrations"
    (package / "migrations" / "env.py").touch()
    assert migrations_folder() == package / "migrations"
    assert checkout == Path(__file__).parents[2] / "migrations"


def test_an_older_database_is_upgraded_and_then_used(database: Path, later_code: Path) -> None:
    with pytest.raises(DatabaseError, match=f"at revision {REVISION}, this affcli needs {LATER}"):
        run_sql(database, "select 1")
    assert upgrade(database) == (REVISION, LATER)
    assert upgrade(database) == (LATER, LATER)
    assert database_info(database).revision == LATER
    with open_store(database, create=False, write=True) as store:
        learned(store)
    assert run_sql(database, "select count(*) from later").rows == ((0,),)


def test_a_new_database_gets_all_revisions(tmp_path: Path, later_code: Path) -> None:
    with open_store(tmp_path / "new.db", create=True, write=True):
        pass
    assert database_info(tmp_path / "new.db").revision == LATER


def test_an_older_schema_is_not_upgraded_unasked(database: Path, later_code: Path) -> None:
    before = database.read_bytes()
    with (
        pytest.raises(DatabaseError, match="run `affcli db upgrade`"),
        open_store(database, create=True, write=True),
    ):
        pass
    assert database.read_bytes() == before


@pytest.mark.fault(10)
def test_a_migration_that_fails_leaves_the_old_schema(database: Path, later_code: Path) -> None:
    before = schema(database)
    broken = later_code / "versions" / f"{LATER}_next.py"
    broken.write_text(NEXT.format(more='op.execute("INSERT INTO nowhere VALUES (1)")'))
    with pytest.raises(Exception, match="no such table: nowhere"):
        upgrade(database)
    assert schema(database) == before
    assert run_sql_raw(database, "SELECT version_num FROM alembic_version") == [(REVISION,)]


LOADED = """
import sys
from pathlib import Path
from affcli.store import pack_robot, run_sql
path = Path(sys.argv[1])
run_sql(path, "select 1")
assert "sqlalchemy" not in sys.modules
from affcli.store import open_store
with open_store(path, create=True, write=True) as store:
    store.learning.runs()
assert "sqlalchemy" in sys.modules
print([name for name in ("sqlalchemy.orm", "alembic") if name in sys.modules])
"""


def test_only_what_is_needed_is_imported(database: Path) -> None:
    """A query needs no SQLAlchemy, a database of the right schema no Alembic; start-up counts."""
    command = [sys.executable, "-c", LOADED, str(database)]
    root = Path(__file__).parents[2]
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, check=False)
    assert (done.stdout, done.stderr) == ("[]\n", "")
