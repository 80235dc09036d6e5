"""What a database holds, gathered for the reports."""

from collections import Counter

from affcli.config import differences, settings_from_json
from affcli.core.task import GOAL_NUMBERS
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import BROKEN_TOOL, Outcome, Protocol
from affcli.lab.plausible import not_written
from affcli.report.overview import Breaking, Overview, ProtocolFigures
from affcli.report.reproduction import Reproduction
from affcli.store import SessionInfo, Store


def reproduction_of(store: Store, session: int, robots: int) -> Reproduction:
    """Return what the robots of a reproduction gave.

    Args:
        store: open.
        session: the reproduction.
        robots: how many of its robots are saved.
    """
    cells = {(str(tool), goal): [0] * robots for tool in TOOL_PARTS for goal in GOAL_NUMBERS}
    broken = [0] * robots
    for count in store.success_counts(session):
        known = (count.tool, count.goal) in cells and 0 <= count.robot < robots
        if not known:
            raise not_written(f"a trial of session {session}")
        if count.protocol is Protocol.EXTENSION_OF_REACH:
            cells[count.tool, count.goal][count.robot] += count.solved
        elif count.tool == BROKEN_TOOL:
            broken[count.robot] += count.solved
    failures, trials = _failures(store, [session])
    lost = sum(use.tries for use in store.row_uses(session) if use.lost)
    (info,) = (s for s in store.sessions("reproduce") if s.id == session)
    words = differences(settings_from_json(info.settings))
    return Reproduction(robots, cells, broken, failures, trials, lost, session, info.seed, words)


def overview_of(store: Store) -> Overview:
    """Return what the database holds: learned tools, trials, finished reproductions."""
    learned = [
        (run, differences(settings_from_json(run.spec.settings)), store.behavior_groups(run.id))
        for run in store.learning_runs()
    ]
    solved: dict[tuple[int, str, str, int], tuple[int, int]] = {}
    for trial in store.outcomes(kind="solve"):
        key = (trial.run_id, trial.tool, trial.sensor, trial.goal)
        good, tried = solved.get(key, (0, 0))
        solved[key] = (good + (trial.outcome is Outcome.SOLVED), tried + 1)
    latest: dict[tuple[int, int, str, str, str], Breaking] = {}
    for session in store.sessions("break-tool"):
        breaking = _breaking(store, session)
        if breaking is not None:
            of = (breaking.tool, breaking.shape, breaking.sensor)
            latest[breaking.run, breaking.seed, *of] = breaking
    counted = [s.id for s in store.sessions("solve")] + [b.session for b in latest.values()]
    failures, trials = _failures(store, counted)
    reproductions = [
        reproduction_of(store, session.id, session.robots)
        for session in store.sessions("reproduce")
        if session.status == "done"
    ]
    return Overview(learned, solved, list(latest.values()), failures, trials, reproductions)


def _failures(store: Store, sessions: list[int]) -> tuple[dict[str, int], int]:
    """Return how often each kind of failure occurred in some sessions, and all their trials."""
    kinds: Counter[str] = Counter()
    for count in store.outcome_counts(sessions):
        kinds[count.outcome.value] += count.trials
    trials = kinds.total()
    del kinds[Outcome.SOLVED.value]
    return dict(kinds.most_common()), trials


def _breaking(store: Store, session: SessionInfo) -> Breaking | None:
    """Return the figures of one break-tool session; None when it has no trials."""
    results = store.outcomes(session_id=session.id)
    figures = {}
    for protocol in Protocol:
        ended = [r for r in results if r.protocol is protocol]
        solved = [r.steps for r in ended if r.outcome is Outcome.SOLVED]
        uses = store.row_uses(session.id, protocol)
        figures[protocol] = ProtocolFigures(
            trials=len(ended),
            solved=len(solved),
            mean_steps=sum(solved) / len(solved) if solved else None,
            tries_on_lost=sum(use.tries for use in uses if use.lost),
            rows_excluded=sum(use.deaths > 0 for use in uses),
        )
    if not results:
        return None
    broken = next(r for r in results if r.protocol is Protocol.TOOL_ADAPTATION)
    return Breaking(
        session.id,
        broken.run_id,
        session.seed,
        broken.tool,
        broken.shape,
        broken.sensor,
        figures[Protocol.TOOL_ADAPTATION],
        figures[Protocol.EXTENSION_OF_REACH],
    )
