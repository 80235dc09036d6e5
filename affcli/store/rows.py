"""From records to rows. Needs no SQLAlchemy: a worker process turns what a robot did into rows."""

import json
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, repertoire_json
from affcli.core.choice import Reasons
from affcli.core.geometry import direction_degrees
from affcli.core.identity import canonical_json
from affcli.core.mask import SCALE, Mask
from affcli.core.specs import LearningSpec, SessionSpec, TrialSpec, VerificationSpec
from affcli.core.tool import Tool
from affcli.core.transfer import Borrowed
from affcli.core.trial import Attempt, BabblingRecord, StepRecord, TrialEnd, Truth
from affcli.core.verification import ReplicationRecord

Row = tuple[object, ...]
"""The values of a row in the order of `columns.COLUMNS`."""


def to_json(value: Any) -> str:
    """Return `value` as compact JSON, its keys in their own order."""
    return json.dumps(value, separators=(",", ":"), allow_nan=False)


@lru_cache(maxsize=256)
def params_to_json(call: BehaviorCall) -> str:
    """Return a call's parameters as ``{"offset_distance": 5.0}``."""
    return json.dumps(dict(call.params), allow_nan=False)


def bindings_to_json(bindings: Sequence[BehaviorCall]) -> str:
    """Return the parameters of a run's bindings, which all have one name: of several as a list."""
    texts = [params_to_json(one) for one in bindings]
    return texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]"


def tool_row(tool: Tool) -> Row:
    """Return the row of a tool whose shape is known."""
    return (tool.key, tool.name, canonical_json(tool.canonical()))


def tool_key(tool: Tool) -> str | None:
    """Return the key by which records refer to a tool; None where its shape is not known."""
    return tool.key if tool.parts else None


def _parts_of(
    spec: SessionSpec | LearningSpec, versions: Mapping[str, str], now: str
) -> dict[str, Any]:
    """Return the columns that a session and a learning run share."""
    return {
        "key": spec.key,
        "seed": spec.seed,
        "world": str(spec.world),
        "repertoire": to_json(repertoire_json(spec.repertoire)),
        "binding_behavior": spec.binding.name,
        "binding_params": bindings_to_json(spec.bindings),
        "explorer": str(spec.explorer),
        "sensor": spec.sensor,
        "settings": spec.settings,
        "versions": to_json(versions),
        "status": "running",
        "started_at": now,
    }


def session_row(spec: SessionSpec, versions: Mapping[str, str], now: str) -> dict[str, Any]:
    """Return the columns of a session that begins now."""
    return {
        **_parts_of(spec, versions, now),
        "kind": spec.kind,
        "robots": spec.robots,
        "planner": str(spec.planner),
        "task_set": spec.task_set,
    }


def learning_run_row(
    spec: LearningSpec, versions: Mapping[str, str], now: str, session: int | None
) -> dict[str, Any]:
    """Return the columns of a run in which nothing was executed yet."""
    return {
        **_parts_of(spec, versions, now),
        "session_id": session,
        "tool": spec.tool,
        "tool_key": tool_key(spec.held),
        "robot": spec.robot,
        "hours": spec.hours,
        "behaviors_limit": spec.behaviors,
        "transfer": None if spec.transfer is None else canonical_json(spec.transfer.canonical()),
        **dict.fromkeys(("behaviors", "rows", "resets", "redraws"), 0),
        "robot_seconds": 0.0,
    }


def behavior_row(run: int, record: BabblingRecord, truth: Truth | None) -> Row:
    """Return the row of one exploratory behavior of a learning run."""
    execution, start, end = record.execution, record.start, record.end
    return (
        *(run, record.step, record.clock, execution.call.name, params_to_json(execution.call)),
        *(execution.status, execution.duration, record.resets, record.redraws),
        *(record.placing.call["x"], record.placing.call["y"]),
        *(*execution.wrist_start, *execution.wrist_end),
        *(*start.object_position, *start.wrist_to_object),
        *(*end.object_position, *end.wrist_to_object),
        *((None,) * 6 if truth is None else (*truth.start, *truth.end)),
        record.affordance is not None,
    )


def affordance_row(run: int, tool: str, row: Affordance) -> Row:
    """Return the row of one affordance."""
    expected = row.expected_movement
    return (
        *(run, row.step, tool, row.binding.name, params_to_json(row.binding)),
        *(row.exploratory.name, params_to_json(row.exploratory), row.truncated),
        *(*row.start, *row.end),
        *(expected.distance, direction_degrees(expected.dx, expected.dy)),
        *(row.times_used, row.times_successful, row.wrist_angle, *row.travel),
    )


def mask_row(run: int, mask: Mask) -> Row:
    """Return the row of what a run's camera saw of its tool."""
    return (
        *(run, mask.column, mask.row, mask.columns, mask.rows, SCALE, mask.cells.hex()),
        *mask.color,
    )


def borrowed_row(run: int, one: Borrowed) -> Row:
    """Return the row that says where a borrowed row comes from."""
    return (run, one.row.step, one.lender, one.tool, one.step, *one.shift, one.mirrored)


def trial_row(spec: TrialSpec, calibration: str | None) -> dict[str, Any]:
    """Return the columns of a trial that has not ended, but for its session and run."""
    goal, start = spec.task.goal, spec.task.start
    return {
        "protocol": spec.protocol,
        "robot": spec.robot,
        "seed": spec.seed,
        "tool": spec.tool,
        "shape": spec.shape,
        "shape_key": tool_key(spec.held),
        "task_set": spec.task.task_set,
        "goal": goal.name,
        "goal_half_width": goal.half_width,
        "goal_x": goal.center.x,
        "goal_y": goal.center.y,
        "start": spec.start,
        "start_x": start.x,
        "start_y": start.y,
        "counters": spec.counters,
        "planner": str(spec.planner),
        "sensor": spec.sensor,
        "world": str(spec.world),
        "calibration": calibration,
    }


def trial_end_row(end: TrialEnd) -> dict[str, Any]:
    """Return the columns of a trial that its end fills."""
    last = None if end.last_reasons is None else reasons_json(end.last_reasons)
    ended = {"outcome": end.outcome, "steps": end.steps, "robot_seconds": end.clock}
    return {**ended, "last_reasons": last}


def step_row(
    trial: int, affordance: int, record: StepRecord, truth: Truth | None, lost: bool | None
) -> Row:
    """Return the row of one step of a trial, which tried an affordance of the store."""
    true = (None,) * 4 if truth is None else (*truth.start.point, *truth.end.point)
    return (
        *(trial, affordance, record.number, record.clock, reasons_json(record.reasons)),
        *(*_use(record), *true, record.died, lost),
    )


def verification_row(run: int, spec: VerificationSpec, calibration: str | None) -> dict[str, Any]:
    """Return the columns of a verification that say which it is."""
    return {
        "learning_run_id": run,
        "shape": spec.shape,
        "shape_key": tool_key(spec.held),
        "seed": spec.seed,
        "sensor": spec.sensor,
        "calibration": calibration,
        "tries_wanted": spec.tries,
        "until_verdict": spec.until_verdict,
    }


def replication_row(
    verification: int, affordance: int, record: ReplicationRecord, truth: Truth | None
) -> Row:
    """Return the row of one try of a verification, which tried an affordance of the store."""
    true = (None,) * 6 if truth is None else (*truth.start, *truth.end)
    return (
        *(verification, affordance, record.number, record.clock),
        *(*_use(record), *true, record.live, record.live and record.died),
    )


def reasons_json(reasons: Reasons) -> str:
    """Return a planner's reasons as a list in JSON."""
    return to_json([reason.json() for reason in reasons])


def _use(record: Attempt) -> Row:
    """Return what was done with a row, seen, and counted."""
    # When the tool could not be lowered nothing was executed: the placing tells of the wrist.
    moved = record.execution or record.placing
    return (
        *(record.placing.status, None if record.execution is None else record.execution.status),
        *(record.regrasped, *moved.wrist_start, *moved.wrist_end),
        *(*record.start.object_position, *record.end.object_position),
        *(record.expected.dx, record.expected.dy, record.seen.dx, record.seen.dy),
        *(record.seen.distance, record.replicated),
        *(record.row.times_used, record.times_used_after),
        *(record.row.times_successful, record.times_successful_after),
    )
