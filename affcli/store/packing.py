"""The life of a robot as plain rows, which travel between processes far faster than records.

A life is some 4,000 behaviors. Pickled as records it takes half a second of the two processes
together, as rows a tenth of it; and the worker does the mapping. Needs no SQLAlchemy.
"""

from dataclasses import dataclass
from typing import Any

from affcli.core.invention import Invention
from affcli.core.specs import Keep, LearningSpec, RobotRecord, TrialRecord
from affcli.core.tool import Tool
from affcli.store.rows import (
    Row,
    affordance_row,
    behavior_row,
    borrowed_row,
    mask_row,
    step_row,
    trial_end_row,
    trial_row,
)


@dataclass(frozen=True, slots=True)
class PackedTrial:
    """One trial as rows.

    Args:
        held: the tool truly held.
        row: the trial, without the ids of its session and run.
        steps: its steps, without the ids of the trial and the affordance.
        tried: the learning step of the affordance that each step tried.
    """

    held: Tool
    row: dict[str, Any]
    steps: tuple[Row, ...]
    tried: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class PackedRun:
    """One finished learning run as rows, with the trials that start from its table.

    Args:
        spec: what the run is a function of.
        calibration: of the robot's camera, as JSON; None without one.
        behaviors, affordances: rows without the run's id; none where they are not kept.
        sums: columns of the whole run.
        kept: how much of it is kept.
        trials: those that start from its table, by the condition that they are part of.
        inventions: what the robot invented in it.
        borrowed: where each row comes from that it borrowed, without the run's id.
        mask: what its camera saw of the tool, without the run's id; none where nobody asked.
    """

    spec: LearningSpec
    calibration: str | None
    behaviors: tuple[Row, ...]
    affordances: tuple[Row, ...]
    sums: dict[str, float]
    kept: Keep
    trials: dict[int, list[PackedTrial]]
    inventions: tuple[Invention, ...] = ()
    borrowed: tuple[Row, ...] = ()
    mask: tuple[Row, ...] = ()


@dataclass(frozen=True, slots=True)
class PackedRobot:
    """The life of one robot as rows.

    Args:
        robot: its number.
        runs: what it learned, and how it was tested with it.
    """

    robot: int
    runs: tuple[PackedRun, ...]


def pack_robot(record: RobotRecord, keep: Keep = Keep.ALL) -> PackedRobot:
    """Return what is kept of the life of a robot as rows, ready to be sent to who saves it."""
    runs = []
    for number, (spec, steps, seconds) in enumerate(record.learned):
        lent = record.borrowed.get(number, ())
        rows = [one.row for one in lent]
        rows += [r.affordance for r, _ in steps if r.affordance is not None]
        seen = record.masks.get(number)
        invented = [one for one in record.invented if one.run == number]
        trials: dict[int, list[PackedTrial]] = {one.condition: [] for one in invented}
        if number in record.lent:
            trials[record.lent[number]] = []
        for condition, run, trial in record.tested:
            if run == number:
                trials.setdefault(condition, []).append(pack_trial(trial, keep))
        runs.append(
            PackedRun(
                spec=spec,
                calibration=record.calibrations[number],
                behaviors=tuple(behavior_row(0, *step)[1:] for step in steps if keep is Keep.ALL),
                affordances=tuple(
                    affordance_row(0, spec.tool, row)[1:] for row in rows if keep is not Keep.TRIALS
                ),
                sums={
                    "behaviors": len(steps),
                    "rows": len(rows),
                    "resets": sum(r.resets for r, _ in steps),
                    "redraws": sum(r.redraws for r, _ in steps),
                    "robot_seconds": seconds,
                },
                kept=keep,
                trials=trials,
                inventions=invented[0].inventions if invented else (),
                borrowed=tuple(borrowed_row(0, one)[1:] for one in lent if keep is not Keep.TRIALS),
                mask=() if seen is None else (mask_row(0, seen)[1:],),
            )
        )
    return PackedRobot(record.robot, tuple(runs))


def pack_trial(trial: TrialRecord, keep: Keep = Keep.ALL) -> PackedTrial:
    """Return what is kept of a trial as rows."""
    steps = trial.steps if keep is not Keep.TRIALS else ()
    return PackedTrial(
        held=trial.spec.held,
        row=trial_row(trial.spec, trial.calibration) | trial_end_row(trial.end),
        steps=tuple(step_row(0, 0, *step)[2:] for step in steps),
        tried=tuple(step.record.row.step for step in steps),
    )
