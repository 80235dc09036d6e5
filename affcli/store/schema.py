"""Has a database the columns that this code reads, and do they hold what they should?

Standard library only. SQLite itself holds the values of a strict table to the types of its columns;
a table that is not strict, from an old SQLite or from another program, may hold anything.
"""

import sqlite3
from types import NoneType
from typing import get_args, get_type_hints

from affcli.store.rows import (
    AFFORDANCE_COLUMNS,
    BehaviorRow,
    LearningRunRow,
    ReplicationRow,
    SessionRow,
    StepRow,
    TrialRow,
    VerificationRow,
)

ROWS = {
    "session": SessionRow,
    "learning_run": LearningRunRow,
    "behavior": BehaviorRow,
    "trial": TrialRow,
    "step": StepRow,
    "verification": VerificationRow,
    "replication": ReplicationRow,
}
STORED_AS = {
    int: "'integer'",
    bool: "'integer'",
    float: "'real'",
    str: "'text'",
    NoneType: "'null'",
}

AFFORDANCE_TEXTS = frozenset(
    {"tool", "binding_behavior", "binding_params", "exploratory_behavior", "exploratory_params"}
)
AFFORDANCE_COUNTS = frozenset(
    {"learning_run_id", "step", "truncated", "times_used", "times_successful"}
)
NUMBERED = ("session", "learning_run", "affordance", "trial", "verification")
"""The tables whose rows have an id."""


def _columns() -> dict[str, dict[str, str]]:
    """Return the columns of each table, each with the types it may hold as SQLite names them."""
    known = {
        table: {
            name: ", ".join(sorted({STORED_AS[kind] for kind in get_args(hint) or (hint,)}))
            for name, hint in get_type_hints(row).items()
        }
        for table, row in ROWS.items()
    }
    known["affordance"] = {name: _affordance_type(name) for name in AFFORDANCE_COLUMNS}
    return known


def _affordance_type(name: str) -> str:
    """Return the type of a column of the affordance table."""
    if name in AFFORDANCE_TEXTS:
        return "'text'"
    return "'integer'" if name in AFFORDANCE_COUNTS else "'real'"


COLUMNS = _columns()
TABLES = {name: {*types, *(["id"] if name in NUMBERED else [])} for name, types in COLUMNS.items()}
TABLES["alembic_version"] = {"version_num"}
VIEWS = {
    "affordance_table": {"id"},
    "affordance_wide": {"id", "run", "exploratory_behavior", "replication_probability"},
}


def missing_column(driver: sqlite3.Connection) -> str:
    """Return the first column that is missing, as ``table.column``; empty when none is.

    Of a view that cannot be read, its name.
    """
    lost = []
    for table, names in TABLES.items():
        there = {row[1] for row in driver.execute(f"PRAGMA table_info({table})")}
        lost += [f"{table}.{name}" for name in names - there]
    if lost:
        return min(lost)
    for view, names in VIEWS.items():
        try:
            there = {row[1] for row in driver.execute(f"PRAGMA table_info({view})")}
        except sqlite3.OperationalError:  # it asks for what is not there
            return view
        lost += [f"{view}.{name}" for name in names - there]
    return min(lost, default="")


def mistyped_table(driver: sqlite3.Connection) -> str:
    """Return a table with a value of another type than its column's; empty when there is none."""
    for table, types in COLUMNS.items():
        if _is_strict(driver, table):
            continue
        other = " OR ".join(f"typeof({name}) NOT IN ({kinds})" for name, kinds in types.items())
        # Names are this module's own.
        found = driver.execute(f"SELECT 1 FROM {table} WHERE {other} LIMIT 1")  # noqa: S608
        if found.fetchone() is not None:
            return table
    return ""


def _is_strict(driver: sqlite3.Connection, table: str) -> bool:
    """Tell whether SQLite itself holds a table to its types, as it does since 3.37."""
    if sqlite3.sqlite_version_info < (3, 37):
        return False
    flags = driver.execute(f"PRAGMA table_list({table})").fetchall()
    return all(strict for _, _, _, _, _, strict in flags)
