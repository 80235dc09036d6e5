"""The counters of a row (§3.2), moved together with the record of what moved them."""

from pathlib import Path

import sqlalchemy as sa

from affcli.core.trial import Attempt
from affcli.errors import DatabaseError, one_line
from affcli.store.tables import affordance


def count_use(connection: sa.Connection, path: Path, use: Attempt, row_id: int, saved: str) -> None:
    """Move the stored counters of a row from before to after one use of it.

    Args:
        connection: in the transaction that saves the record of the use.
        path: the database, for the message.
        use: what was done with the row.
        row_id: the row in the store.
        saved: what was saved before, for the message.

    Raises:
        DatabaseError: the stored counters are not those from before the use.
    """
    changed = connection.execute(
        sa.update(affordance)
        .filter_by(
            id=row_id,
            times_used=use.row.times_used,
            times_successful=use.row.times_successful,
        )
        .values(
            times_used=use.times_used_after,
            times_successful=use.times_successful_after,
        )
    )
    if changed.rowcount != 1:
        raise DatabaseError(
            f"{one_line(path)}: another process changed the counters of affordance "
            f"{row_id} meanwhile; the {saved} before are saved; run the command again"
        )
