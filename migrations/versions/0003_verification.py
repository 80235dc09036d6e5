"""Verifications: the rows of a table tried again, and the counters that changed with it."""

import sqlite3

from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

STRICT = sqlite3.sqlite_version_info >= (3, 37)
"""Strict tables refuse text in a column of numbers; an older SQLite does not know them."""

VERIFICATION = """
    id INTEGER PRIMARY KEY,
    learning_run_id INTEGER NOT NULL REFERENCES learning_run (id),
    shape TEXT NOT NULL,
    seed INTEGER NOT NULL,
    sensor TEXT NOT NULL,
    calibration TEXT,
    tries_wanted INTEGER NOT NULL CHECK (tries_wanted >= 1),
    until_verdict INTEGER NOT NULL,
    uses_before INTEGER NOT NULL,
    after_trial INTEGER NOT NULL,
    versions TEXT NOT NULL,
    started_at TEXT NOT NULL,
    verdict TEXT,
    tries INTEGER,
    decided_after INTEGER,
    robot_seconds REAL,
    finished_at TEXT
"""

REPLICATION = """
    verification_id INTEGER NOT NULL REFERENCES verification (id),
    number INTEGER NOT NULL,
    clock REAL NOT NULL,
    affordance_id INTEGER NOT NULL REFERENCES affordance (id),
    placing_status TEXT NOT NULL,
    status TEXT,
    wrist_start_x REAL NOT NULL,
    wrist_start_y REAL NOT NULL,
    wrist_end_x REAL NOT NULL,
    wrist_end_y REAL NOT NULL,
    start_object_x REAL NOT NULL,
    start_object_y REAL NOT NULL,
    end_object_x REAL NOT NULL,
    end_object_y REAL NOT NULL,
    true_start_x REAL NOT NULL,
    true_start_y REAL NOT NULL,
    true_start_angle REAL NOT NULL,
    true_end_x REAL NOT NULL,
    true_end_y REAL NOT NULL,
    true_end_angle REAL NOT NULL,
    expected_dx REAL NOT NULL,
    expected_dy REAL NOT NULL,
    seen_dx REAL NOT NULL,
    seen_dy REAL NOT NULL,
    seen_distance REAL NOT NULL,
    replicated INTEGER NOT NULL,
    times_used_before INTEGER NOT NULL,
    times_used_after INTEGER NOT NULL,
    times_successful_before INTEGER NOT NULL,
    times_successful_after INTEGER NOT NULL,
    live INTEGER NOT NULL,
    died INTEGER NOT NULL,
    PRIMARY KEY (verification_id, number)
"""


def upgrade() -> None:
    strict = ["STRICT"] if STRICT else []
    op.execute(f"CREATE TABLE verification ({VERIFICATION}) {', '.join(strict)}")
    op.execute(f"CREATE TABLE replication ({REPLICATION}) {', '.join(['WITHOUT ROWID', *strict])}")
