"""Which session a figure is about."""

from collections.abc import Sequence

from affcli.core.records import SessionInfo
from affcli.errors import UsageError, one_line
from affcli.store import Store

AGAIN = {
    "experiment": "give the same affcli experiment again: it goes on from there",
    "reproduce": "give the same affcli reproduce again: it goes on from there",
    "break-tool": "run affcli break-tool again",
    "solve": "run affcli solve again",
}
"""What to do about a session that was not finished, by its kind."""


def finished_session(store: Store, number: int | None, kinds: Sequence[str]) -> SessionInfo | None:
    """Return a finished session.

    Args:
        store: open.
        number: which; None for the latest finished one.
        kinds: those that will do.

    Returns:
        The session; None when none is asked for and none is there.

    Raises:
        UsageError: there is none of that number, or it is of another kind, or not finished.
    """
    sessions = store.sessions.all()
    if number is None:
        finished = [s for s in sessions if s.spec.kind in kinds and s.status == "done"]
        return max(finished, key=lambda s: s.id, default=None)
    found = store.sessions.one(number)
    kind, wanted = one_line(found.spec.kind, 40), " or ".join(kinds)
    if found.spec.kind not in kinds:
        others = [str(s.id) for s in sessions if s.spec.kind in kinds and s.status == "done"]
        there = f"try --session {others[-1]}" if others else f"run affcli {kinds[0]} first"
        raise UsageError(f"session {number} is of affcli {kind}, not of {wanted}; {there}")
    if found.status != "done":
        raise UsageError(f"session {number} is not finished; {AGAIN[found.spec.kind]}")
    return found
