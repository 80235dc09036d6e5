"""Measures of conditions against robot time, rows or a setting, read for a figure."""

import json
import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from affcli.analysis.courses import Course, Line, course_line, swept_line
from affcli.analysis.curves import INTERVALS, Curve
from affcli.analysis.paired import all_tried, summed
from affcli.config import known_settings
from affcli.core.names import one_of
from affcli.errors import UsageError
from affcli.lab.conditions import Condition
from affcli.lab.run_parts import settings_of
from affcli.store import Store

MEASURES = {
    "solved": "solved trials",
    "rows": "rows of a table",
    "share": "share of behaviors with an effect",
}
TIME = {"minutes": "robot time with each tool (min)", "rows": "rows of a table"}
"""What a robot can be followed along."""


class Curves(NamedTuple):
    """What a figure of curves shows: lines, and the words of its axes."""

    lines: list[Line]
    x: str
    y: str


def curves_of(store: Store, conditions: Sequence[Condition], y: str, x: str | None) -> Curves:
    """Return a measure of each condition against something.

    Args:
        store: open.
        conditions: one at least.
        y: a key of `MEASURES`.
        x: a key of `TIME`, or the name of a setting; None for the setting in which the conditions
            differ if it is but one, else minutes.

    Raises:
        UsageError: there is no such measure or setting, or it is no number, or it is the same in
            all conditions, or nothing was learned.
    """
    y = one_of("measure", y, list(MEASURES))
    swept = _swept(conditions)
    x = x or (swept[0] if len(swept) == 1 else "minutes")
    values = _setting_values(conditions, x) if x not in TIME else None
    courses = (
        [_courses(store, one) for one in conditions] if y != "solved" or values is None else []
    )
    if y != "solved" and values is None:
        lines = [
            course_line(one.name, list(own.values()), y, x)
            for one, own in zip(conditions, courses, strict=True)
        ]
        return Curves(lines, TIME[x], MEASURES[y])
    places = values or [
        math.fsum(getattr(one, x)[-1] for one in own.values()) / len(own) for own in courses
    ]
    panels: dict[tuple[str, float], dict[float, Sequence[float]]] = defaultdict(dict)
    for number, (condition, place) in enumerate(zip(conditions, places, strict=True)):
        if y == "solved":
            cells = store.results.solved_by_cell(condition.session.id, ())
            for cell, counts in summed(cells).items():
                most = max(trials for trials, _ in counts.values())
                solved = all_tried(counts)
                panels[f"{cell.protocol}, of {most}", most][place] = solved
        else:
            ends = [getattr(one, y)[-1] for one in courses[number].values()]
            panels["", 1.0 if y == "share" else math.inf][place] = ends
    lines = [swept_line(panel, points, most) for (panel, most), points in panels.items()]
    return Curves(lines, TIME.get(x) or _setting_words(x), MEASURES[y])


def _swept(conditions: Sequence[Condition]) -> list[str]:
    """Return the settings in which conditions differ."""
    own = [json.loads(one.session.spec.settings) for one in conditions]
    names = sorted({name for settings in own for name in settings})
    return [name for name in names if len({str(one.get(name)) for one in own}) > 1]


def _setting_values(conditions: Sequence[Condition], name: str) -> list[float]:
    """Return the value of a setting in each condition."""
    name = one_of("axis", name, [*TIME, *known_settings()])
    values = []
    for one in conditions:
        value = settings_of(one.session.spec).values()[name]
        if isinstance(value, str):
            raise UsageError(f"{name} is no number; name another setting, or minutes or rows")
        values.append(float(value))
    if len(set(values)) < len(values):
        raise UsageError(
            f"{name} is {values[0]:g} in more than one condition; it differs: "
            f"{', '.join(_swept(conditions)) or 'no setting does'}"
        )
    return values


def _setting_words(name: str) -> str:
    """Return a setting with its unit."""
    unit = known_settings()[name].unit
    return f"{name} ({unit})" if unit else name


def _courses(store: Store, condition: Condition) -> Mapping[int, Course]:
    """Return how each robot of a condition learned."""
    runs = store.learning.runs(session_id=condition.session.id)
    if not runs or not all(run.robot_seconds for run in runs):
        raise UsageError(f"{condition.name}: nothing learned; name another session")
    seconds = max(run.robot_seconds for run in runs) / INTERVALS
    did = store.results.learning_intervals(seconds, condition.session.id)
    curves: dict[int, list[Curve]] = defaultdict(list)
    for run in runs:
        curves[run.spec.robot].append(Curve.of(run, did.get(run.id, ()), seconds))
    return {robot: Course.of(own) for robot, own in curves.items()}
