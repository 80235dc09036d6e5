"""Measures of conditions against robot time, rows or a setting, read for a figure."""

import json
import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from affcli.analysis.courses import Course, Line, course_line, swept_line
from affcli.analysis.curves import INTERVALS, Curve
from affcli.analysis.paired import all_tried, summed
from affcli.analysis.paper import trials_words
from affcli.config import known_settings
from affcli.core.names import one_of
from affcli.core.records import LearningRunInfo
from affcli.errors import UsageError, one_line
from affcli.lab.conditions import Condition, repeated
from affcli.lab.run_parts import settings_of
from affcli.store import Store

OF_TRIALS = {
    "solved": "solved trials",
    "steps": "steps of a solved trial",
    "seconds": "robot seconds of a solved trial",
    "error": "error of a step (in)",
}
"""What trials say of a condition: counted, or the mean of each robot. The error of a step is how
far it left the attractor from where its row said."""
MEASURES = {
    **OF_TRIALS,
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


def curves_of(
    store: Store,
    conditions: Sequence[Condition],
    y: str,
    x: str | None,
    tools: Sequence[str] = (),
) -> Curves:
    """Return a measure of each condition against something.

    Args:
        store: open.
        conditions: one at least.
        y: a key of `MEASURES`.
        x: a key of `TIME`, or the name of a setting; None for the setting in which the conditions
            differ if it is but one, else minutes.
        tools: only trials with these are counted; all if empty.

    Raises:
        UsageError: there is no such measure or setting, or it is no number, or it is the same in
            all conditions, or nothing was learned.
    """
    y = one_of("measure", y, list(MEASURES))
    swept = _swept(conditions)
    x = x or (swept[0] if len(swept) == 1 else "minutes")
    places: list[tuple[str, Sequence[float]]] = []
    if x not in TIME:
        places = [(name, (place,)) for name, place in _sweeps(conditions, x)]
    of_trials = y in OF_TRIALS
    by_end = of_trials and x == "minutes"
    courses = (
        [] if by_end or (of_trials and places) else [_courses(store, one) for one in conditions]
    )
    if not of_trials and not places:
        lines = [
            course_line(one.name, list(own.values()), y, x)
            for one, own in zip(conditions, courses, strict=True)
        ]
        return Curves(lines, TIME[x], MEASURES[y])
    if by_end:
        places = _lengths(store, conditions)
    # How many rows there are nobody chose: along them each condition is a mark by itself.
    places = places or [
        (one.name, (math.fsum(getattr(course, x)[-1] for course in own.values()) / len(own),))
        for one, own in zip(conditions, courses, strict=True)
    ]
    sweeps: dict[tuple[str, float, str], dict[float, Sequence[float]]] = defaultdict(dict)
    for number, (condition, (name, at)) in enumerate(zip(conditions, places, strict=True)):
        if of_trials:
            for panel, most, values in _of_trials(store, condition, y, tools):
                own = sweeps[panel, most, name]
                if own.keys() & set(at):
                    raise UsageError(
                        f"{condition.name}: another condition of the same line learned as long; "
                        'give it a name that differs in more than "minutes=N"'
                    )
                own |= dict.fromkeys(at, values)
        else:
            reached = [getattr(one, y)[-1] for one in courses[number].values()]
            most = 1.0 if y == "share" else math.inf
            sweeps["", most, name] |= dict.fromkeys(at, reached)
    if not sweeps:
        named = " or ".join(map(one_line, tools))
        with_what = f"with {named}; name another tool" if tools else "yet"
        raise UsageError(f"no trials {with_what}")
    lines = [
        swept_line(panel, name, own, most, course=by_end and len(own) > 1)
        for (panel, most, name), own in sweeps.items()
    ]
    return Curves(lines, TIME.get(x) or _setting_words(x), MEASURES[y])


def _lengths(store: Store, conditions: Sequence[Condition]) -> list[tuple[str, Sequence[float]]]:
    """Return for each condition the name of its line, and how long its robots learned (min).

    What a condition gives that learns nothing is a level: it stands at both ends of the others.
    """
    minutes = [_minutes(store, one) for one in conditions]
    known = [one for one in minutes if one is not None]
    if not known:
        raise UsageError(f"{conditions[0].name}: nothing learned; name another session")
    ends = (min(known), max(known))
    return [
        (_name_beside(one.name, "minutes"), ends if own is None else (own,))
        for one, own in zip(conditions, minutes, strict=True)
    ]


def _of_trials(
    store: Store, condition: Condition, y: str, tools: Sequence[str]
) -> Iterator[tuple[str, float, Sequence[float]]]:
    """Yield for each protocol and task set of a condition its words, the most that a robot can
    have, and a value a robot.
    """
    number = condition.session.id
    if y == "solved":
        every = store.results.solved_by_cell(number, ("tool",))
        cells = {cell: own for cell, own in every.items() if not tools or cell.tool in tools}
        for cell, counts in summed(cells).items():
            most = max(trials for trials, _ in counts.values())
            yield f"{trials_words(*cell[:2])}, of {most}", most, all_tried(counts)
        return
    for cell, values in store.results.means_of_trials(number, y, tools).items():
        yield trials_words(*cell[:2]), math.inf, list(values.values())


def _sweeps(conditions: Sequence[Condition], x: str) -> list[tuple[str, float]]:
    """Return for each condition the name of its line and its value of a setting.

    Those that differ in nothing else share a line. Its name is empty if there is but one; in an
    experiment it is what the names of its conditions say beside the setting.
    """
    sweeps: dict[tuple[str, str], list[int]] = defaultdict(list)
    for number, one in enumerate(conditions):
        own = one.session.spec.canonical()
        del own["robots"]
        own["settings"].pop(x, None)
        beside = _name_beside(one.name, x)
        key = json.dumps(own, sort_keys=True), "" if beside == one.name else beside
        sweeps[key if x in _swept(conditions) else ("", "")].append(number)
    found = {}
    for (_, beside), numbers in sweeps.items():
        own_conditions = [conditions[number] for number in numbers]
        name = beside or ", ".join(one.name for one in own_conditions)
        for number, value in zip(numbers, _setting_values(own_conditions, x), strict=True):
            found[number] = name if len(sweeps) > 1 else "", value
    return [found[number] for number in range(len(conditions))]


def _name_beside(name: str, x: str) -> str:
    """Return the name of a condition without the value of what is swept."""
    said = ("minutes=", "hours=") if x == "minutes" else (f"{x}=", f"{x.rpartition('.')[2]}=")
    return ", ".join(word for word in name.split(", ") if not word.startswith(said))


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
    for value in repeated(values):
        others = ", ".join(other for other in _swept(conditions) if other != name)
        raise UsageError(
            f"{name} is {value:g} in more than one condition; it differs: "
            f"{others or 'no other setting does'}"
        )
    return values


def _setting_words(name: str) -> str:
    """Return a setting with its unit."""
    unit = known_settings()[name].unit
    return f"{name} ({unit})" if unit else name


def _minutes(store: Store, condition: Condition) -> float | None:
    """Return how long the robots of a condition learned with each tool, as they were to (min); None
    where they learned nothing, as those that are told what pushes do, or only borrow.

    What they took to invent before, or to learn with the tools from which they borrow, is not with
    the tool, and does not count here.
    """
    runs = store.learning.runs(session_id=condition.session.id, tested=True)
    lengths = [
        60.0 * run.spec.hours if run.spec.hours is not None else run.robot_seconds / 60.0
        for run in runs
        if run.robot_seconds
    ]
    return math.fsum(lengths) / len(lengths) if lengths else None


def _begun(store: Store, condition: Condition) -> Sequence[LearningRunInfo]:
    """Return the learning runs of a condition whose tables its trials used."""
    runs = store.learning.runs(session_id=condition.session.id, tested=True)
    if not runs or not all(run.robot_seconds for run in runs):
        raise UsageError(f"{condition.name}: nothing learned; name another session")
    return runs


def _courses(store: Store, condition: Condition) -> Mapping[int, Course]:
    """Return how each robot of a condition learned."""
    runs = _begun(store, condition)
    seconds = max(run.robot_seconds for run in runs) / INTERVALS
    did = store.results.learning_intervals(seconds, condition.session.id)
    curves: dict[int, list[Curve]] = defaultdict(list)
    for run in runs:
        curves[run.spec.robot].append(Curve.of(run, did.get(run.id, ()), seconds))
    return {robot: Course.of(own) for robot, own in curves.items()}
