"""Experiments: several conditions, each a session, whose robots share what they learned alike.

A run may have a note; no id is given twice, also after what had it was deleted.

A verification remembers the latest trial before it, and a replay goes by the order of ids: a new
trial with the id of a deleted one would come before verifications that it came after.
"""

import sqlite3

from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

NUMBERED = ("session", "learning_run", "affordance", "trial", "verification")
"""Tables whose rows have an id."""
GIVEN, GIVEN_ONCE = "id INTEGER PRIMARY KEY,", "id INTEGER PRIMARY KEY AUTOINCREMENT,"

STRICT = sqlite3.sqlite_version_info >= (3, 37)

EXPERIMENT = """
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    question TEXT NOT NULL,
    definition TEXT NOT NULL,
    key TEXT NOT NULL,
    versions TEXT NOT NULL,
    status TEXT NOT NULL CHECK (status IN ('running', 'done')),
    started_at TEXT NOT NULL,
    finished_at TEXT
"""


def upgrade() -> None:
    op.execute("ALTER TABLE learning_run ADD COLUMN note TEXT CHECK (length(note) <= 500)")
    views = _definitions("type = 'view'")
    for name, _ in views:
        op.execute(f"DROP VIEW {name}")
    for table in NUMBERED:
        beside = _definitions(f"type IN ('index', 'trigger') AND tbl_name = '{table}'")
        ((_, made),) = _definitions(f"type = 'table' AND name = '{table}'")
        _, _, columns = made.partition("(")
        _run(f"CREATE TABLE new_{table} ({columns.replace(GIVEN, GIVEN_ONCE, 1)}")
        _run(f"INSERT INTO new_{table} SELECT * FROM {table} ORDER BY id")
        op.execute(f"DROP TABLE {table}")
        op.execute(f"ALTER TABLE new_{table} RENAME TO {table}")
        for _, definition in beside:
            _run(definition)
    for _, definition in views:
        _run(definition)
    _add_experiments()


def _add_experiments() -> None:
    op.execute(f"CREATE TABLE experiment ({EXPERIMENT}){' STRICT' if STRICT else ''}")
    op.execute("ALTER TABLE session ADD COLUMN experiment_id INTEGER REFERENCES experiment (id)")
    op.execute(
        "ALTER TABLE session ADD COLUMN condition TEXT "
        "CHECK ((condition IS NULL) = (experiment_id IS NULL))"
    )
    op.execute(
        "ALTER TABLE learning_run ADD COLUMN kept TEXT NOT NULL DEFAULT 'all' "
        "CHECK (kept IN ('all', 'rows', 'trials'))"
    )
    op.execute("CREATE UNIQUE INDEX session_by_condition ON session (experiment_id, condition)")


def _definitions(which: str) -> list[tuple[str, str]]:
    """Return name and SQL of what was made by a statement, oldest first."""
    wanted = f"SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL AND {which} ORDER BY rowid"
    return [(name, sql) for name, sql in op.get_bind().exec_driver_sql(wanted).all()]


def _run(statement: str) -> None:
    """Run a statement through the driver: SQLAlchemy would take the colons in it for parameters."""
    op.get_bind().exec_driver_sql(statement).close()
