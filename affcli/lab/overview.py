"""What a database holds, gathered for the reports."""

from collections import Counter

from affcli.core.task import GOAL_NUMBERS
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import Outcome, Protocol
from affcli.lab.reproduction import BROKEN_TOOL
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
        if count.protocol is Protocol.EXTENSION_OF_REACH:
            cells[count.tool, count.goal][count.robot] += count.solved
        elif count.tool == BROKEN_TOOL:
            broken[count.robot] += count.solved
    failures, trials = _failures(store, [session])
    lost = sum(use.tries for use in store.row_uses(session) if use.lost)
    return Reproduction(robots, cells, broken, failures, trials, lost)


def overview_of(store: Store) -> Overview:
    """Return what the database holds: learned tools, trials, the latest reproduction."""
    learned = [(run, store.behavior_groups(run.id)) for run in store.learning_runs()]
    solves = store.sessions("solve")
    own: dict[tuple[str, int], tuple[int, int]] = {}
    for session in solves:
        for count in store.success_counts(session.id):
            solved, tried = own.get((count.tool, count.goal), (0, 0))
            own[count.tool, count.goal] = (solved + count.solved, tried + count.trials)
    breakings = [_breaking(store, session) for session in store.sessions("break-tool")]
    failures, trials = _failures(store, [s.id for s in (*solves, *store.sessions("break-tool"))])
    reproduction = None
    whole = [s for s in store.sessions("reproduce") if s.status == "done"]
    if whole:
        reproduction = reproduction_of(store, whole[-1].id, whole[-1].robots)
    return Overview(learned, own, [b for b in breakings if b], failures, trials, reproduction)


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
        session.seed,
        broken.tool,
        broken.shape,
        figures[Protocol.TOOL_ADAPTATION],
        figures[Protocol.EXTENSION_OF_REACH],
    )
