"""Experiments: several conditions, each a session, whose robots share what they learned alike."""

import sqlite3

from alembic import op

revision = "0006"
down_revision = "0004"
branch_labels = None
depends_on = None

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


def downgrade() -> None:
    raise NotImplementedError("experiments would be lost; keep a copy of the file")
