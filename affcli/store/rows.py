"""The tables as this code knows them: one tuple type each, in the order of its columns.

Only ``migrations/`` makes schema; a test compares the two.
"""

from typing import NamedTuple

from affcli.core.observation import Observation


class SessionRow(NamedTuple):
    """One command that produced trials or a reproduction."""

    kind: str
    seed: int
    robots: int
    settings: str
    settings_key: str
    versions: str
    status: str
    started_at: str
    finished_at: str | None


class LearningRunRow(NamedTuple):
    """One robot's learning with one tool."""

    session_id: int | None
    tool: str
    seed: int
    robot: int
    hours: float | None
    behaviors_limit: int | None
    settings: str
    settings_key: str
    versions: str
    status: str
    behaviors: int
    rows: int
    resets: int
    redraws: int
    robot_seconds: float
    checkpoint: str | None
    started_at: str
    finished_at: str | None
    calibration: str | None = None


class BehaviorRow(NamedTuple):
    """One exploratory behavior of a learning run, with or without effect."""

    learning_run_id: int
    step: int
    clock: float
    exploratory_behavior: str
    exploratory_params: str
    status: str
    duration: float
    resets: int
    redraws: int
    place_x: float
    place_y: float
    wrist_start_x: float
    wrist_start_y: float
    wrist_end_x: float
    wrist_end_y: float
    start_object_x: float
    start_object_y: float
    start_wrist_to_object_x: float
    start_wrist_to_object_y: float
    end_object_x: float
    end_object_y: float
    end_wrist_to_object_x: float
    end_wrist_to_object_y: float
    true_start_x: float
    true_start_y: float
    true_start_angle: float
    true_end_x: float
    true_end_y: float
    true_end_angle: float
    change_detected: bool


class TrialRow(NamedTuple):
    """One testing trial."""

    session_id: int
    learning_run_id: int
    protocol: str
    robot: int
    tool: str
    shape: str
    goal: int
    start: int
    seed: int
    counters: str
    outcome: str | None = None
    steps: int | None = None
    robot_seconds: float | None = None
    last_rows_consistent: int | None = None
    last_rows_probable: int | None = None
    last_rows_reachable: int | None = None
    last_rows_nearest: int | None = None
    sensor: str = "noisy"
    calibration: str | None = None


class StepRow(NamedTuple):
    """One step of a testing trial."""

    trial_id: int
    affordance_id: int
    number: int
    clock: float
    rows_consistent: int
    rows_probable: int
    rows_reachable: int
    rows_nearest: int
    placing_status: str
    status: str | None
    wrist_start_x: float
    wrist_start_y: float
    wrist_end_x: float
    wrist_end_y: float
    start_object_x: float
    start_object_y: float
    end_object_x: float
    end_object_y: float
    true_start_x: float
    true_start_y: float
    true_end_x: float
    true_end_y: float
    expected_dx: float
    expected_dy: float
    seen_dx: float
    seen_dy: float
    seen_distance: float
    replicated: bool
    times_used_before: int
    times_used_after: int
    times_successful_before: int
    times_successful_after: int
    died: bool
    lost: bool | None


class VerificationRow(NamedTuple):
    """One verification of a table that updated its counters."""

    learning_run_id: int
    shape: str
    seed: int
    sensor: str
    calibration: str | None
    tries_wanted: int
    until_verdict: bool
    uses_before: int
    after_trial: int
    versions: str
    started_at: str
    verdict: str | None = None
    tries: int | None = None
    decided_after: int | None = None
    robot_seconds: float | None = None
    finished_at: str | None = None


class ReplicationRow(NamedTuple):
    """One try of a verification."""

    verification_id: int
    number: int
    clock: float
    affordance_id: int
    placing_status: str
    status: str | None
    wrist_start_x: float
    wrist_start_y: float
    wrist_end_x: float
    wrist_end_y: float
    start_object_x: float
    start_object_y: float
    end_object_x: float
    end_object_y: float
    true_start_x: float
    true_start_y: float
    true_start_angle: float
    true_end_x: float
    true_end_y: float
    true_end_angle: float
    expected_dx: float
    expected_dy: float
    seen_dx: float
    seen_dy: float
    seen_distance: float
    replicated: bool
    times_used_before: int
    times_used_after: int
    times_successful_before: int
    times_successful_after: int
    live: bool
    died: bool


START_OBSERVATION = tuple(f"start_{name}" for name in Observation._fields)
END_OBSERVATION = tuple(f"end_{name}" for name in Observation._fields)

AFFORDANCE_COLUMNS = (
    "learning_run_id",
    "step",
    "tool",
    "binding_behavior",
    "binding_params",
    "exploratory_behavior",
    "exploratory_params",
    "truncated",
    *START_OBSERVATION,
    *END_OBSERVATION,
    "movement",
    "direction",
    "times_used",
    "times_successful",
)
"""An affordance is a tuple of these: its 24 components are better made than written out."""
