"""The columns of each table. Only ``migrations/`` makes schema; a test compares the two."""

from affcli.core.observation import Observation


def _each(names: str, *axes: str) -> tuple[str, ...]:
    """Return columns: each of the names with each of the axes."""
    return tuple(f"{name}_{axis}" for name in names.split() for axis in axes)


_PARTS = (
    *("world", "repertoire", "binding_behavior", "binding_params", "explorer"),
    *("sensor", "settings", "versions", "status", "started_at", "finished_at"),
)
START_OBSERVATION = tuple(f"start_{name}" for name in Observation._fields)
END_OBSERVATION = tuple(f"end_{name}" for name in Observation._fields)
_USE = (
    *("placing_status", "status", "regrasped"),
    *_each("wrist_start wrist_end", "x", "y", "angle"),
    *_each("start_object end_object", "x", "y"),
    *_each("expected seen", "dx", "dy"),
    *("seen_distance", "replicated"),
    *_each("times_used times_successful", "before", "after"),
)
COLUMNS: dict[str, tuple[str, ...]] = {
    "tool": ("key", "name", "definition"),
    "experiment": (
        *("name", "question", "definition", "key", "versions", "status"),
        *("started_at", "finished_at"),
    ),
    "session": (
        *("key", "kind", "seed", "robots", *_PARTS, "planner", "task_set"),
        *("experiment_id", "condition"),
    ),
    "failed_robot": (
        *("session_id", "robot", "kind", "message", "traceback", "tries", "failed_at"),
    ),
    "learning_run": (
        *("session_id", "key", "tool", "tool_key", "seed", "robot", "hours", "behaviors_limit"),
        *_PARTS,
        *("behaviors", "rows", "resets", "redraws", "robot_seconds", "checkpoint", "calibration"),
        *("note", "kept", "transfer"),
    ),
    "behavior": (
        *("learning_run_id", "step", "clock", "exploratory_behavior", "exploratory_params"),
        *("status", "duration", "resets", "redraws", "place_x", "place_y"),
        *_each("wrist_start wrist_end", "x", "y", "angle"),
        *_each("start_object start_wrist_to_object end_object end_wrist_to_object", "x", "y"),
        *_each("true_start true_end", "x", "y", "angle"),
        "change_detected",
    ),
    "affordance": (
        *("learning_run_id", "step", "tool", "binding_behavior", "binding_params"),
        *("exploratory_behavior", "exploratory_params", "truncated"),
        *(*START_OBSERVATION, *END_OBSERVATION, "movement", "direction"),
        *("times_used", "times_successful", "wrist_angle", "travel_x", "travel_y"),
    ),
    "trial": (
        *("session_id", "learning_run_id", "protocol", "robot", "tool", "shape", "shape_key"),
        *("task_set", "goal", "goal_x", "goal_y", "goal_half_width", "start", "start_x", "start_y"),
        *("seed", "counters", "planner", "sensor", "world", "calibration"),
        *("outcome", "steps", "robot_seconds", "last_reasons"),
    ),
    "step": (
        *("trial_id", "affordance_id", "number", "clock", "reasons", *_USE),
        *(*_each("true_start true_end", "x", "y"), "died", "lost"),
    ),
    "verification": (
        *("learning_run_id", "shape", "shape_key", "seed", "sensor", "world", "calibration"),
        *("tries_wanted", "until_verdict", "uses_before", "after_trial", "versions", "started_at"),
        *("verdict", "tries", "decided_after", "robot_seconds", "finished_at"),
    ),
    "invention": (
        *("learning_run_id", "number", "exploratory_behavior", "exploratory_params", "motion"),
        *("step", "gain", "kept"),
    ),
    "invention_try": ("learning_run_id", "number", "step", "alike"),
    "mask": (
        *("learning_run_id", "first_column", "first_row", "columns", "rows", "scale", "cells"),
        *("red", "green", "blue"),
    ),
    "borrowed": (
        *("learning_run_id", "step", "lender_key", "lender_tool", "lender_step"),
        *("shift_x", "shift_y", "mirrored"),
    ),
    "log": ("learning_run_id", "source", "licence", "citation", "map", "left_out"),
    "log_file": ("learning_run_id", "number", "name", "sha256"),
    "log_line": ("learning_run_id", "step", "file", "line", "object"),
    "replication": (
        *("verification_id", "affordance_id", "number", "clock", *_USE),
        *(*_each("true_start true_end", "x", "y", "angle"), "live", "died"),
    ),
}
"""The columns of each table but for `id`, in the order of the rows that are written."""
JSON_COLUMNS = frozenset(
    {
        *("settings", "versions", "repertoire", "binding_params", "exploratory_params"),
        *("checkpoint", "calibration", "reasons", "last_reasons", "definition", "map", "motion"),
        "transfer",
    }
)
"""Columns that hold JSON."""
NUMBERED = ("experiment", "session", "learning_run", "affordance", "trial", "verification")
"""The tables whose rows have an `id`."""
