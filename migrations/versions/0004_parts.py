"""Every run carries its parts: tools and tasks by value, motions, planner, explorer, and a key.

What older revisions did not record was always the paper's, and is filled in from constants that
are spelled out here: a migration is history and must not change when the code does. Settings are
kept as what differs from the defaults of revision 0003, the defaults number 1.
"""

import hashlib
import json
import sqlite3
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from alembic import op

from affcli.errors import DatabaseError

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

STRICT = sqlite3.sqlite_version_info >= (3, 37)

DEFAULTS: dict[str, dict[str, Any]] = json.loads("""{
"arm": {"shoulder_height": 10.0, "upper_arm": 10.0, "forearm": 10.0, "wrist_to_flange": 2.0,
    "flange_height": 1.05, "lift_height": 1.6, "elbow_max_degrees": 146.0,
    "shoulder_min_degrees": -20.0, "shoulder_max_degrees": 110.0, "waist_max_degrees": 90.0},
"babbling": {"offset_x_max": 7.5, "offset_y_min": 6.8, "offset_y_max": 19.2, "draws": 256},
"camera": {"focal_length_mm": 5.29, "distortion_per_mm2": 0.004, "x": 0.0, "y": 45.0,
    "height": 52.0, "tilt_degrees": 25.0, "turn_degrees": 180.0, "grey_noise": 2.55,
    "blur_px": 0.5, "uneven_light": 0.1},
"friction": {"puck_table": 0.35, "tool_puck": 0.225, "gravity": 386.09},
"layout": {"midline": 22.4, "start_spacing": 6.0, "goal_1_y": 15.3, "goal_2_y": 26.8,
    "goal_side_x": 12.4, "goal_half_width": 2.25},
"motion": {"push_speed": 5.0, "push_acceleration": 40.0, "transfer_speed": 12.5,
    "transfer_acceleration": 20.0, "lift_speed": 4.0, "hold": 0.25, "grasp_time": 5.0},
"physics": {"iterations": 4, "collision_slop": 0.0001, "overlap_mended": 0.05},
"puck": {"radius": 1.5, "height": 1.0, "mass": 0.165},
"sensor": {"kind": "noisy", "position_noise": 0.008, "color_noise": 2.4},
"table": {"half_width": 16.0, "near": 11.8, "far": 31.6},
"tools": {"handle_length": 14.6, "handle_below_grasp": 1.0, "part_width": 0.75,
    "bar_reach": 5.6, "hook_length": 5.3, "thickness": 0.75},
"trial": {"max_steps": 60}
}""")
"""The defaults number 1; a run of an older revision has them where it did not know a setting."""

TOOLS: dict[str, tuple[list[float], str]] = {
    "stick": ([200.0, 40.0, 40.0], "handle"),
    "l-stick": ([40.0, 90.0, 200.0], "handle, left bar"),
    "l-hook": ([150.0, 60.0, 190.0], "handle, left bar, left hook"),
    "t-stick": ([230.0, 210.0, 40.0], "handle, left bar, right bar"),
    "t-hook": ([40.0, 160.0, 70.0], "handle, left bar, right bar, left hook, right hook"),
}
"""The colour and the parts of the paper's five tools (§4)."""

REPERTOIRE = [
    {
        "behavior": name,
        "params": {"offset_distance": distance},
        "motion": [["slide", x * distance, y * distance]],
    }
    for name, x, y in (
        *(("extend arm", 0.0, 1.0), ("contract arm", 0.0, -1.0)),
        *(("slide arm left", -1.0, 0.0), ("slide arm right", 1.0, 0.0)),
    )
    for distance in (2.0, 5.0)
]
"""The paper's exploratory behaviors (§5)."""

WORLD, EXPLORER, PLANNER, TASK_SET = "table", "random", "nested-query", "extension-of-reach"


def _columns(kind: str, names: str, *axes: str) -> str:
    """Write columns of one kind, each name with each of the axes."""
    each = [f"{n}_{a}" if a else n for n in names.split() for a in axes or ("",)]
    return "".join(f"{name} {kind}, " for name in each)


TEXT, REAL, COUNT = "TEXT NOT NULL", "REAL NOT NULL", "INTEGER NOT NULL CHECK ({0} >= 0)"
FLAG = "INTEGER NOT NULL CHECK ({0} IN (0, 1))"
TOOL = "key TEXT PRIMARY KEY, name TEXT NOT NULL, definition TEXT NOT NULL"
PARTS = f"""
    {_columns(TEXT, "world repertoire binding_behavior binding_params explorer sensor settings")}
    {_columns(TEXT, "versions started_at")}
    status TEXT NOT NULL CHECK (status IN ('running', 'done')),
    finished_at TEXT,
"""
SESSION = f"""
    id INTEGER PRIMARY KEY,
    {_columns(TEXT, "key kind")}
    seed {COUNT.format("seed")},
    robots INTEGER NOT NULL CHECK (robots >= 1),
    {PARTS}
    planner TEXT NOT NULL,
    task_set TEXT NOT NULL
"""
LEARNING_RUN = f"""
    id INTEGER PRIMARY KEY,
    session_id INTEGER REFERENCES session (id),
    {_columns(TEXT, "key tool")}
    tool_key TEXT REFERENCES tool (key),
    seed {COUNT.format("seed")},
    robot {COUNT.format("robot")},
    hours REAL CHECK (hours > 0),
    behaviors_limit INTEGER CHECK (behaviors_limit > 0),
    {PARTS}
    {_columns("INTEGER NOT NULL", "behaviors rows resets redraws")}
    robot_seconds REAL NOT NULL,
    checkpoint TEXT,
    calibration TEXT,
    CHECK ((hours IS NULL) <> (behaviors_limit IS NULL))
"""
BEHAVIOR = f"""
    learning_run_id INTEGER NOT NULL REFERENCES learning_run (id),
    step INTEGER NOT NULL,
    clock REAL NOT NULL,
    {_columns(TEXT, "exploratory_behavior exploratory_params status")}
    duration REAL NOT NULL,
    {_columns("INTEGER NOT NULL", "resets redraws")}
    {_columns(REAL, "place", "x", "y")}
    {_columns(REAL, "wrist_start wrist_end", "x", "y", "angle")}
    {_columns(REAL, "start_object start_wrist_to_object", "x", "y")}
    {_columns(REAL, "end_object end_wrist_to_object", "x", "y")}
    {_columns("REAL", "true_start true_end", "x", "y", "angle")}
    change_detected {FLAG.format("change_detected")},
    PRIMARY KEY (learning_run_id, step)
"""
TRIAL = f"""
    id INTEGER PRIMARY KEY,
    session_id INTEGER NOT NULL REFERENCES session (id),
    learning_run_id INTEGER NOT NULL REFERENCES learning_run (id),
    protocol TEXT NOT NULL CHECK (protocol IN ('extension of reach', 'tool adaptation')),
    robot {COUNT.format("robot")},
    {_columns(TEXT, "tool shape")}
    shape_key TEXT REFERENCES tool (key),
    {_columns(TEXT, "task_set goal start")}
    {_columns(REAL, "goal_x goal_y goal_half_width start_x start_y")}
    seed {COUNT.format("seed")},
    counters TEXT NOT NULL CHECK (counters IN ('stored', 'as learned')),
    {_columns(TEXT, "planner sensor world")}
    calibration TEXT,
    outcome TEXT CHECK (outcome IN (
        'solved', 'no row left', 'attractor out of reach', 'step limit', 'invalid')),
    steps INTEGER,
    robot_seconds REAL,
    last_reasons TEXT,
    UNIQUE (session_id, robot, protocol, tool, shape, task_set, goal, start, planner)
"""
USE = f"""
    number INTEGER NOT NULL,
    clock REAL NOT NULL,
    affordance_id INTEGER NOT NULL REFERENCES affordance (id),
    placing_status TEXT NOT NULL,
    status TEXT,
    regrasped {FLAG.format("regrasped")},
    {_columns(REAL, "wrist_start wrist_end", "x", "y", "angle")}
    {_columns(REAL, "start_object end_object", "x", "y")}
    {_columns(REAL, "expected seen", "dx", "dy")}
    seen_distance REAL NOT NULL,
    replicated {FLAG.format("replicated")},
    {_columns("INTEGER NOT NULL", "times_used times_successful", "before", "after")}
    died {FLAG.format("died")},
"""
"""What was done with a row, in a step or in a try of a verification."""
STEP = f"""
    trial_id INTEGER NOT NULL REFERENCES trial (id),
    {USE}
    reasons TEXT NOT NULL,
    {_columns("REAL", "true_start true_end", "x", "y")}
    lost INTEGER CHECK (lost IN (0, 1)),
    PRIMARY KEY (trial_id, number)
"""
REPLICATION = f"""
    verification_id INTEGER NOT NULL REFERENCES verification (id),
    {USE}
    {_columns("REAL", "true_start true_end", "x", "y", "angle")}
    live {FLAG.format("live")},
    PRIMARY KEY (verification_id, number)
"""

REASONS = (
    """'[{{"name":"consistent","rows":' || {0}consistent || ',"value":null}},"""
    """{{"name":"probable","rows":' || {0}probable || ',"value":0.5}},"""
    """{{"name":"reachable","rows":' || {0}reachable || ',"value":null}},"""
    """{{"name":"nearest","rows":' || {0}nearest || ',"value":0.2}}]'"""
)
"""Rows left by each search; NULL where a count is."""


def upgrade() -> None:
    driver = op.get_bind().connection.driver_connection
    _require_settings(driver)
    for function, arguments in FUNCTIONS:
        driver.create_function(function.__name__, arguments, function, deterministic=True)
    views = "SELECT sql FROM sqlite_master WHERE name = 'affordance_wide'"
    wide = driver.execute(views).fetchone()[0]
    op.execute("DROP VIEW affordance_wide")
    op.execute(f"CREATE TABLE tool ({TOOL}){' STRICT' if STRICT else ''}")
    op.execute(
        "INSERT OR IGNORE INTO tool SELECT tool_key(settings, tool), tool, tool_value(settings, "
        "tool) FROM (SELECT settings, tool FROM learning_run UNION SELECT settings, shape FROM "
        "trial t JOIN learning_run r ON r.id = t.learning_run_id UNION SELECT settings, shape FROM "
        "verification v JOIN learning_run r ON r.id = v.learning_run_id) "
        "WHERE tool_key(settings, tool) IS NOT NULL"
    )
    run = "LEFT JOIN learning_run r ON r.id = o.learning_run_id"
    places = ("goal_x", "goal_y", "goal_half_width", "start_x", "start_y")
    task = {name: f"place(r.settings, '{name}', o.{name.split('_')[0]})" for name in places}
    task |= {name: f"CAST(o.{name} AS TEXT)" for name in ("goal", "start")}
    held = {"shape_key": "tool_key(r.settings, o.shape)", "world": f"'{WORLD}'"}
    named = {"planner": f"'{PLANNER}'", "task_set": f"'{TASK_SET}'"}
    last = {"last_reasons": REASONS.format("last_rows_")}
    flat = {"wrist_start_angle": "0.0", "wrist_end_angle": "0.0"}
    shape = "SELECT settings FROM learning_run WHERE id = learning_run_id"
    op.execute("ALTER TABLE verification ADD COLUMN shape_key TEXT REFERENCES tool (key)")
    op.execute("ALTER TABLE verification ADD COLUMN world TEXT NOT NULL DEFAULT 'table'")
    op.execute(f"UPDATE verification SET shape_key = tool_key(({shape}), shape)")
    _rebuild("trial", TRIAL, f"trial o {run}", {**task, **held, **named, **last})
    used = {**flat, "regrasped": "0"}
    _rebuild("step", STEP, "step o", {**used, "reasons": REASONS.format("rows_")}, "WITHOUT ROWID")
    _rebuild("replication", REPLICATION, "replication o", used, "WITHOUT ROWID")
    for column in ("wrist_angle", "travel_x", "travel_y"):
        op.execute(f"ALTER TABLE affordance ADD COLUMN {column} REAL NOT NULL DEFAULT 0.0")
    travel = (
        f"SELECT wrist_end_{axis} - wrist_start_{axis} FROM behavior b WHERE b.step = "
        "affordance.step AND b.learning_run_id = affordance.learning_run_id"
        for axis in "xy"
    )
    op.execute("UPDATE affordance SET (travel_x, travel_y) = (({}), ({}))".format(*travel))
    _rebuild("behavior", BEHAVIOR, "behavior o", flat, "WITHOUT ROWID")
    keyed = "learning_key(settings, tool, seed, robot, hours, behaviors_limit)"
    source = f"(SELECT *, {keyed} AS own FROM learning_run) o"
    tool = {"tool_key": "tool_key(o.settings, o.tool)"}
    _rebuild(
        "learning_run", LEARNING_RUN, source, {**_parts("coalesce(session_id, 0)", "0"), **tool}
    )
    source = "(SELECT *, session_key(kind, seed, robots, settings) AS own FROM session) o"
    _rebuild("session", SESSION, source, {**_parts("kind", "kind <> 'reproduce'"), **named})
    # What a run is a function of names it: the same run is never stored twice.
    op.execute(
        "CREATE UNIQUE INDEX learning_run_by_key ON learning_run (coalesce(session_id, 0), key)"
    )
    op.execute("CREATE UNIQUE INDEX reproduction_by_key ON session (key) WHERE kind = 'reproduce'")
    ending = "\nFROM affordance"
    op.execute(wide.replace(ending, f",\n    wrist_angle,\n    travel_x,\n    travel_y{ending}"))
    for function, arguments in FUNCTIONS:
        driver.create_function(function.__name__, arguments, None)


def _require_settings(driver: sqlite3.Connection) -> None:
    """Make sure that all settings can be read: SQL would not say whose cannot."""
    for table in ("learning_run", "session"):
        for number, text in driver.execute(f"SELECT id, settings FROM {table} ORDER BY id"):
            try:
                # These read each of the settings that the others read.
                _canonical(text), _tool(text, "t-hook"), place(text, "goal_x", 1)
            except (ValueError, TypeError, AttributeError, KeyError, RecursionError) as error:
                raise DatabaseError(
                    f"{table.replace('_', ' ')} {number}: settings that are no JSON of affcli's; "
                    "restore a copy"
                ) from error


def _rebuild(
    name: str, columns: str, source: str, filled: Mapping[str, str], *options: str
) -> None:
    """Give a table other columns; `filled` says what stands in those that `source`, o, lacks."""
    ending = ", ".join([*options, *(["STRICT"] if STRICT else [])])
    op.execute(f"CREATE TABLE new_{name} ({columns}) {ending}")
    described = op.get_bind().exec_driver_sql(f"PRAGMA table_info(new_{name})").all()
    values = ", ".join(filled.get(column, f"o.{column}") for _, column, *_ in described)
    # Through the driver: SQLAlchemy would take the colons in JSON for parameters.
    op.get_bind().exec_driver_sql(f"INSERT INTO new_{name} SELECT {values} FROM {source}").close()
    op.execute(f"DROP TABLE {name}")
    op.execute(f"ALTER TABLE new_{name} RENAME TO {name}")


def _parts(group: str, first: str) -> dict[str, str]:
    """Fill the columns of what a run is a function of.

    Two runs whose settings differ only in that one of them did not know some have the same key now.
    The finished or the older one of a group has it, and whatever is `first`; the others are marked.
    """
    order = f"PARTITION BY {group}, own ORDER BY status <> 'done', id"
    return {
        "key": f"own || CASE WHEN {first} OR row_number() OVER ({order}) = 1 "
        "THEN '' ELSE '-' || id END",
        "world": f"'{WORLD}'",
        "repertoire": f"'{json.dumps(REPERTOIRE, separators=(',', ':'))}'",
        "binding_behavior": "'grasp'",
        "binding_params": "grasp_params(o.settings)",
        "explorer": f"'{EXPLORER}'",
        "sensor": "sensor_kind(o.settings)",
        "settings": "differing(o.settings)",
    }


@lru_cache(maxsize=4096)
def _settings(text: str) -> dict[str, dict[str, Any]]:
    """Return all settings of a run; what its version did not know has its default."""
    stored = json.loads(text)
    sections = DEFAULTS.keys() | stored.keys()
    return {name: DEFAULTS.get(name, {}) | stored.get(name, {}) for name in sections}


def _json(value: Any) -> str:
    """Return canonical JSON: equal values give equal text."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def _key(value: Any) -> str:
    """Return the SHA-256 of a value's canonical JSON."""
    return hashlib.sha256(_json(value).encode()).hexdigest()


@lru_cache(maxsize=4096)
def differing(text: str) -> str:
    """Return the settings that differ from the defaults, but for the kind of the sensor."""
    values = {
        f"{section}.{key}": value + 0.0 if isinstance(value, float) else value
        for section, own in _settings(text).items()
        for key, value in own.items()
        if value != DEFAULTS.get(section, {}).get(key) and (section, key) != ("sensor", "kind")
    }
    return _json(values)


def sensor_kind(text: str) -> str:
    return str(_settings(text)["sensor"]["kind"])


def grasp_params(text: str) -> str:
    return json.dumps({"grasp_point": _settings(text)["tools"]["handle_below_grasp"]})


@lru_cache(maxsize=4096)
def _tool(text: str, name: str) -> dict[str, Any] | None:
    """Return one of the paper's tools by value (§4, Figs. 1 and 9); None for another name."""
    if name not in TOOLS:
        return None
    tools = _settings(text)["tools"]
    width, far, reach = tools["part_width"], tools["handle_length"], tools["bar_reach"]
    half, bar, hook, inner = width / 2.0, far - width, far - tools["hook_length"], reach - width
    boxes = {
        "handle": (-half, -tools["handle_below_grasp"], half, far),
        "left bar": (-reach, bar, -half, far),
        "right bar": (half, bar, reach, far),
        "left hook": (-reach, hook, -inner, bar),
        "right hook": (inner, hook, reach, bar),
    }
    color, parts = TOOLS[name]
    named = [(part, boxes[part]) for part in parts.split(", ")]
    outlines = [[part, [[a, b], [c, b], [c, d], [a, d]]] for part, (a, b, c, d) in named]
    return {"name": name, "color": color, "parts": outlines}


def tool_key(text: str, name: str) -> str | None:
    tool = _tool(text, name)
    return None if tool is None else _key(tool)


def tool_value(text: str, name: str) -> str:
    return _json(_tool(text, name))


def place(text: str, what: str, number: int) -> float:
    """Return a coordinate of one of the paper's goals and starts, 1 to 4 (in, Fig. 8)."""
    layout = _settings(text)["layout"]
    side, middle = layout["goal_side_x"], layout["midline"]
    known = {
        "goal_x": (0.0, 0.0, -side, side),
        "goal_y": (layout["goal_1_y"], layout["goal_2_y"], middle, middle),
        "goal_half_width": (layout["goal_half_width"],) * 4,
        "start_x": tuple((n - 2.5) * layout["start_spacing"] for n in (1, 2, 3, 4)),
        "start_y": (middle,) * 4,
    }
    return dict(enumerate(known[what], 1))[number]


def _canonical(text: str, **own: Any) -> dict[str, Any]:
    """Return what a key is made of."""
    return {
        **own,
        "binding": {"name": "grasp", "params": json.loads(grasp_params(text))},
        "explorer": {"name": EXPLORER, "params": {}, "version": 1},
        "repertoire": REPERTOIRE,
        "sensor": sensor_kind(text),
        "settings": json.loads(differing(text)),
        "world": {"name": WORLD, "params": {}, "version": 1},
    }


def learning_key(
    text: str, name: str, seed: int, robot: int, hours: float | None, behaviors: int | None
) -> str:
    tool = _tool(text, name) or {"name": name, "color": [128.0, 128.0, 128.0], "parts": []}
    own = {"seed": seed, "robot": robot, "hours": hours, "behaviors": behaviors, "tool": tool}
    return _key(_canonical(text, **own))


def session_key(kind: str, seed: int, robots: int, text: str) -> str:
    planner = {"name": PLANNER, "params": {}, "version": 1}
    own = {"kind": kind, "seed": seed, "robots": robots, "planner": planner, "task_set": TASK_SET}
    return _key(_canonical(text, **own))


FUNCTIONS = (
    *((differing, 1), (sensor_kind, 1), (grasp_params, 1), (tool_key, 2), (tool_value, 2)),
    *((place, 3), (learning_key, 6), (session_key, 4)),
)
"""What SQL calls, with how many values."""
