"""What robots invented, with the tries that speak for and against each behavior."""

from collections.abc import Sequence
from dataclasses import dataclass

import sqlalchemy as sa

from affcli.bounded import json_value
from affcli.core.behavior import ExploratoryBehavior
from affcli.core.invention import Invention
from affcli.core.motion import motion_from_json, motion_json
from affcli.store.connection import Database, insert_many
from affcli.store.reading import behavior_call, reading_what_was_written
from affcli.store.rows import params_to_json, to_json
from affcli.store.tables import invention, invention_try


@dataclass(frozen=True, slots=True)
class Inventions:
    """Inventions, by the learning run in which each was made."""

    database: Database

    def save(self, run_id: int, inventions: Sequence[Invention]) -> None:
        """Save what a run invented, each by value, in the order in which it was tried."""
        made, tries = [], []
        for number, one in enumerate(inventions, 1):
            call, motion = one.behavior.call, to_json(motion_json(one.behavior.motion))
            what = (call.name, params_to_json(call), motion)
            made.append((run_id, number, *what, one.step, one.gain, one.kept))
            tries += [(run_id, number, step, alike) for step, alike in one.tries]
        with self.database.writing() as connection:
            insert_many(connection, invention, made)
            insert_many(connection, invention_try, tries)

    def of_run(self, run_id: int) -> tuple[Invention, ...]:
        """Return what a run invented, kept or not, in order."""
        wanted, tried = (
            sa.select(table).filter_by(learning_run_id=run_id).order_by(*order)
            for table, order in (
                (invention, (invention.c.number,)),
                (invention_try, (invention_try.c.number, invention_try.c.step)),
            )
        )
        tries: dict[int, list[tuple[int, bool]]] = {}
        for row in self.database.mappings(tried):
            tries.setdefault(row["number"], []).append((row["step"], bool(row["alike"])))
        with reading_what_was_written(f"what learning run {run_id} invented"):
            return tuple(
                Invention(
                    ExploratoryBehavior(
                        behavior_call(row["exploratory_behavior"], row["exploratory_params"]),
                        motion_from_json(json_value(row["motion"])),
                    ),
                    *(row["step"], row["gain"], tuple(tries.get(row["number"], ()))),
                    kept=bool(row["kept"]),
                )
                for row in self.database.mappings(wanted)
            )
