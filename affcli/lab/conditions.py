"""Conditions compared robot by robot, and how many robots it would take."""

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar

from affcli import registry
from affcli.analysis.paired import FIELDS, LEVEL, Comparison, all_tried, in_common, summed
from affcli.analysis.power import Plan, Untold, plan
from affcli.core.names import one_of
from affcli.core.records import SessionInfo
from affcli.core.results import ConditionCounts
from affcli.core.specs import LIVES
from affcli.errors import UsageError, one_line
from affcli.lab.inventing import are_invented
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
    """A condition by its name, the session in which its trials are, and how many robots lived; and
    what its experiment says of it `beside`, as in `ConditionCounts`.
    """

    name: str
    session: SessionInfo
    robots: int
    beside: str = ""


def sessions_named(store: Store, numbers: Sequence[int]) -> list[Condition]:
    """Return sessions as conditions.

    Each has the name that its experiment gives it. Where another one has the same, how long it
    learned stands beside it, and its number where that is the same, too; where it has none, its
    number is its name.

    Raises:
        UsageError: one is not there, not finished or of another kind; or one comes twice.
    """
    for number in repeated(numbers):
        raise UsageError(f"--session {number}: named twice; name another one")
    sessions = [finished_session(store, number, LIVES) for number in numbers]
    found = list(filter(None, sessions))
    given = [one.condition for one in found]
    names = [_name(store, one, given.count(one.condition) > 1) for one in found]
    return [
        condition_of(store, name if names.count(name) == 1 else f"{name} (session {one.id})", one)
        for name, one in zip(names, found, strict=True)
    ]


def _name(store: Store, session: SessionInfo, is_another_s: bool) -> str:
    """Return the name of a session: with how long its robots learned if another has the same."""
    if session.condition is None:
        return f"session {session.id}"
    said = _said(store, session) if is_another_s else None
    return session.condition + (f", minutes={60.0 * said['hours']:g}" if said else "")


def condition_of(store: Store, name: str, session: SessionInfo) -> Condition:
    """Return a session as a condition."""
    failed = store.sessions.failed_robots(session.id)
    robots = session.spec.robots - len(failed)
    return Condition(name, session, robots, _beside(store, session))


def _beside(store: Store, session: SessionInfo) -> str:
    """Return what an experiment says of a condition that is not in its session."""
    said = _said(store, session)
    if said is None:
        return ""
    minutes = 60.0 * said["hours"]
    learned = not registry.is_told(session.spec.planner)
    words = [f"{minutes:g} min a tool"] if learned and minutes != 60.0 else []
    words += [text for text in said["repertoire"] if are_invented(text)]
    words += [f"transfer {said['transfer']}"] if "transfer" in said else []
    return ", ".join(words)


def _said(store: Store, session: SessionInfo) -> dict[str, Any] | None:
    """Return the condition of which a session is, as its experiment has it; None without one."""
    for one in store.experiments.all():
        for said in one.definition["condition"] if one.id == session.experiment_id else ():
            if said["name"] == session.condition:
                found: dict[str, Any] = said
                return found
    return None


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
    return [condition_of(store, one, sessions[number]) for one, number in found.conditions]


def conditions_named(
    store: Store, experiment: str | None, sessions: Sequence[int] | None, fewest: int
) -> list[Condition]:
    """Return the conditions that a command is about; UsageError when they are fewer than that."""
    if experiment is not None and sessions:
        raise UsageError(f"name an experiment or --session, not both; drop {one_line(experiment)}")
    if experiment is not None:
        found = experiment_named(store, experiment)
    else:
        found = sessions_named(store, sessions or [])
    if len(found) >= fewest:
        return found
    if experiment is not None:
        raise UsageError(
            f"experiment {one_line(experiment)} has one condition; compare its session "
            f"({found[0].session.id}) with another: --session"
        )
    named = ", ".join(one_line(one.name) for one in store.experiments.all())
    there = ", ".join(str(s.id) for s in store.sessions.all(*LIVES) if s.status == "done")
    wanted = " ".join(f"--session {number}" for number in range(1, fewest + 1))
    raise UsageError(
        f"name an experiment (there: {named or 'none yet'}), or sessions, as in {wanted} "
        f"(finished: {there or 'none yet'})"
    )


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
        UsageError: there is no such condition, or one has no trial that counts, or no robot in
            common with it.
    """
    names = [condition.name for condition in conditions]
    first = names.index(one_of("condition", against, names)) if against is not None else 0
    base, *others = (counts_of(store, one) for one in _first(conditions, first))
    for other in others:
        if not in_common(base, other):
            seeds = {base.session.spec.seed, other.session.spec.seed}
            for one in (base, other) if len(seeds) == 1 else ():
                _require_counted(store, one)
            why = f"of seeds {' and '.join(map(str, sorted(seeds)))}" if len(seeds) > 1 else "apart"
            raise UsageError(
                f"{base.name} and {other.name} have no robot in common: they are {why}; give both "
                "the same --seed"
            )
    result = Comparison.of(base, others, _fields(by))
    for other in others:
        if not any(one.condition == other.name for one in result.totals):
            raise UsageError(
                f"{base.name} and {other.name} have no trials in common; name sessions with the "
                "same tools and tasks"
            )
    return result


def _require_counted(store: Store, one: ConditionCounts) -> None:
    """Raise UsageError, with the reason and the remedy, when no trial of a condition counts."""
    if one.cells:
        return
    trials, why = store.results.invalid(one.session.id)
    if trials:
        told = f"all {trials} are invalid ({why}): what is stored stays; repair that, and "
        again = "take another --db"
        if one.session.experiment_id is not None:
            again = "give the experiment another name or --db"
    elif one.failed:
        told, again = "its robots failed; ", "the same command tries them again"
    else:
        told, again = "it has none; ", "name another"
    raise UsageError(f"{one_line(one.name)} has no trial that counts: {told}{again}")


def _first(conditions: Sequence[Condition], first: int) -> list[Condition]:
    """Return conditions with one of them put first."""
    return [conditions[first], *conditions[:first], *conditions[first + 1 :]]


def counts_of(store: Store, condition: Condition) -> ConditionCounts:
    """Return what the robots of a condition solved, trials told apart by all that can tell."""
    cells = store.results.solved_by_cell(condition.session.id, FIELDS)
    failed = tuple(one.robot for one in store.sessions.failed_robots(condition.session.id))
    return ConditionCounts(condition.name, condition.session, cells, failed, condition.beside)


def _fields(by: Sequence[str]) -> list[str]:
    """Return the fields of `Cell` for keys of `BY`."""
    return [field for key in by for field in BY[key]]


def planned(
    store: Store,
    conditions: Sequence[Condition],
    by: Sequence[str],
    differences: Sequence[float],
    correlation: float,
    wanted: float,
) -> tuple[list[Plan], list[Untold]]:
    """Return what it takes to see differences, and the cells that do not tell.

    Totals and cells are each planned at the level of the first of as many (Holm's first step), for
    so `compare` corrects them.

    Args:
        store: open.
        conditions: two, whose paired differences tell; or one, with a correlation.
        by: keys of `BY`: beside all trials these cells.
        differences: to be seen, in solved trials.
        correlation: of the counts of one condition with those of another, if there is but one.
        wanted: the chance to see them.

    Raises:
        UsageError: as `compared`.
    """
    unshared: list[Untold] = []
    if len(conditions) > 1:
        result = compared(store, conditions, None, by)
        parts = [
            {one.cell: one.changes for one in part}
            for part in (result.totals, (*result.cells, *result.same))
        ]
        unshared = [Untold(c, "not in both") for own in result.unshared.values() for c in own]
    else:
        alone, fields = counts_of(store, conditions[0]), _fields(by)
        _require_counted(store, alone)
        parts = [
            {cell: tuple(all_tried(counts)) for cell, counts in summed(alone.cells, told).items()}
            for told in ((), *([fields] if fields else []))
        ]
    found = [
        plan(
            *(cell, values, None if len(conditions) > 1 else correlation),
            *(differences, LEVEL / len(part), wanted),
        )
        for part in parts
        for cell, values in part.items()
    ]
    plans = [one for one in found if isinstance(one, Plan)]
    return plans, [*(one for one in found if isinstance(one, Untold)), *unshared]
