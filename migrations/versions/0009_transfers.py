"""Carrying over to a new tool: masks of tools, and rows that a run borrowed from others.

A run that borrows may babble for no time at all: `hours` may be 0 there, and nowhere else.
"""

import sqlite3

from alembic import op

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None

STRICT = sqlite3.sqlite_version_info >= (3, 37)

HOURS = "hours REAL CHECK (hours > 0)"
NO_TIME = "hours REAL CHECK (hours > 0 OR (hours = 0 AND transfer IS NOT NULL))"

TABLES = {
    "mask": """
        learning_run_id INTEGER PRIMARY KEY REFERENCES learning_run (id) ON DELETE CASCADE,
        first_column INTEGER NOT NULL,
        first_row INTEGER NOT NULL,
        columns INTEGER NOT NULL CHECK (columns >= 1),
        rows INTEGER NOT NULL CHECK (rows >= 1),
        scale REAL NOT NULL CHECK (scale > 0),
        cells TEXT NOT NULL,
        red REAL NOT NULL,
        green REAL NOT NULL,
        blue REAL NOT NULL
    """,
    "borrowed": """
        learning_run_id INTEGER NOT NULL REFERENCES learning_run (id) ON DELETE CASCADE,
        step INTEGER NOT NULL CHECK (step <= 0),
        lender_key TEXT NOT NULL,
        lender_tool TEXT NOT NULL,
        lender_step INTEGER NOT NULL CHECK (lender_step >= 1),
        shift_x REAL NOT NULL,
        shift_y REAL NOT NULL,
        mirrored INTEGER NOT NULL CHECK (mirrored IN (0, 1)),
        PRIMARY KEY (learning_run_id, step)
    """,
}
"""What a run's camera saw of its tool, bits in hexadecimal digits, column after column; and where
each borrowed row, by its step, comes from: a run by its key, for that stays when the run goes."""


def upgrade() -> None:
    views = _definitions("type = 'view'")
    for name, _ in views:
        op.execute(f"DROP VIEW {name}")
    _rebuild_learning_run()
    for _, definition in views:
        _run(definition)
    for name, columns in TABLES.items():
        rowid = [] if name == "mask" else ["WITHOUT ROWID"]
        ending = ", ".join([*rowid, *(["STRICT"] if STRICT else [])])
        op.execute(f"CREATE TABLE {name} ({columns}) {ending}")


def _rebuild_learning_run() -> None:
    """Add what a run borrows from; numbers, indexes and the last id given stay."""
    table = "learning_run"
    beside = _definitions(f"type IN ('index', 'trigger') AND tbl_name = '{table}'")
    ((_, made),) = _definitions(f"type = 'table' AND name = '{table}'")
    if made.count(HOURS) != 1:
        raise ValueError(f"{table}: another definition")
    last = (
        op.get_bind()
        .exec_driver_sql("SELECT seq FROM sqlite_sequence WHERE name = ?", (table,))
        .all()
    )
    op.execute(f"ALTER TABLE {table} ADD COLUMN transfer TEXT")
    ((_, made),) = _definitions(f"type = 'table' AND name = '{table}'")
    _, _, body = made.replace(HOURS, NO_TIME).partition("(")
    _run(f"CREATE TABLE new_{table} ({body}")
    _run(f"INSERT INTO new_{table} SELECT * FROM {table}")
    op.execute(f"DROP TABLE {table}")
    op.execute(f"ALTER TABLE new_{table} RENAME TO {table}")
    for (number,) in last:
        _run(f"DELETE FROM sqlite_sequence WHERE name = '{table}'")
        _run(f"INSERT INTO sqlite_sequence (name, seq) VALUES ('{table}', {number})")
    for _, definition in beside:
        _run(definition)


def _definitions(which: str) -> list[tuple[str, str]]:
    """Return name and SQL of what was made by a statement, oldest first."""
    wanted = f"SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL AND {which} ORDER BY rowid"
    return [(name, sql) for name, sql in op.get_bind().exec_driver_sql(wanted).all()]


def _run(statement: str) -> None:
    """Run a statement through the driver: SQLAlchemy would take the colons in it for parameters."""
    op.get_bind().exec_driver_sql(statement).close()
