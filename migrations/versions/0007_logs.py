"""Runs that were imported from logs of other robots.

A log says what was done and seen, and seldom all that our robots see: what it lacks is NULL. Where
each row comes from is kept: the files with their hashes, the line, source, licence, citation.
"""

import re
import sqlite3

from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

STRICT = sqlite3.sqlite_version_info >= (3, 37)

XY, POSE = ("x", "y"), ("x", "y", "angle")
WHENCE = ("start_wrist_to_object", "end_wrist_to_object")
SEEN = tuple(
    f"{when}_{name}"
    for when in ("start", "end")
    for name in (
        *("object_z", "wrist_to_object_x", "wrist_to_object_y", "wrist_to_object_z"),
        *(f"{what}_{color}" for what in ("object", "tool") for color in ("red", "green", "blue")),
    )
)
NOT_LOGGED = {
    "learning_run": ("robot_seconds",),
    "behavior": (
        *("clock", "duration", "place_x", "place_y"),
        *(f"{name}_{axis}" for name in ("wrist_start", "wrist_end") for axis in POSE),
        *(f"{name}_{axis}" for name in WHENCE for axis in XY),
    ),
    "affordance": (*SEEN, "wrist_angle", "travel_x", "travel_y"),
}
"""Columns that a log may lack. Of a run that was not imported none is NULL: see `AS_BEFORE`."""
AS_BEFORE = {"robot_seconds": "CHECK (robot_seconds IS NOT NULL OR world LIKE 'log:%')"}
"""What still holds of such a column. Behaviors and rows do not name their world; `affcli db check`
looks at theirs."""

TABLES = {
    "log": """
        learning_run_id INTEGER PRIMARY KEY REFERENCES learning_run (id) ON DELETE CASCADE,
        source TEXT NOT NULL,
        licence TEXT,
        citation TEXT,
        map TEXT NOT NULL,
        left_out INTEGER NOT NULL CHECK (left_out >= 0)
    """,
    "log_file": """
        learning_run_id INTEGER NOT NULL REFERENCES log (learning_run_id) ON DELETE CASCADE,
        number INTEGER NOT NULL,
        name TEXT NOT NULL,
        sha256 TEXT NOT NULL CHECK (length(sha256) = 64),
        PRIMARY KEY (learning_run_id, number)
    """,
    "log_line": """
        learning_run_id INTEGER NOT NULL,
        step INTEGER NOT NULL,
        file INTEGER NOT NULL,
        line INTEGER NOT NULL CHECK (line >= 1),
        object TEXT,
        PRIMARY KEY (learning_run_id, step),
        FOREIGN KEY (learning_run_id, file) REFERENCES log_file (learning_run_id, number)
            ON DELETE CASCADE
    """,
}
"""Where an imported run comes from, the files, and which line of which gave each behavior."""


def upgrade() -> None:
    views = dict(_definitions("type = 'view'"))
    for name in views:
        op.execute(f"DROP VIEW {name}")
    for table, columns in NOT_LOGGED.items():
        _relax(table, columns)
    for name, columns in TABLES.items():
        rowid = [] if name == "log" else ["WITHOUT ROWID"]
        ending = ", ".join([*rowid, *(["STRICT"] if STRICT else [])])
        op.execute(f"CREATE TABLE {name} ({columns}) {ending}")
    _run(_with_unknown(views.pop("affordance_table")))
    for definition in views.values():
        _run(definition)


def _relax(table: str, columns: tuple[str, ...]) -> None:
    """Let columns of a table be NULL; its numbers, indexes and the last id given stay."""
    beside = _definitions(f"type IN ('index', 'trigger') AND tbl_name = '{table}'")
    ((_, made),) = _definitions(f"type = 'table' AND name = '{table}'")
    _, _, body = made.partition("(")
    for column in columns:
        strict = rf"\b{column} REAL NOT NULL( DEFAULT 0\.0)?"
        body, found = re.subn(strict, f"{column} REAL {AS_BEFORE.get(column, '')}", body)
        if found != 1:
            raise ValueError(f"{table}.{column}: {found} definitions")
    numbers = "SELECT seq FROM sqlite_sequence WHERE name = ?"
    last = op.get_bind().exec_driver_sql(numbers, (table,)).all()
    _run(f"CREATE TABLE new_{table} ({body}")
    _run(f"INSERT INTO new_{table} SELECT * FROM {table}")
    op.execute(f"DROP TABLE {table}")
    op.execute(f"ALTER TABLE new_{table} RENAME TO {table}")
    for (number,) in last:
        _run(f"DELETE FROM sqlite_sequence WHERE name = '{table}'")
        _run(f"INSERT INTO sqlite_sequence (name, seq) VALUES ('{table}', {number})")
    for _, definition in beside:
        _run(definition)


def _with_unknown(view: str) -> str:
    """Return the readable view with - where a number is not known: printf writes 0 for NULL."""
    text = view.replace("%.2f", "%s").replace("%.0f", "%s")
    for digits, rounded in (("2", r"round\((\w+), 2\)"), ("0", r"round\((\w+)\)")):
        shown = rf"CASE WHEN \1 IS NULL THEN '-' ELSE printf('%.{digits}f', round(\1"
        shown += f"{', 2' if digits == '2' else ''}) + 0.0) END"
        text = re.sub(rounded + r" \+ 0\.0", shown, text)
    return text


def _definitions(which: str) -> list[tuple[str, str]]:
    """Return name and SQL of what was made by a statement, oldest first."""
    wanted = f"SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL AND {which} ORDER BY rowid"
    return [(name, sql) for name, sql in op.get_bind().exec_driver_sql(wanted).all()]


def _run(statement: str) -> None:
    """Run a statement through the driver: SQLAlchemy would take the colons in it for parameters."""
    op.get_bind().exec_driver_sql(statement).close()
