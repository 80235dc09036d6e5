"""The tables for queries."""

import sqlalchemy as sa

from affcli.store.columns import COLUMNS, NUMBERED

TABLES = {
    name: sa.table(name, *map(sa.column, (*(("id",) if name in NUMBERED else ()), *columns)))
    for name, columns in COLUMNS.items()
}
tool = TABLES["tool"]
experiment = TABLES["experiment"]
session = TABLES["session"]
failed_robot = TABLES["failed_robot"]
learning_run = TABLES["learning_run"]
behavior = TABLES["behavior"]
affordance = TABLES["affordance"]
trial = TABLES["trial"]
step = TABLES["step"]
verification = TABLES["verification"]
replication = TABLES["replication"]
invention = TABLES["invention"]
invention_try = TABLES["invention_try"]
mask = TABLES["mask"]
borrowed = TABLES["borrowed"]
log = TABLES["log"]
log_file = TABLES["log_file"]
log_line = TABLES["log_line"]

wide = sa.table(
    "affordance_wide",
    *map(
        sa.column,
        ("id", "run", "exploratory_behavior", "exploratory_params", "replication_probability"),
    ),
)
"""Of the view those columns that rows are chosen by."""
