"""How robots adapt to a broken tool, read for the figure (§7.2)."""

from affcli.analysis.adaptation import AdaptationCourse
from affcli.analysis.breaking import missing_side
from affcli.core.records import SessionInfo
from affcli.errors import DatabaseError, UsageError
from affcli.lab.sessions import finished_session
from affcli.store import Store


def adaptation_in(store: Store, number: int | None) -> AdaptationCourse:
    """Return the course of the adaptation in a session of trials with a broken tool.

    Args:
        store: open.
        number: of the session; None for the latest that is finished.

    Raises:
        UsageError: there is none, or it is not finished or of another kind.
    """
    session = finished_session(store, number, ["break-tool", "reproduce"])
    if session is None:
        raise UsageError(
            "no finished trials with a broken tool yet; run affcli break-tool, or affcli reproduce"
        )
    broken_tools = store.results.broken_tools(session.id)
    if not broken_tools:
        raise UsageError(
            f"session {session.id} holds no trials with a broken tool; run affcli break-tool"
        )
    tool, shape = broken_tools[0]
    side = _missing_side(store, session, tool, shape)
    by_robot = session.spec.robots > 1
    broken, whole = (
        store.results.trial_groups(session.id, tool, held, side, by_robot=by_robot)
        for held in (shape, tool)
    )
    course = AdaptationCourse.of(session, tool, shape, broken, whole)
    if not course.shares:
        raise UsageError(
            f"session {session.id}: no trial with the broken tool took a step; learn the {tool} "
            "for longer, and run affcli break-tool again"
        )
    return course


def _missing_side(store: Store, session: SessionInfo, tool: str, shape: str) -> float:
    """Return x of the middle of what is missing of a tool that broke (in, tool frame)."""
    learned = store.learning.runs(session_id=session.id, tool=tool)
    run = learned[0].id if learned else store.results.trials(session_id=session.id)[0].run_id
    trials = store.trials.trials(session_id=session.id, run_id=run)
    broken = next((trial for trial in trials if trial.spec.shape == shape), None)
    if broken is None:
        raise DatabaseError(
            f"session {session.id} names a broken tool that no trial of it held; restore a copy of "
            "the database"
        )
    return missing_side(broken.learned.held, broken.spec.held)
