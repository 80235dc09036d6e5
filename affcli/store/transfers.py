"""Masks of tools, and where the rows come from that runs borrowed of others (§8)."""

from collections.abc import Sequence
from dataclasses import dataclass

import sqlalchemy as sa

from affcli.core.geometry import Point
from affcli.core.mask import Mask
from affcli.core.replay import Difference
from affcli.core.transfer import Borrowed
from affcli.store import reading, rows
from affcli.store.comparing import by_number, differences
from affcli.store.connection import Database, insert_many
from affcli.store.keeping import require_kept
from affcli.store.learning import COUNTERS
from affcli.store.reading import reading_what_was_written
from affcli.store.tables import affordance, borrowed, learning_run, mask


@dataclass(frozen=True, slots=True)
class Transfers:
    """What runs saw of their tools, and what they borrowed, by the number of the learning run."""

    database: Database

    def mask(self, run_id: int) -> Mask | None:
        """Return what a run's camera saw of its tool; None when that is not stored."""
        found = self.database.mappings(sa.select(mask).filter_by(learning_run_id=run_id))
        with reading_what_was_written(f"the mask of learning run {run_id}"):
            return reading.mask(found[0]) if found else None

    def save_mask(self, run_id: int, seen: Mask) -> None:
        """Save what a run's camera saw of its tool, unless another process did meanwhile."""
        with self.database.writing() as connection:
            there = sa.select(mask.c.learning_run_id).filter_by(learning_run_id=run_id)
            if connection.execute(there).first() is None:
                insert_many(connection, mask, [rows.mask_row(run_id, seen)])

    def of_run(self, run_id: int, step: int | None = None) -> tuple[Borrowed, ...]:
        """Return what a run borrowed, in order, with the counters as they are now.

        Args:
            run_id: the run.
            step: of which row; None for all that it borrowed.
        """
        wanted = (
            sa.select(
                affordance,
                *(borrowed.c[name] for name in ("lender_key", "lender_tool", "lender_step")),
                *(borrowed.c[name] for name in ("shift_x", "shift_y", "mirrored")),
            )
            .select_from(
                affordance.join(
                    borrowed,
                    sa.and_(
                        borrowed.c.learning_run_id == affordance.c.learning_run_id,
                        borrowed.c.step == affordance.c.step,
                    ),
                )
            )
            .where(
                affordance.c.learning_run_id == run_id,
                *(() if step is None else (affordance.c.step == step,)),
            )
            .order_by(affordance.c.step)
        )
        with reading_what_was_written(f"what learning run {run_id} borrowed"):
            return tuple(
                Borrowed(
                    reading.affordance(row),
                    *(row["lender_key"], row["lender_tool"], row["lender_step"]),
                    Point(row["shift_x"], row["shift_y"]),
                    mirrored=bool(row["mirrored"]),
                )
                for row in self.database.mappings(wanted)
            )

    def differences(
        self, run_id: int, tool: str, again: Sequence[Borrowed]
    ) -> tuple[Difference, ...]:
        """Return where rows that were borrowed again differ from their record, but for the
        counters, which trials change.

        Args:
            run_id: the record.
            tool: the name of the tool held.
            again: all that was borrowed.
        """
        require_kept(self.database, "rows", learning_run.c.id == run_id)
        kept, kept_whence = (
            by_number(
                self.database.mappings(
                    sa.select(table).filter_by(learning_run_id=run_id).where(table.c.step <= 0)
                ),
                "step",
            )
            for table in (affordance, borrowed)
        )
        made = {one.row.step: rows.affordance_row(run_id, tool, one.row) for one in again}
        whence = {one.row.step: rows.borrowed_row(run_id, one) for one in again}
        found = differences("affordance", kept, made)
        missing = kept.keys() ^ made.keys()  # is told once
        return (
            *(d for d in found if d.column not in COUNTERS),
            *(d for d in differences("borrowed", kept_whence, whence) if d.number not in missing),
        )

    def lenders(self, keys: Sequence[str]) -> dict[str, int]:
        """Return the number of the run of each key; of several the one that stands for itself. What
        was deleted is missing.
        """
        c = learning_run.c
        wanted = (
            sa.select(c.key, c.id)
            .where(c.key.in_(keys))
            .order_by(c.session_id.is_not(None).desc(), c.id.desc())
        )
        return {row["key"]: row["id"] for row in self.database.mappings(wanted)}
