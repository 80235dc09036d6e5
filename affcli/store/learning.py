"""Learning runs in the store: begun, saved chunk by chunk, read again."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.affordance_table import AffordanceTable
from affcli.core.geometry import Point, Pose
from affcli.core.trial import BabblingRecord, LearningSpec, Truth
from affcli.store.connection import Connected, insert_many, insert_one
from affcli.store.mapping import (
    affordance_from,
    affordance_row,
    behavior_row,
    learning_spec_from,
    reading_what_was_written,
    settings_key,
    to_json,
)
from affcli.store.rows import LearningRunRow
from affcli.store.tables import affordance, behavior, learning_run

LearningStep = tuple[BabblingRecord, Truth]
"""What one behavior of a learning run gave, and what truly happened."""


@dataclass(frozen=True, slots=True)
class LearningRunInfo:
    """What the store holds of a learning run.

    Args:
        id: its number in the store.
        session_id: the reproduction it is part of; None when it stands for itself.
        spec: what it is a function of.
        versions: what it was made with.
        status: ``running`` or ``done``.
        behaviors: exploratory behaviors executed.
        rows: rows of its affordance table.
        resets: how often the attractor was put back.
        redraws: wrist positions drawn again because the attractor was in the way.
        robot_seconds: the robot clock.
        checkpoint: what it needs to go on; None at the beginning and when done.
        started_at, finished_at: ISO text, UTC.
    """

    id: int
    session_id: int | None
    spec: LearningSpec
    versions: dict[str, str]
    status: str
    behaviors: int
    rows: int
    resets: int
    redraws: int
    robot_seconds: float
    checkpoint: dict[str, Any] | None
    started_at: str
    finished_at: str | None


class LearningRuns(Connected):
    """The part of the store that keeps learning runs."""

    def begin_learning(
        self,
        spec: LearningSpec,
        versions: Mapping[str, str],
        now: str,
        session_id: int | None = None,
    ) -> LearningRunInfo:
        """Return the stored run of `spec`, new or as far as it came.

        Args:
            spec: what the run is a function of.
            versions: recorded with a new run.
            now: ISO text, UTC.
            session_id: the reproduction it is part of.

        Raises:
            DatabaseError: the run could not be read or stored.
        """
        wanted = _the_run(spec, session_id)
        with self.reading() as connection:
            found = _info(connection, wanted)
        if found is not None:
            return found
        with self.writing() as connection:
            # Another process may have begun it in between.
            if _info(connection, wanted) is None:
                row = new_learning_run(spec, versions, now, session_id)
                insert_one(connection, learning_run, row)
            return info_from(connection.execute(wanted).mappings().one())

    def append_learning(
        self,
        run_id: int,
        after_step: int,
        steps: Sequence[LearningStep],
        checkpoint: Mapping[str, Any] | None,
        robot_seconds: float,
        *,
        done: bool,
        now: str,
        calibration: str | None = None,
    ) -> bool:
        """Save a chunk of a run, its rows and its checkpoint in one transaction.

        Args:
            run_id: the run.
            after_step: how many behaviors the caller believes to be stored already.
            steps: what came next.
            checkpoint: what the run needs to go on after the last of them.
            robot_seconds: the robot clock after the last of them.
            done: the run is over.
            now: ISO text, UTC.
            calibration: of the camera that the robot sees through, as JSON; None without one.

        Returns:
            False when another process, computing the same run, has stored more than `after_step`
            behaviors; nothing was written then, and the stored checkpoint is the place to go on.

        Raises:
            DatabaseError: the chunk could not be saved; what was saved before is kept.
        """
        with self.writing() as connection:
            row = connection.execute(sa.select(learning_run).filter_by(id=run_id)).mappings().one()
            if row["behaviors"] > after_step or row["status"] == "done":
                return False
            if row["behaviors"] < after_step:
                raise ValueError(f"run {run_id}: {row['behaviors']} behaviors, not {after_step}")
            rows = insert_learning_steps(connection, run_id, row["tool"], steps)
            connection.execute(
                sa.update(learning_run)
                .filter_by(id=run_id)
                .values(
                    behaviors=row["behaviors"] + len(steps),
                    rows=row["rows"] + rows,
                    resets=row["resets"] + sum(record.resets for record, _ in steps),
                    redraws=row["redraws"] + sum(record.redraws for record, _ in steps),
                    robot_seconds=robot_seconds,
                    checkpoint=None if done or checkpoint is None else to_json(checkpoint),
                    status="done" if done else "running",
                    finished_at=now if done else None,
                    calibration=calibration,
                )
            )
            return True

    def learning_runs(
        self,
        *,
        tool: str | None = None,
        session_id: int | None = None,
        status: str | None = None,
    ) -> tuple[LearningRunInfo, ...]:
        """Return the stored runs, oldest first.

        Args:
            tool: only those of this tool.
            session_id: those of this reproduction; None for those that stand for themselves.
            status: only ``running`` or only ``done`` ones.
        """
        wanted = sa.select(learning_run).where(learning_run.c.session_id.is_(session_id))
        for column, value in (("tool", tool), ("status", status)):
            if value is not None:
                wanted = wanted.where(learning_run.c[column] == value)
        return tuple(map(info_from, self.mappings(wanted.order_by(learning_run.c.id))))

    def latest_run(self, tool: str) -> LearningRunInfo | None:
        """Return the latest finished run of `tool` that is not part of a reproduction."""
        runs = self.learning_runs(tool=tool, status="done")
        return max(runs, key=lambda run: (run.finished_at or "", run.id), default=None)

    def affordance_table(
        self, run_id: int, *, as_learned: bool = False
    ) -> tuple[AffordanceTable, dict[int, int]]:
        """Return the affordance table of a run.

        Args:
            run_id: the run.
            as_learned: with counters 1 and 1 in every row, whatever trials have made of them.

        Returns:
            The table; and the id of each row in the store by its learning step.
        """
        rows = self.mappings(sa.select(affordance).filter_by(learning_run_id=run_id))
        with reading_what_was_written(f"the affordance table of run {run_id}"):
            table = AffordanceTable(affordance_from(row, as_learned=as_learned) for row in rows)
        return table, {row["step"]: row["id"] for row in rows}

    def row_starts(self, run_id: int) -> dict[int, tuple[Point, Pose]]:
        """Return where the wrist and, truly, the attractor were when each row of a run was made.

        Returns:
            By learning step: wrist (in, table frame) and attractor (in, rad).
        """
        b = behavior.c
        wanted = sa.select(
            *(b.step, b.wrist_start_x, b.wrist_start_y),
            *(b.true_start_x, b.true_start_y, b.true_start_angle),
        ).where(b.learning_run_id == run_id, b.change_detected == 1)
        with self.reading() as connection:
            rows = connection.execute(wanted).all()
        return {step: (Point(wx, wy), Pose(x, y, angle)) for step, wx, wy, x, y, angle in rows}


def new_learning_run(
    spec: LearningSpec, versions: Mapping[str, str], now: str, session_id: int | None
) -> LearningRunRow:
    """Return the row of a run in which nothing was executed yet."""
    return LearningRunRow(
        session_id=session_id,
        tool=spec.tool,
        seed=spec.seed,
        robot=spec.robot,
        hours=spec.hours,
        behaviors_limit=spec.behaviors,
        settings=spec.settings,
        settings_key=settings_key(spec.settings),
        versions=to_json(versions),
        status="running",
        behaviors=0,
        rows=0,
        resets=0,
        redraws=0,
        robot_seconds=0.0,
        checkpoint=None,
        started_at=now,
        finished_at=None,
    )


def insert_learning_steps(
    connection: sa.Connection, run_id: int, tool: str, steps: Sequence[LearningStep]
) -> int:
    """Insert the behaviors of `steps` and the affordances they made; return how many these are."""
    made = [record.affordance for record, _ in steps if record.affordance is not None]
    insert_many(connection, behavior, [behavior_row(run_id, *step) for step in steps])
    insert_many(connection, affordance, [affordance_row(run_id, tool, row) for row in made])
    return len(made)


def _the_run(spec: LearningSpec, session_id: int | None) -> sa.Select[Any]:
    """Select the one run that `spec` names, by the columns of the unique index."""
    c = learning_run.c
    return sa.select(learning_run).where(
        sa.func.coalesce(c.session_id, 0) == (session_id or 0),
        c.robot == spec.robot,
        c.tool == spec.tool,
        c.seed == spec.seed,
        sa.func.coalesce(c.hours, 0) == (spec.hours or 0),
        sa.func.coalesce(c.behaviors_limit, 0) == (spec.behaviors or 0),
        c.settings_key == settings_key(spec.settings),
    )


def _info(connection: sa.Connection, wanted: sa.Select[Any]) -> LearningRunInfo | None:
    """Return the run selected, None when there is none."""
    row = connection.execute(wanted).mappings().one_or_none()
    return None if row is None else info_from(row)


def info_from(row: sa.RowMapping) -> LearningRunInfo:
    """Return what a row of learning_run says."""
    with reading_what_was_written(f"learning run {row['id']}"):
        return LearningRunInfo(
            spec=learning_spec_from(row),
            versions=dict(json.loads(row["versions"])),
            checkpoint=None if row["checkpoint"] is None else dict(json.loads(row["checkpoint"])),
            **{
                name: row[name]
                for name in (
                    *("id", "session_id", "status", "behaviors", "rows", "resets", "redraws"),
                    *("robot_seconds", "started_at", "finished_at"),
                )
            },
        )
