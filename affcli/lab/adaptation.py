"""How robots adapt to a broken tool, gathered for the figure (§7.2)."""

from affcli.config import settings_from_json
from affcli.core.tool import TOOL_PARTS
from affcli.errors import DatabaseError, UsageError
from affcli.lab.bench import missing_side
from affcli.lab.sessions import finished_session
from affcli.report.adaptation import AdaptationCourse, probabilities_of, shares_of
from affcli.report.reproduction import ENOUGH_ROBOTS
from affcli.store import SessionInfo, Store


def adaptation_in(store: Store, number: int | None) -> AdaptationCourse:
    """Return the course of the adaptation in a session of trials with a broken tool.

    Args:
        store: open.
        number: of the session; None for the latest that is finished.

    Raises:
        UsageError: there is none, or it is not finished or of another kind.
        DatabaseError: it holds a tool that affcli does not know.
    """
    session = finished_session(store, number, ["break-tool", "reproduce"])
    if session is None:
        raise UsageError(
            "no finished trials with a broken tool yet; run affcli break-tool, or affcli reproduce"
        )
    broken_tools = store.broken_tools(session.id)
    if not broken_tools:
        raise UsageError(
            f"session {session.id} holds no trials with a broken tool; run affcli break-tool"
        )
    tool, shape = broken_tools[0]
    if not {tool, shape} <= set(TOOL_PARTS):
        raise DatabaseError(f"session {session.id} holds a tool that affcli does not know")
    side = missing_side(settings_from_json(session.settings), tool, shape)
    by_robot = session.robots > 1
    broken, whole = (
        store.trial_groups(session.id, tool, held, side, by_robot=by_robot)
        for held in (shape, tool)
    )
    shares = shares_of(broken)
    if not shares:
        raise UsageError(
            f"session {session.id}: no trial with the broken tool took a step; learn the {tool} "
            "for longer, and run affcli break-tool again"
        )
    last = shares[-1].number
    trials = sum(group.trials for group in broken)
    return AdaptationCourse(
        title=_title(session, tool, shape, trials),
        note=_note(session),
        session=session.id,
        tool=tool,
        shape=shape,
        trials=trials,
        shares=shares,
        broken=probabilities_of(broken, last),
        whole=probabilities_of(whole, last),
    )


def _title(session: SessionInfo, tool: str, shape: str, trials: int) -> str:
    """Return whose trials they are."""
    robots = f"{session.robots} robot{'s' if session.robots != 1 else ''}"
    return f"{tool}, broken: {shape}; {trials} trials of {robots}"


def _note(session: SessionInfo) -> str:
    """Return why there are no intervals; empty when there are."""
    if 1 < session.robots < ENOUGH_ROBOTS:
        return f"too few robots for intervals ({ENOUGH_ROBOTS} or more)"
    return ""
