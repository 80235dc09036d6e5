"""What robots invented: behaviors by value, with the tries that speak for and against each."""

import sqlite3

from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None

STRICT = sqlite3.sqlite_version_info >= (3, 37)

TABLES = {
    "invention": """
        learning_run_id INTEGER NOT NULL REFERENCES learning_run (id) ON DELETE CASCADE,
        number INTEGER NOT NULL CHECK (number >= 1),
        exploratory_behavior TEXT NOT NULL,
        exploratory_params TEXT NOT NULL,
        motion TEXT NOT NULL,
        step INTEGER NOT NULL,
        gain INTEGER NOT NULL,
        kept INTEGER NOT NULL CHECK (kept IN (0, 1)),
        PRIMARY KEY (learning_run_id, number)
    """,
    "invention_try": """
        learning_run_id INTEGER NOT NULL,
        number INTEGER NOT NULL,
        step INTEGER NOT NULL,
        alike INTEGER NOT NULL CHECK (alike IN (0, 1)),
        PRIMARY KEY (learning_run_id, step),
        FOREIGN KEY (learning_run_id, number) REFERENCES invention (learning_run_id, number)
            ON DELETE CASCADE
    """,
}
"""Which behavior of its learning run moved the attractor so first, and those that tried again."""


def upgrade() -> None:
    ending = ", ".join(["WITHOUT ROWID", *(["STRICT"] if STRICT else [])])
    for name, columns in TABLES.items():
        op.execute(f"CREATE TABLE {name} ({columns}) {ending}")
