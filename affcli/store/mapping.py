"""Between core records and rows, both ways."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import direction_degrees
from affcli.core.observation import Observation
from affcli.core.trial import (
    LARGEST_SEED,
    LONGEST_HOURS,
    MOST_BEHAVIORS,
    MOST_ROBOTS,
    Attempt,
    BabblingRecord,
    LearningSpec,
    StepRecord,
    TrialEnd,
    TrialSpec,
    Truth,
)
from affcli.core.verification import ReplicationRecord
from affcli.errors import DatabaseError
from affcli.store.rows import (
    END_OBSERVATION,
    START_OBSERVATION,
    BehaviorRow,
    ReplicationRow,
    StepRow,
    TrialRow,
)

if TYPE_CHECKING:  # a worker that packs a robot's life needs no SQLAlchemy
    from sqlalchemy import RowMapping

MOST = 2**40
"""Uses of a row: a robot needs longer for more than there are robots for."""


def settings_key(settings: str) -> str:
    """Return the name by which equal settings are found: the SHA-256 of their canonical JSON."""
    return hashlib.sha256(settings.encode()).hexdigest()


def to_json(value: Mapping[str, Any]) -> str:
    """Return `value` as compact JSON, its keys in their own order."""
    return json.dumps(value, separators=(",", ":"), allow_nan=False)


@lru_cache(maxsize=256)
def params_to_json(call: BehaviorCall) -> str:
    """Return a call's parameters as ``{"offset_distance": 5.0}``."""
    return json.dumps(dict(call.params), allow_nan=False)


def behavior_call(name: str, params: str) -> BehaviorCall:
    """Return the call that a name and `params_to_json` stand for."""
    return BehaviorCall.of(BehaviorName(name), {k: float(v) for k, v in json.loads(params).items()})


@contextmanager
def reading_what_was_written(place: str) -> Iterator[None]:
    """Say so when a value in the database is one that affcli does not write.

    Args:
        place: which record, for the message.
    """
    try:
        yield
    except (
        *(ValueError, TypeError, KeyError, AttributeError, OverflowError),
        RecursionError,  # JSON nested a thousand deep
    ) as error:
        raise DatabaseError(
            f"{place} holds a value that affcli did not write; restore a copy of the database"
        ) from error


def behavior_row(run: int, record: BabblingRecord, truth: Truth) -> BehaviorRow:
    """Return the row of one exploratory behavior of learning run `run`."""
    execution, start, end = record.execution, record.start, record.end
    return BehaviorRow(
        learning_run_id=run,
        step=record.step,
        clock=record.clock,
        exploratory_behavior=execution.call.name,
        exploratory_params=params_to_json(execution.call),
        status=execution.status,
        duration=execution.duration,
        resets=record.resets,
        redraws=record.redraws,
        place_x=record.placing.call["x"],
        place_y=record.placing.call["y"],
        wrist_start_x=execution.wrist_start.x,
        wrist_start_y=execution.wrist_start.y,
        wrist_end_x=execution.wrist_end.x,
        wrist_end_y=execution.wrist_end.y,
        start_object_x=start.object_x,
        start_object_y=start.object_y,
        start_wrist_to_object_x=start.wrist_to_object_x,
        start_wrist_to_object_y=start.wrist_to_object_y,
        end_object_x=end.object_x,
        end_object_y=end.object_y,
        end_wrist_to_object_x=end.wrist_to_object_x,
        end_wrist_to_object_y=end.wrist_to_object_y,
        true_start_x=truth.start.x,
        true_start_y=truth.start.y,
        true_start_angle=truth.start.angle,
        true_end_x=truth.end.x,
        true_end_y=truth.end.y,
        true_end_angle=truth.end.angle,
        change_detected=record.affordance is not None,
    )


def affordance_row(run: int, tool: str, row: Affordance) -> tuple[object, ...]:
    """Return the row of one affordance, in the order of `AFFORDANCE_COLUMNS`."""
    expected = row.expected_movement
    return (
        run,
        row.step,
        tool,
        row.binding.name,
        params_to_json(row.binding),
        row.exploratory.name,
        params_to_json(row.exploratory),
        row.truncated,
        *row.start,
        *row.end,
        expected.distance,
        direction_degrees(expected.dx, expected.dy),
        row.times_used,
        row.times_successful,
    )


def affordance_from(row: "RowMapping | dict[str, Any]", *, as_learned: bool) -> Affordance:
    """Return an affordance from its row.

    Args:
        row: all columns of an affordance.
        as_learned: give it the counters 1 and 1 of a fresh row, whatever is stored.

    Raises:
        ValueError: a value is none that affcli writes.
    """
    if not 0 <= row["times_successful"] <= row["times_used"] or not 0 < row["times_used"] <= MOST:
        raise ValueError("counters that no uses can give")
    return Affordance(
        step=row["step"],
        binding=behavior_call(row["binding_behavior"], row["binding_params"]),
        exploratory=behavior_call(row["exploratory_behavior"], row["exploratory_params"]),
        start=Observation(*(float(row[name]) for name in START_OBSERVATION)),
        end=Observation(*(float(row[name]) for name in END_OBSERVATION)),
        truncated=bool(row["truncated"]),
        times_used=1 if as_learned else row["times_used"],
        times_successful=1 if as_learned else row["times_successful"],
    )


def learning_spec_from(row: "RowMapping") -> LearningSpec:
    """Return what a stored learning run is a function of; ValueError when it can be of none."""
    hours, behaviors = row["hours"], row["behaviors_limit"]
    if not (
        0 <= row["seed"] <= LARGEST_SEED
        and 0 <= row["robot"] < MOST_ROBOTS
        and (hours is None or 0.0 < hours <= LONGEST_HOURS)
        and (behaviors is None or 0 < behaviors <= MOST_BEHAVIORS)
        and (hours is None) is not (behaviors is None)
    ):
        raise ValueError("a seed, a robot, hours or behaviors out of range")
    return LearningSpec(
        tool=row["tool"],
        seed=row["seed"],
        robot=row["robot"],
        hours=row["hours"],
        behaviors=row["behaviors_limit"],
        settings=row["settings"],
    )


def trial_row(session: int, run: int, spec: TrialSpec, calibration: str | None) -> TrialRow:
    """Return the row of a trial that has not ended."""
    return TrialRow(
        session_id=session,
        learning_run_id=run,
        protocol=spec.protocol,
        robot=spec.robot,
        tool=spec.tool,
        shape=spec.shape,
        goal=spec.goal,
        start=spec.start,
        seed=spec.seed,
        counters=spec.counters,
        sensor=spec.sensor,
        calibration=calibration,
    )


def trial_end_columns(end: TrialEnd) -> dict[str, Any]:
    """Return the columns of a trial that its end fills."""
    left = {} if end.last_survivors is None else end.last_survivors._asdict()
    return {
        "outcome": end.outcome,
        "steps": end.steps,
        "robot_seconds": end.clock,
        **{f"last_rows_{name}": count for name, count in left.items()},
    }


def step_row(
    trial: int, affordance_id: int, record: StepRecord, truth: Truth, lost: bool | None
) -> StepRow:
    """Return the row of one step of trial `trial`, which tried affordance `affordance_id`."""
    return StepRow(
        trial_id=trial,
        affordance_id=affordance_id,
        number=record.number,
        clock=record.clock,
        rows_consistent=record.survivors.consistent,
        rows_probable=record.survivors.probable,
        rows_reachable=record.survivors.reachable,
        rows_nearest=record.survivors.nearest,
        true_start_x=truth.start.x,
        true_start_y=truth.start.y,
        true_end_x=truth.end.x,
        true_end_y=truth.end.y,
        died=record.died,
        lost=lost,
        **_attempt_columns(record),
    )


def replication_row(
    verification: int, affordance_id: int, record: ReplicationRecord, truth: Truth
) -> ReplicationRow:
    """Return the row of one try of a verification, which tried affordance `affordance_id`."""
    return ReplicationRow(
        verification_id=verification,
        affordance_id=affordance_id,
        number=record.number,
        clock=record.clock,
        true_start_x=truth.start.x,
        true_start_y=truth.start.y,
        true_start_angle=truth.start.angle,
        true_end_x=truth.end.x,
        true_end_y=truth.end.y,
        true_end_angle=truth.end.angle,
        live=record.live,
        died=record.live and record.died,
        **_attempt_columns(record),
    )


def _attempt_columns(record: Attempt) -> dict[str, Any]:
    """Return the columns that say what was done with a row, seen, and counted."""
    # When the tool could not be lowered nothing was executed: the placing tells of the wrist.
    moved = record.execution or record.placing
    return {
        "placing_status": record.placing.status,
        "status": None if record.execution is None else record.execution.status,
        "wrist_start_x": moved.wrist_start.x,
        "wrist_start_y": moved.wrist_start.y,
        "wrist_end_x": moved.wrist_end.x,
        "wrist_end_y": moved.wrist_end.y,
        "start_object_x": record.start.object_x,
        "start_object_y": record.start.object_y,
        "end_object_x": record.end.object_x,
        "end_object_y": record.end.object_y,
        "expected_dx": record.expected.dx,
        "expected_dy": record.expected.dy,
        "seen_dx": record.seen.dx,
        "seen_dy": record.seen.dy,
        "seen_distance": record.seen.distance,
        "replicated": record.replicated,
        "times_used_before": record.row.times_used,
        "times_used_after": record.times_used_after,
        "times_successful_before": record.row.times_successful,
        "times_successful_after": record.times_successful_after,
    }
