"""From a log to runs: one for each tool, whose behaviors are the trials with it, in their order."""

import hashlib
import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from affcli.core.affordance import Affordance
from affcli.core.behavior import (
    GRASP,
    POSITION_WRIST,
    BehaviorCall,
    Execution,
    ExecutionStatus,
    ExploratoryBehavior,
)
from affcli.core.change_detection import change_detected
from affcli.core.geometry import Point
from affcli.core.identity import Component, canonical_json
from affcli.core.log import LOG, NO_POSE, NOT_LOGGED, LogLine, LogSource, counters_of_repeats
from affcli.core.observation import Movement, Observation
from affcli.core.specs import LearningSpec, LearningStep
from affcli.core.tool import unknown_tool
from affcli.core.trial import BabblingRecord
from affcli.errors import BadInputError, one_line
from affcli.logs.reading import MOST_CALLS, MOST_TOOLS, Log, LoggedTrial

HELD = BehaviorCall.of(GRASP, {})
"""A tool in a hand was grasped; where, a log does not say."""
PLACED = Execution(
    BehaviorCall.of(POSITION_WRIST, {"x": NOT_LOGGED, "y": NOT_LOGGED}),
    *(ExecutionStatus.DONE, NO_POSE, NO_POSE, NOT_LOGGED),
)
SAME_PLACE = 1.0
"""Repeats begin in the same square of this size as seen from the wrist, where the log knows (in).
Choice: two of them are within what the table still predicts by a row (1.5 in)."""
UNKNOWN = (NOT_LOGGED,) * 6


@dataclass(frozen=True, slots=True)
class LoggedRun:
    """A run as it is imported.

    Args:
        spec: what it is; equal for equal files and an equal map.
        steps: what was done, with the rows that it made.
        lines: where each of them stands.
        source: where all of it comes from.
    """

    spec: LearningSpec
    steps: Sequence[LearningStep]
    lines: Sequence[LogLine]
    source: LogSource

    @property
    def seconds(self) -> float:
        """When it was over; NaN where the log has no times."""
        return self.steps[-1][0].clock


def runs_of(log: Log) -> list[LoggedRun]:
    """Return the runs of a log, in the order in which their tools come.

    Raises:
        BadInputError: more tools or behaviors than a database keeps.
    """
    by_tool: dict[str, list[LoggedTrial]] = defaultdict(list)
    for trial in log.trials:
        by_tool[trial.tool].append(trial)
    if len(by_tool) > MOST_TOOLS:
        raise BadInputError(
            f"{len(by_tool)} tools in the log: at most {MOST_TOOLS}; "
            "is [columns] tool the right one?"
        )
    how = log.map
    content = canonical_json({"map": how.tables, "files": [one.sha256 for one in log.files]})
    world = Component.of(LOG, {"content": f"sha256-{hashlib.sha256(content.encode()).hexdigest()}"})
    source = LogSource(
        *(how.source, how.licence, how.citation, how.tables, log.left_out, tuple(log.files))
    )
    return [_run(tool, trials, world, source) for tool, trials in by_tool.items()]


def _run(
    tool: str, trials: Sequence[LoggedTrial], world: Component, source: LogSource
) -> LoggedRun:
    """Return the run of one tool."""
    calls = dict.fromkeys(trial.call for trial in trials)
    if len(calls) > MOST_CALLS:
        raise BadInputError(
            f"{len(calls)} behaviors with the {one_line(tool, 40)}, counting parameters: at most "
            f"{MOST_CALLS}; leave out a parameter"
        )
    spec = LearningSpec(
        held=unknown_tool(tool),
        seed=0,
        robot=0,
        hours=None,
        behaviors=len(trials),
        settings="{}",
        world=world,
        repertoire=tuple(ExploratoryBehavior(call, ()) for call in calls),
        binding=HELD,
        explorer=Component(LOG),
        sensor=LOG,
    )
    counters = _counters(trials)
    steps = [_step(n, trial, counters[n]) for n, trial in enumerate(trials, 1)]
    lines = [LogLine(n, one.file, one.line, one.object) for n, one in enumerate(trials, 1)]
    return LoggedRun(spec, steps, lines, source)


def _counters(trials: Sequence[LoggedTrial]) -> Mapping[int, tuple[int, int]]:
    """Return the counters that the repeats of each trial give, by its step.

    Repeats are trials with the same object and behavior, begun at the same place as seen from the
    wrist where the log knows it.
    """
    repeats: dict[tuple[object, ...], list[int]] = defaultdict(list)
    for step, trial in enumerate(trials, 1):
        place = tuple(None if math.isnan(axis) else axis // SAME_PLACE for axis in trial.offset)
        repeats[trial.object, trial.call, place].append(step)
    counters: dict[int, tuple[int, int]] = {}
    for steps in repeats.values():
        movements = [_moved(trials[step - 1]) for step in steps]
        counters |= dict(zip(steps, counters_of_repeats(movements), strict=True))
    return counters


def _moved(trial: LoggedTrial) -> Movement:
    return Movement(trial.end.x - trial.start.x, trial.end.y - trial.start.y, 0.0)


def _step(number: int, trial: LoggedTrial, counters: tuple[int, int]) -> LearningStep:
    """Return a trial as a behavior of its run."""
    start = Observation(*trial.start, NOT_LOGGED, *trial.offset, NOT_LOGGED, *UNKNOWN)
    end = Observation(*trial.end, *(NOT_LOGGED,) * 4, *UNKNOWN)
    row = None
    if change_detected(start, end):
        successful, used = counters
        travel = Point(NOT_LOGGED, NOT_LOGGED)
        row = Affordance(
            *(number, HELD, trial.call, start, end, False),
            *(used, successful, NOT_LOGGED, travel),
        )
    done = Execution(trial.call, ExecutionStatus.DONE, NO_POSE, NO_POSE, trial.duration)
    return BabblingRecord(number, trial.clock, 0, 0, PLACED, done, start, end, row), None
