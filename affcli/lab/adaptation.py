"""How robots adapt to a broken tool, read for the figure (§7.2)."""

from affcli.analysis.adaptation import AdaptationCourse
from affcli.analysis.breaking import missing_side
from affcli.core.specs import LIVES
from affcli.errors import UsageError
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
    session = finished_session(store, number, ["break-tool", *LIVES])
    if session is None:
        raise UsageError(
            "no finished trials with a broken tool yet; run affcli break-tool, or affcli reproduce"
        )
    first = store.trials.first_broken(session.id)
    if first is None:
        raise UsageError(
            f"session {session.id} holds no trials with a broken tool; run affcli break-tool"
        )
    tool, shape = first.spec.tool, first.spec.shape
    side = missing_side(first.learned.held, first.spec.held)
    by_robot = session.spec.robots > 1
    broken, whole = (
        store.results.trial_groups(session.id, tool, held, side, by_robot=by_robot)
        for held in (shape, tool)
    )
    run = None if by_robot else store.learning.run(first.run_id)
    course = AdaptationCourse.of(session, tool, shape, broken, whole, run)
    if not course.shares:
        raise UsageError(
            f"session {session.id}: no trial with the broken tool took a step; learn the {tool} "
            "for longer, and run affcli break-tool again"
        )
    return course
