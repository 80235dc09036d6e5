"""Which learning runs a person means, and which rows of them: by tool, by number, by words.

Whoever asks, a command or a program, is told in the same words what there is instead.
"""

import re
from collections.abc import Sequence

from affcli import registry
from affcli.core.behavior import BehaviorCall
from affcli.core.names import one_of
from affcli.core.records import LearningRunInfo
from affcli.core.row_filter import Comparison, RowFilter
from affcli.core.specs import LIVES
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.inventing import EXPLORER
from affcli.lab.run_parts import require_learned, require_robot
from affcli.lab.suggesting import with_database
from affcli.lab.table import every_run
from affcli.store import Store


def learned_runs(
    records: Store,
    tool: str | None,
    run: int | None = None,
    *,
    usable: bool = False,
) -> list[LearningRunInfo]:
    """Return the learning runs whose tables are to be used, or looked at.

    Args:
        records: open.
        tool: the latest finished run of this tool; None for that of every tool that has one.
        run: this run and no other.
        usable: a robot is to use them, so none from a log is taken, nor one that was computed.

    Raises:
        UsageError: there is none; the message names the command to run. Or that which was named is
            no robot's, and is to be used.
        BadInputError: the run that was named comes from a log, and is to be used.
    """
    if run is not None:
        chosen = records.learning.run(run)
        if chosen.status != "done":
            raise _unfinished(records, chosen)
        if tool not in (None, chosen.spec.tool):
            raise UsageError(f"run {run} is of the {chosen.spec.tool}: leave out --tool")
        if usable:
            require_robot(chosen.spec)
            require_learned(chosen)
        return [chosen]
    names = [one for one in _learned_tools(records, usable=usable) if tool in (None, one)]
    latest = (records.learning.latest(name, usable=usable) for name in names)
    runs = [found for found in latest if found is not None]
    if not runs:
        logs = records.learning.tools() if usable else frozenset()
        logged = logs if tool is None else logs & {tool}
        wanted = "tools" if tool is None else tool
        unfinished = [
            one
            for one in records.learning.runs(status="running")
            if tool in (None, one.spec.tool) and not logged
        ]
        if unfinished:
            raise _unfinished(records, unfinished[-1])
        if not logged and tool is not None:
            wanted = registry.part("tools", tool).name
        only = " but by robots of a reproduction" if records.sessions.all(*LIVES) else ""
        only = " but from a log, which no robot can use" if logged else only
        simulated = tool if tool in registry.parts("tools") else "t-hook"
        learning = with_database(f"affcli learn --tool {simulated}", records.path)
        where = f"in {one_line(records.path)}{only}"
        known = one_line(" or ".join(_learned_tools(records, usable=usable)), 60)
        other = f"; or name what was learned with: --tool {known}" if known else ""
        raise UsageError(f"nothing learned with the {wanted} {where}; first run: {learning}{other}")
    return runs


def _unfinished(records: Store, run: LearningRunInfo) -> UsageError:
    """Return the error that a run has not come to its end."""
    named, going_on = one_line(run.spec.tool, 60), "affcli learn --resume"
    return UsageError(
        f"run {run.id} with the {named} is not finished; go on with it first: "
        f"{with_database(going_on, records.path)}"
    )


def _learned_tools(records: Store, *, usable: bool) -> list[str]:
    """Return the tools that were learned: those that are registered first, in their order."""
    there = records.learning.tools(usable=usable)
    known = dict.fromkeys([*registry.parts("tools"), *sorted(there)])
    return [name for name in known if name in there]


_NUMBER = r"(\d+(?:\.\d+)?|\.\d+)"
_BOUND = re.compile(rf"(<=|>=|<|>)\s*{_NUMBER}", re.ASCII)
_BETWEEN = re.compile(rf"{_NUMBER}\s*\.\.\s*{_NUMBER}", re.ASCII)


def _behavior(store: Store, text: str, runs: Sequence[LearningRunInfo]) -> BehaviorCall:
    """Return the exploratory behavior of this name that learning runs have, or invented."""
    calls = dict.fromkeys(one.call for run in runs for one in run.spec.repertoire)
    inventive = (run for run in runs if run.spec.explorer.name == EXPLORER)
    for run in inventive:
        invented = store.inventions.of_run(run.id)
        calls |= dict.fromkeys(one.behavior.call for one in invented)
    known = {str(call): call for named in calls for call in (BehaviorCall(named.name, ()), named)}
    return known[one_of("behavior", text, known)]


def checked_probability(text: str) -> tuple[tuple[Comparison, float], ...]:
    """Return the bounds that a text like ``<=0.5``, ``>0.5`` or ``0.2..0.8`` gives, both included.

    Raises:
        BadInputError: it gives none, or not in 0 to 1.
    """
    bounds: tuple[tuple[Comparison, float], ...] = ()
    if found := _BOUND.fullmatch(text.strip()):
        comparison: Comparison = found[1]  # type: ignore[assignment]  # one of the four
        bounds = ((comparison, float(found[2])),)
    elif found := _BETWEEN.fullmatch(text.strip()):
        bounds = ((">=", float(found[1])), ("<=", float(found[2])))
    numbers = [number for _, number in bounds]
    if not bounds or max(numbers) > 1.0 or numbers != sorted(numbers):
        raise BadInputError(
            f"--probability {one_line(text, 40)}: must be like <=0.5, <0.5, >=0.5, >0.5 or "
            "0.2..0.8, with numbers from 0 to 1"
        )
    return bounds


def chosen_rows(
    store: Store,
    *,
    tool: str | None,
    run: int | None,
    all_runs: bool,
    behavior: str | None,
    probability: str | None,
    region: str | None,
    limit: int | None,
) -> tuple[Sequence[LearningRunInfo], RowFilter]:
    """Return the learning runs whose rows are meant, and what the database can be asked for.

    It knows no regions. The run that was named, all runs, or the latest finished one of each tool;
    a behavior with its parameters, or without, whatever they were.

    Raises:
        UsageError: there are no such runs; the run is of another tool; no tool of them has the
            region; none of them has the behavior, and the message has the nearest.
        BadInputError: a probability that cannot be read.
    """
    if run is not None and all_runs:
        raise UsageError("give --run ID or --all-runs, not both")
    bounds = () if probability is None else checked_probability(probability)
    runs = _runs(store, tool, run, all_runs=all_runs)
    tools = dict.fromkeys(one.spec.tool for one in runs)
    parts = dict.fromkeys(part.name for one in runs for part in one.spec.held.parts)
    if region is not None and region not in parts:
        raise UsageError(
            f"no region {one_line(region, 60)!r} of the {_listed(tools)}; the parts are "
            f"{_listed(parts)}"
        )
    return runs, RowFilter(
        runs=None if all_runs else tuple(one.id for one in runs),
        tool=tool,
        behavior=None if behavior is None else _behavior(store, behavior, runs),
        probability=bounds,
        limit=limit,
    )


def _runs(
    store: Store, tool: str | None, run: int | None, *, all_runs: bool
) -> Sequence[LearningRunInfo]:
    """Return the run that was named, all runs, or the latest finished one of each tool."""
    if run is not None:
        chosen = store.learning.run(run)
        if tool not in (None, chosen.spec.tool):
            raise UsageError(
                f"run {run} is of the {one_line(chosen.spec.tool, 60)}, not of the {tool}; "
                "leave out --tool"
            )
        return [chosen]
    runs = [one for one in every_run(store) if tool in (None, one.spec.tool)]
    if all_runs and runs:
        return runs
    if runs and all(one.session_id is not None for one in runs):
        raise UsageError(
            f"nothing learned with the {tool or 'tools'} in {one_line(store.path)} but by "
            "robots of a reproduction; give --run ID or --all-runs"
        )
    return learned_runs(store, tool)


def _listed(names: "dict[str, None]") -> str:
    """Return names with commas between them."""
    return ", ".join(one_line(name, 60) for name in names)
