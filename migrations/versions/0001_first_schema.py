"""The first schema: sessions, learning runs, behaviors, affordances, trials, steps, two views.

It spells out names that the code has too, on purpose: a migration is history and must not change
when the code does. A test compares what it makes with ``affcli.store.tables``.
"""

import sqlite3

from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

APPLICATION_ID = int.from_bytes(b"affc", "big")
"""Tells affcli's databases from other SQLite files (``PRAGMA application_id``)."""

STRICT = sqlite3.sqlite_version_info >= (3, 37)
"""Strict tables refuse text in a column of numbers; an older SQLite does not know them."""

OBSERVATION = (
    *("object_x", "object_y", "object_z"),
    *("wrist_to_object_x", "wrist_to_object_y", "wrist_to_object_z"),
    *("object_red", "object_green", "object_blue"),
    *("tool_red", "tool_green", "tool_blue"),
)
"""o1 to o12 of the paper (§5.2)."""

SESSION = """
    id INTEGER PRIMARY KEY,
    kind TEXT NOT NULL,
    seed INTEGER NOT NULL,
    robots INTEGER NOT NULL CHECK (robots >= 1),
    settings TEXT NOT NULL,
    settings_key TEXT NOT NULL,
    versions TEXT NOT NULL,
    status TEXT NOT NULL,
    started_at TEXT NOT NULL,
    finished_at TEXT
"""

LEARNING_RUN = """
    id INTEGER PRIMARY KEY,
    session_id INTEGER REFERENCES session (id),
    tool TEXT NOT NULL,
    seed INTEGER NOT NULL,
    robot INTEGER NOT NULL,
    hours REAL,
    behaviors_limit INTEGER,
    settings TEXT NOT NULL,
    settings_key TEXT NOT NULL,
    versions TEXT NOT NULL,
    status TEXT NOT NULL,
    behaviors INTEGER NOT NULL,
    rows INTEGER NOT NULL,
    resets INTEGER NOT NULL,
    redraws INTEGER NOT NULL,
    robot_seconds REAL NOT NULL,
    checkpoint TEXT,
    started_at TEXT NOT NULL,
    finished_at TEXT,
    CHECK ((hours IS NULL) <> (behaviors_limit IS NULL))
"""

BEHAVIOR = """
    learning_run_id INTEGER NOT NULL REFERENCES learning_run (id),
    step INTEGER NOT NULL,
    clock REAL NOT NULL,
    exploratory_behavior TEXT NOT NULL,
    exploratory_params TEXT NOT NULL,
    status TEXT NOT NULL,
    duration REAL NOT NULL,
    resets INTEGER NOT NULL,
    redraws INTEGER NOT NULL,
    place_x REAL NOT NULL,
    place_y REAL NOT NULL,
    wrist_start_x REAL NOT NULL,
    wrist_start_y REAL NOT NULL,
    wrist_end_x REAL NOT NULL,
    wrist_end_y REAL NOT NULL,
    start_object_x REAL NOT NULL,
    start_object_y REAL NOT NULL,
    start_wrist_to_object_x REAL NOT NULL,
    start_wrist_to_object_y REAL NOT NULL,
    end_object_x REAL NOT NULL,
    end_object_y REAL NOT NULL,
    end_wrist_to_object_x REAL NOT NULL,
    end_wrist_to_object_y REAL NOT NULL,
    true_start_x REAL NOT NULL,
    true_start_y REAL NOT NULL,
    true_start_angle REAL NOT NULL,
    true_end_x REAL NOT NULL,
    true_end_y REAL NOT NULL,
    true_end_angle REAL NOT NULL,
    change_detected INTEGER NOT NULL,
    PRIMARY KEY (learning_run_id, step)
"""

AFFORDANCE = f"""
    id INTEGER PRIMARY KEY,
    learning_run_id INTEGER NOT NULL REFERENCES learning_run (id),
    step INTEGER NOT NULL,
    tool TEXT NOT NULL,
    binding_behavior TEXT NOT NULL,
    binding_params TEXT NOT NULL,
    exploratory_behavior TEXT NOT NULL,
    exploratory_params TEXT NOT NULL,
    truncated INTEGER NOT NULL,
    {" ".join(f"start_{name} REAL NOT NULL," for name in OBSERVATION)}
    {" ".join(f"end_{name} REAL NOT NULL," for name in OBSERVATION)}
    movement REAL NOT NULL,
    direction REAL NOT NULL,
    times_used INTEGER NOT NULL,
    times_successful INTEGER NOT NULL,
    UNIQUE (learning_run_id, step),
    CHECK (times_used >= 1 AND times_successful BETWEEN 0 AND times_used)
"""

TRIAL = """
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    learning_run_id INTEGER NOT NULL REFERENCES learning_run (id),
    protocol TEXT NOT NULL,
    robot INTEGER NOT NULL,
    tool TEXT NOT NULL,
    shape TEXT NOT NULL,
    goal INTEGER NOT NULL,
    start INTEGER NOT NULL,
    seed INTEGER NOT NULL,
    counters TEXT NOT NULL,
    outcome TEXT,
    steps INTEGER,
    robot_seconds REAL,
    last_rows_consistent INTEGER,
    last_rows_probable INTEGER,
    last_rows_reachable INTEGER,
    last_rows_nearest INTEGER,
    UNIQUE (session_id, robot, protocol, tool, shape, goal, start)
"""

STEP = """
    trial_id INTEGER NOT NULL REFERENCES trial (id),
    number INTEGER NOT NULL,
    clock REAL NOT NULL,
    affordance_id INTEGER NOT NULL REFERENCES affordance (id),
    rows_consistent INTEGER NOT NULL,
    rows_probable INTEGER NOT NULL,
    rows_reachable INTEGER NOT NULL,
    rows_nearest INTEGER NOT NULL,
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
    true_end_x REAL NOT NULL,
    true_end_y REAL NOT NULL,
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
    died INTEGER NOT NULL,
    lost INTEGER,
    PRIMARY KEY (trial_id, number)
"""


def upgrade() -> None:
    op.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    _table("session", SESSION)
    _table("learning_run", LEARNING_RUN)
    _table("behavior", BEHAVIOR, "WITHOUT ROWID")
    _table("affordance", AFFORDANCE)
    _table("trial", TRIAL)
    _table("step", STEP, "WITHOUT ROWID")
    # What a run is a function of names it: the same run is never stored twice.
    op.execute(
        "CREATE UNIQUE INDEX learning_run_by_what_it_is ON learning_run (coalesce(session_id, 0),"
        " robot, tool, seed, coalesce(hours, 0), coalesce(behaviors_limit, 0), settings_key)"
    )
    op.execute(
        "CREATE UNIQUE INDEX reproduction_by_what_it_is ON session (seed, robots, settings_key)"
        " WHERE kind = 'reproduce'"
    )
    op.execute(f"CREATE VIEW affordance_table AS {AFFORDANCE_TABLE}")
    op.execute(f"CREATE VIEW affordance_wide AS {AFFORDANCE_WIDE}")


def _table(name: str, columns: str, *options: str) -> None:
    """Create a table, strict where SQLite can."""
    ending = ", ".join([*options, *(["STRICT"] if STRICT else [])])
    op.execute(f"CREATE TABLE {name} ({columns}) {ending}")


def _readable(params: str) -> str:
    """Turn the JSON ``{"x": 1.5, "y": 2.0}`` into ``x=1.5, y=2``, by what every SQLite has."""
    for old, new in ((".0}", "}"), (".0,", ","), ('": ', "="), ('"', ""), ("{", ""), ("}", "")):
        params = f"replace({params}, '{old}', '{new}')"
    return params


def _observation(when: str) -> str:
    """Write an observation as ``object (x, y, z) from wrist (x, y, z) object rgb ...``."""
    columns = [f"{when}_{name}" for name in OBSERVATION]
    # Adding 0.0 makes the -0.0 that rounding may give a plain 0.
    values = [f"round({name}, 2) + 0.0" for name in columns[:6]]
    values += [f"round({name}) + 0.0" for name in columns[6:]]
    text = (
        "object (%.2f, %.2f, %.2f) from wrist (%.2f, %.2f, %.2f)"
        " object rgb (%.0f, %.0f, %.0f) tool rgb (%.0f, %.0f, %.0f)"
    )
    return f"printf('{text}', {', '.join(values)})"


AFFORDANCE_TABLE = f"""
SELECT
    id,
    learning_run_id AS run,
    tool,
    binding_behavior,
    {_readable("binding_params")} AS binding_params,
    exploratory_behavior,
    {_readable("exploratory_params")} AS exploratory_params,
    {_observation("start")} AS start_observation,
    {_observation("end")} AS end_observation,
    times_used,
    times_successful,
    1.0 * times_successful / times_used AS replication_probability,
    movement,
    direction,
    truncated
FROM affordance
"""

AFFORDANCE_WIDE = f"""
SELECT
    id,
    learning_run_id AS run,
    step,
    tool,
    binding_behavior,
    binding_params,
    exploratory_behavior,
    exploratory_params,
    {" ".join(f"start_{name}," for name in OBSERVATION)}
    {" ".join(f"end_{name}," for name in OBSERVATION)}
    end_object_x - start_object_x AS expected_dx,
    end_object_y - start_object_y AS expected_dy,
    movement,
    direction,
    times_used,
    times_successful,
    1.0 * times_successful / times_used AS replication_probability,
    truncated
FROM affordance
"""
