"""Our results, gathered for the figure that shows them beside the paper's (§7)."""

from affcli.core.trial import BROKEN_SHAPE, BROKEN_TOOL, Outcome, Protocol
from affcli.errors import UsageError
from affcli.lab.overview import reproduction_of
from affcli.lab.sessions import finished_session
from affcli.report.paper import EXTENSION_OF_REACH
from affcli.report.results import Results, SingleRobots, results_of_many, results_of_single
from affcli.store import Store, TrialResult


def results_in(store: Store, session: int | None) -> Results:
    """Return the results of a finished reproduction; without one, those of single robots.

    Choice: single robots are the latest finished learning runs of the tools. Of each start the
    latest ``affcli solve`` counts, and the latest 16 trials with the broken T-hook.

    Args:
        store: open.
        session: which reproduction; None for the latest.

    Raises:
        UsageError: it is no finished reproduction; or there is nothing to show at all.
    """
    found = finished_session(store, session, ["reproduce"])
    if found is not None:
        return results_of_many(reproduction_of(store, found.id, found.robots))
    single = _single_robots(store)
    if single is None:
        raise UsageError(
            "no finished reproduction and no trials of affcli solve yet; run affcli reproduce "
            "--robots 20, or affcli solve"
        )
    return results_of_single(single)


def _single_robots(store: Store) -> SingleRobots | None:
    """Return what the latest learning run of each tool made of its trials; None without any."""
    learned = {tool: store.latest_run(tool) for tool in EXTENSION_OF_REACH}
    latest = {run.id: tool for tool, run in learned.items() if run is not None}
    counted: dict[tuple[int, int, int], TrialResult] = {}
    broken: dict[tuple[int, int], TrialResult] = {}
    for result in store.outcomes():
        if result.run_id not in latest or result.outcome is Outcome.INVALID:
            continue
        if result.session_kind == "solve":
            counted[result.run_id, result.goal, result.start] = result
        elif _is_broken(result):
            broken[result.goal, result.start] = result
    if not counted:
        return None
    cells: dict[tuple[str, int], tuple[int, int]] = {}
    for (run, goal, _), result in counted.items():
        solved, tried = cells.get((latest[run], goal), (0, 0))
        cells[latest[run], goal] = (solved + _solved(result), tried + 1)
    used = {sensor: set[int]() for sensor in sorted({r.sensor for r in counted.values()})}
    for result in counted.values():
        used[result.sensor].add(result.run_id)
    words = "; ".join(
        f"run{'s' if len(runs) > 1 else ''} {', '.join(map(str, sorted(runs)))} ({sensor})"
        for sensor, runs in used.items()
    )
    return SingleRobots(
        cells,
        (sum(map(_solved, broken.values())), len(broken)),
        f"one robot a tool: {words}",
    )


def _is_broken(result: TrialResult) -> bool:
    """Tell whether a trial is one of those with the paper's broken tool."""
    kind = (result.protocol, result.tool, result.shape)
    return kind == (Protocol.TOOL_ADAPTATION, BROKEN_TOOL, BROKEN_SHAPE)


def _solved(result: TrialResult) -> bool:
    """Tell whether a trial was solved."""
    return result.outcome is Outcome.SOLVED
