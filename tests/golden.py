"""Digests of what robots did: equal digests mean equal numbers, to the last bit.

The expected ones in ``golden.json`` are of version 2 of the world `table`, over the columns below
in the order of their rows. They change only when the physics or a default changes, and then for a
reason that the commit gives.
"""

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path

from affcli.core.behavior import BehaviorCall
from affcli.core.specs import LearningStep, RobotRecord, TrialRecord

GOLDEN: dict[str, dict[str, str]] = json.loads(Path(__file__).with_name("golden.json").read_text())
"""For each sensor the digests by robot: of its learning, then of its trials."""
CAMERA_ROWS: dict[str, list[list[object]]] = json.loads(
    Path(__file__).with_name("golden_camera.json").read_text()
)
"""The same of a robot with a camera, by its tool: the rows themselves. Their last bits are those of
the processor that calibrated, of which there are several; digests cannot say how near two are."""
SEED = 4242


def digest(rows: Iterable[tuple[object, ...]]) -> str:
    """Return the first 64 bits of the SHA-256 over the representations of rows."""
    total = hashlib.sha256()
    for row in rows:
        total.update(repr(row).encode())
    return total.hexdigest()[:16]


def of_robot(life: RobotRecord) -> str:
    """Return the digests of a robot's learning and of its trials."""
    learned = (row for _, steps, _ in life.learned for row in learning_rows(steps))
    return f"{digest(learned)} {of_trials(life.trials)}"


def of_trials(trials: Iterable[TrialRecord]) -> str:
    """Return the digest of some trials."""
    return digest(row for trial in trials for row in trial_rows(trial))


def learning_rows(steps: Iterable[LearningStep]) -> Iterable[tuple[object, ...]]:
    """Yield what is kept of each behavior, followed by the row it made."""
    for record, truth in steps:
        assert truth is not None
        done, start, end = record.execution, record.start, record.end
        yield (
            *(record.step, record.clock, str(done.call.name), params(done.call), str(done.status)),
            *(done.duration, record.resets, record.redraws),
            *(record.placing.call["x"], record.placing.call["y"]),
            *(*done.wrist_start.point, *done.wrist_end.point),
            *(*start.object_position, *start.wrist_to_object),
            *(*end.object_position, *end.wrist_to_object),
            *(*truth.start, *truth.end),
            int(record.affordance is not None),
        )
        row = record.affordance
        if row is not None:
            yield (
                *(row.step, str(row.binding.name), params(row.binding)),
                *(str(row.exploratory.name), params(row.exploratory), int(row.truncated)),
                *(*row.start, *row.end, row.expected_movement.distance),
                *(row.times_used, row.times_successful),
            )


def trial_rows(trial: TrialRecord) -> Iterable[tuple[object, ...]]:
    """Yield what is kept of each step of a trial, and of its end."""
    for record, truth, lost in trial.steps:
        assert truth is not None
        moved = record.execution or record.placing
        yield (
            *(record.number, record.clock, record.row.step),
            *(reason.rows for reason in record.reasons),
            *(str(record.placing.status), record.execution and str(record.execution.status)),
            *(*moved.wrist_start.point, *moved.wrist_end.point),
            *(*record.start.object_position, *record.end.object_position),
            *(*truth.start.point, *truth.end.point),
            *(record.expected.dx, record.expected.dy, record.seen.dx, record.seen.dy),
            *(record.seen.distance, int(record.replicated)),
            *(record.row.times_used, record.times_used_after),
            *(record.row.times_successful, record.times_successful_after),
            *(int(record.live and record.died), None if lost is None else int(lost)),
        )
    spec, end = trial.spec, trial.end
    yield (
        *(str(spec.protocol), spec.tool, spec.shape, spec.goal, spec.start),
        *(str(end.outcome), end.steps, end.clock),
    )


def params(call: BehaviorCall) -> str:
    """Return the parameters of a call as JSON."""
    return json.dumps(dict(call.params))
