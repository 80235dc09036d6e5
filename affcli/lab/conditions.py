"""Conditions compared robot by robot, and how many robots it would take."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeVar

from affcli.analysis.paired import LEVEL, Comparison, Counts, in_common, summed
from affcli.analysis.power import Plan, plan
from affcli.core.names import one_of
from affcli.core.records import SessionInfo
from affcli.core.results import Cell, ConditionCounts
from affcli.core.specs import LIVES
from affcli.errors import UsageError
from affcli.lab.sessions import finished_session
from affcli.store import Store

T = TypeVar("T")

BY: dict[str, tuple[str, ...]] = {
    "tool": ("tool", "shape"),
    "goal": ("goal",),
    "start": ("start",),
    "task": (),
    "protocol": (),
}
"""What trials can be told apart by, with the fields of `Cell`; the last two tell always."""


class Condition(NamedTuple):
    """A condition by its name, and the session in which its trials are."""

    name: str
    session: SessionInfo


def sessions_named(store: Store, numbers: Sequence[int]) -> list[Condition]:
    """Return sessions as conditions, each named by its number.

    Raises:
        UsageError: one is not there, not finished or of another kind; or one comes twice.
    """
    found = []
    for number in numbers:
        session = finished_session(store, number, LIVES)
        if session is not None:
            found.append(Condition(f"session {session.id}", session))
    for number in repeated(numbers):
        raise UsageError(f"--session {number}: named twice; name another one")
    return found


def repeated(values: Sequence[T]) -> list[T]:
    """Return the values that were there before, in order."""
    return [value for number, value in enumerate(values) if value in values[:number]]


def experiment_named(store: Store, name: str) -> list[Condition]:
    """Return the conditions of an experiment.

    Raises:
        UsageError: there is none of that name, or it is not finished.
    """
    sessions = {session.id: session for session in store.sessions.all()}
    found = store.experiments.named(name)
    if found.status != "done":
        raise UsageError(f"experiment {name!r} is not finished; go on: affcli experiment --resume")
    return [Condition(one, sessions[number]) for one, number in found.conditions]


def compared(
    store: Store, conditions: Sequence[Condition], against: str | None, by: Sequence[str]
) -> Comparison:
    """Compare conditions with one of them.

    Args:
        store: open.
        conditions: two or more.
        against: the name of the one compared against; None for the first.
        by: keys of `BY`.

    Raises:
        UsageError: there is no such condition, or one has no robot in common with it.
    """
    names = [condition.name for condition in conditions]
    first = names.index(one_of("condition", against, names)) if against is not None else 0
    base, *others = (counts_of(store, one, by) for one in _first(conditions, first))
    for other in others:
        if not in_common(base, other):
            seeds = {base.session.spec.seed, other.session.spec.seed}
            why = f"of seeds {' and '.join(map(str, sorted(seeds)))}" if len(seeds) > 1 else "apart"
            raise UsageError(
                f"{base.name} and {other.name} have no robot in common: they are {why}; give both "
                "the same --seed"
            )
    result = Comparison.of(base, others)
    for other in others:
        if not any(one.condition == other.name for one in result.totals):
            raise UsageError(
                f"{base.name} and {other.name} have no trials in common; name sessions with the "
                "same tools and tasks"
            )
    return result


def _first(conditions: Sequence[Condition], first: int) -> list[Condition]:
    """Return conditions with one of them put first."""
    return [conditions[first], *conditions[:first], *conditions[first + 1 :]]


def counts_of(store: Store, condition: Condition, by: Sequence[str]) -> ConditionCounts:
    """Return what the robots of a condition solved, told apart by keys of `BY`."""
    fields = [field for key in by for field in BY[key]]
    cells = store.results.solved_by_cell(condition.session.id, fields)
    return ConditionCounts(condition.name, condition.session, cells)


def planned(
    store: Store,
    conditions: Sequence[Condition],
    by: Sequence[str],
    differences: Sequence[float],
    correlation: float,
    wanted: float,
) -> tuple[list[Plan], list[Cell]]:
    """Return what it takes to see differences, and the cells that tell nothing of it.

    Args:
        store: open.
        conditions: two, whose paired differences tell; or one, with a correlation.
        by: keys of `BY`: beside all trials these cells, each at the level of the first of as many
            (Holm's first step).
        differences: to be seen, in solved trials.
        correlation: of the counts of one condition with those of another, if there is but one.
        wanted: the chance to see them.

    Raises:
        UsageError: as `compared`.
    """
    if len(conditions) > 1:
        compared(store, conditions, None, by)  # or says why they cannot be
    counts = [counts_of(store, one, by).cells for one in conditions]
    plans: list[Plan] = []
    empty: list[Cell] = []
    parts: list[list[Mapping[Cell, Counts]]] = [[summed(cells) for cells in counts]]
    if any(BY[key] for key in by):
        parts.append(counts)
    for before, *after in parts:
        level = LEVEL / (1 if before is parts[0][0] else len(before))
        for cell, own in before.items():
            theirs = after[0].get(cell, {}) if after else own
            both = [robot for robot in own if own[robot][0] == theirs.get(robot, (0, 0))[0]]
            solved = [own[robot][1] for robot in both]
            if after:
                solved = [theirs[r][1] - one for r, one in zip(both, solved, strict=True)]
            found = plan(cell, solved, None if after else correlation, differences, level, wanted)
            if found is None:
                empty.append(cell)
            else:
                plans.append(found)
    return plans, empty
