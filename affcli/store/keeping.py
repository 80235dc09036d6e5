"""How much of a robot's life is kept, and what to say where something was not."""

import sqlalchemy as sa

from affcli.core.row_filter import Relation
from affcli.core.specs import Keep
from affcli.errors import UsageError
from affcli.store.connection import Database
from affcli.store.tables import learning_run, trial

NEEDED: dict[Relation, tuple[Keep, ...]] = {
    "behaviors": (Keep.ALL,),
    "rows": (Keep.ALL, Keep.ROWS),
    "steps": (Keep.ALL, Keep.ROWS),
    "trials": tuple(Keep),
}
"""With what of a life was kept these are there."""


def require_kept(database: Database, what: Relation, runs: sa.ColumnElement[bool]) -> None:
    """Make sure that something was kept of learning runs, or of the trials from their tables.

    Args:
        database: where.
        what: one of `NEEDED`.
        runs: which learning runs.

    Raises:
        UsageError: of one of them it was not; the message says how it can be made again.
    """
    c = learning_run.c
    wanted = sa.select(c.id, c.kept).where(runs, c.kept.not_in(NEEDED[what])).limit(1)
    with database.reading() as connection:
        found = connection.execute(wanted).first()
    if found is not None:
        raise UsageError(
            f"run {found.id}: its {what} were not kept (--keep {found.kept}); the same experiment "
            "in another --db without --keep makes them again"
        )


def run_of(trial_id: int) -> sa.ColumnElement[bool]:
    """Tell whether a learning run is the one whose table a trial used."""
    return learning_run.c.id.in_(sa.select(trial.c.learning_run_id).where(trial.c.id == trial_id))
