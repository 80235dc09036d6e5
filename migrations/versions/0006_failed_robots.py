"""Robots of experiments and reproductions that failed, with what went wrong."""

import sqlite3

from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

STRICT = sqlite3.sqlite_version_info >= (3, 37)

FAILED_ROBOT = """
    session_id INTEGER NOT NULL REFERENCES session (id) ON DELETE CASCADE,
    robot INTEGER NOT NULL,
    kind TEXT NOT NULL,
    message TEXT NOT NULL,
    traceback TEXT,
    tries INTEGER NOT NULL CHECK (tries >= 1),
    failed_at TEXT NOT NULL,
    PRIMARY KEY (session_id, robot)
"""


def upgrade() -> None:
    op.execute(
        f"CREATE TABLE failed_robot ({FAILED_ROBOT}){' STRICT, ' if STRICT else ' '}WITHOUT ROWID"
    )
