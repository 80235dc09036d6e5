"""The tables for queries, from the tuple types of their rows."""

import sqlalchemy as sa

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


def _table(name: str, *columns: str) -> sa.TableClause:
    """Name a table and its columns."""
    return sa.table(name, *map(sa.column, columns))


session = _table("session", "id", *SessionRow._fields)
learning_run = _table("learning_run", "id", *LearningRunRow._fields)
behavior = _table("behavior", *BehaviorRow._fields)
affordance = _table("affordance", "id", *AFFORDANCE_COLUMNS)
trial = _table("trial", "id", *TrialRow._fields)
step = _table("step", *StepRow._fields)
verification = _table("verification", "id", *VerificationRow._fields)
replication = _table("replication", *ReplicationRow._fields)

# Of the view those columns that rows are chosen by.
wide = _table(
    "affordance_wide",
    *("id", "run", "exploratory_behavior", "exploratory_params", "replication_probability"),
)

TABLES = (session, learning_run, behavior, affordance, trial, step, verification, replication)
