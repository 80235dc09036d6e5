"""Sessions and their testing trials in the store."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import sqlalchemy as sa

from affcli.core.trial import (
    LARGEST_SEED,
    MOST_ROBOTS,
    Counters,
    RobotRecord,
    StepRecord,
    TrialEnd,
    TrialRecord,
    TrialSpec,
    Truth,
)
from affcli.store.connection import Connected, insert_many, insert_one
from affcli.store.counting import count_use
from affcli.store.learning import new_learning_run
from affcli.store.mapping import (
    reading_what_was_written,
    settings_key,
    step_row,
    to_json,
    trial_end_columns,
    trial_row,
)
from affcli.store.packing import PackedRobot, PackedTrial, pack_robot, pack_trial
from affcli.store.rows import SessionRow
from affcli.store.tables import affordance, behavior, learning_run, session, step, trial

SessionKind = Literal["solve", "break-tool", "reproduce"]
"""Which command a session is."""


@dataclass(frozen=True, slots=True)
class SessionInfo:
    """One command that produced trials or a reproduction.

    Args:
        id: its number in the store.
        kind: which command: ``solve``, ``break-tool`` or ``reproduce``.
        seed: of all it did.
        robots: how many; 1 unless it is a reproduction.
        settings: canonical JSON.
        versions: what it was made with.
        status: ``running`` or ``done``.
        started_at, finished_at: ISO text, UTC.
    """

    id: int
    kind: str
    seed: int
    robots: int
    settings: str
    versions: dict[str, str]
    status: str
    started_at: str
    finished_at: str | None


class Trials(Connected):
    """The part of the store that keeps sessions, trials and steps."""

    def begin_session(
        self,
        kind: SessionKind,
        seed: int,
        robots: int,
        settings: str,
        versions: Mapping[str, str],
        now: str,
    ) -> int:
        """Return the id of a new session; of a reproduction begun before, that of the old one.

        Args:
            kind: which command.
            seed: of all it will do.
            robots: how many; 1 unless it is a reproduction.
            settings: canonical JSON.
            versions: what it is made with.
            now: ISO text, UTC.
        """
        row = SessionRow(
            kind=kind,
            seed=seed,
            robots=robots,
            settings=settings,
            settings_key=settings_key(settings),
            versions=to_json(versions),
            status="running",
            started_at=now,
            finished_at=None,
        )
        with self.writing() as connection:
            if kind == "reproduce":
                found = connection.execute(_sessions_like(kind, seed, robots, settings)).first()
                if found is not None:
                    return int(found.id)
            return insert_one(connection, session, row)

    def find_session(
        self, kind: SessionKind, seed: int, robots: int, settings: str
    ) -> SessionInfo | None:
        """Return the latest session of these arguments, None when there is none."""
        with self.reading() as connection:
            wanted = _sessions_like(kind, seed, robots, settings)
            row = connection.execute(wanted).mappings().first()
        return None if row is None else _session_info(row)

    def sessions(self, kind: SessionKind | None = None) -> tuple[SessionInfo, ...]:
        """Return the sessions, all or of one kind, oldest first."""
        wanted = sa.select(session).order_by(session.c.id)
        if kind is not None:
            wanted = wanted.where(session.c.kind == kind)
        return tuple(map(_session_info, self.mappings(wanted)))

    def finish_session(self, session_id: int, now: str) -> None:
        """Mark a session as done; one that was done before stays as it is."""
        with self.writing() as connection:
            connection.execute(
                sa.update(session)
                .filter_by(id=session_id, status="running")
                .values(status="done", finished_at=now)
            )

    def begin_trial(
        self, session_id: int, run_id: int, spec: TrialSpec, calibration: str | None = None
    ) -> int:
        """Return the id of a new trial without steps.

        Args:
            session_id: the session it is part of.
            run_id: the learning run whose table it starts from.
            spec: which trial.
            calibration: of the camera it sees through, as JSON; None without one.
        """
        row = trial_row(session_id, run_id, spec, calibration)
        with self.writing() as connection:
            return insert_one(connection, trial, row)

    def save_step(
        self, trial_id: int, spec: TrialSpec, record: StepRecord, truth: Truth, affordance_id: int
    ) -> None:
        """Save one step, and the counters it changed, in one transaction.

        The stored counters change when the trial is one that updates them (`Counters.STORED`).

        Args:
            trial_id: the trial.
            spec: which trial.
            record: the step.
            truth: where the attractor truly was.
            affordance_id: the row that was tried, in the store.

        Raises:
            DatabaseError: another process changed the counters meanwhile; nothing is saved.
        """
        with self.writing() as connection:
            if spec.counters is Counters.STORED:
                count_use(connection, self.path, record, affordance_id, "steps")
            insert_one(connection, step, step_row(trial_id, affordance_id, record, truth, None))

    def end_trial(self, trial_id: int, end: TrialEnd) -> None:
        """Save how a trial ended."""
        with self.writing() as connection:
            values = trial_end_columns(end)
            connection.execute(sa.update(trial).filter_by(id=trial_id).values(values))

    def save_trials(
        self,
        session_id: int,
        run_id: int,
        trials: Sequence[TrialRecord],
        affordance_ids: Mapping[int, int],
    ) -> list[int]:
        """Save whole trials that started from the table as learned, in one transaction.

        Args:
            session_id: the session they are part of.
            run_id: the learning run whose table they started from.
            trials: from beginning to end.
            affordance_ids: of each row of that table by its learning step.

        Returns:
            Their numbers in the store.
        """
        with self.writing() as connection:
            packed = [pack_trial(record) for record in trials]
            return _insert_trials(connection, session_id, run_id, packed, affordance_ids)

    def saved_robots(self, session_id: int) -> frozenset[int]:
        """Return the numbers of the robots that a reproduction has saved already."""
        wanted = sa.select(learning_run.c.robot).distinct().where(_part_of(session_id))
        with self.reading() as connection:
            return frozenset(connection.scalars(wanted))

    def save_robot(
        self,
        session_id: int,
        robot: RobotRecord | PackedRobot,
        versions: Mapping[str, str],
        now: str,
    ) -> bool:
        """Save the whole life of one robot of a reproduction in one transaction.

        Args:
            session_id: the reproduction.
            robot: its learning runs and its trials; packed when another process lived them.
            versions: what it was made with.
            now: ISO text, UTC.

        Returns:
            False when this robot was saved before; nothing is written then.
        """
        packed = robot if isinstance(robot, PackedRobot) else pack_robot(robot)
        with self.writing() as connection:
            is_there = sa.select(learning_run.c.id).where(
                _part_of(session_id), learning_run.c.robot == packed.robot
            )
            if connection.execute(is_there.limit(1)).first() is not None:
                return False
            for run in packed.runs:
                row = new_learning_run(run.spec, versions, now, session_id)._replace(
                    status="done",
                    behaviors=len(run.behaviors),
                    rows=len(run.affordances),
                    resets=run.resets,
                    redraws=run.redraws,
                    robot_seconds=run.robot_seconds,
                    finished_at=now,
                    calibration=packed.calibration,
                )
                run_id = insert_one(connection, learning_run, row)
                insert_many(connection, behavior, [(run_id, *row) for row in run.behaviors])
                insert_many(connection, affordance, [(run_id, *row) for row in run.affordances])
                ids = _affordance_ids(connection, run_id)
                _insert_trials(connection, session_id, run_id, run.trials, ids)
            return True


def _insert_trials(
    connection: sa.Connection,
    session_id: int,
    run_id: int,
    trials: Sequence[PackedTrial],
    affordance_ids: Mapping[int, int],
) -> list[int]:
    """Insert trials with their steps; return the trials' numbers."""
    numbers: list[int] = []
    steps: list[tuple[object, ...]] = []
    for packed in trials:
        row = packed.row._replace(session_id=session_id, learning_run_id=run_id)
        trial_id = insert_one(connection, trial, row)
        numbers.append(trial_id)
        steps += [
            (trial_id, affordance_ids[tried], *row)
            for tried, row in zip(packed.tried, packed.steps, strict=True)
        ]
    insert_many(connection, step, steps)
    return numbers


def _affordance_ids(connection: sa.Connection, run_id: int) -> dict[int, int]:
    """Return the ids of a run's affordances by learning step."""
    columns = sa.select(affordance.c.step, affordance.c.id).filter_by(learning_run_id=run_id)
    return {row.step: row.id for row in connection.execute(columns)}


def _part_of(session_id: int) -> sa.ColumnElement[bool]:
    """Be a learning run of a reproduction, as the unique index spells it."""
    return sa.func.coalesce(learning_run.c.session_id, 0) == session_id


def _sessions_like(kind: str, seed: int, robots: int, settings: str) -> sa.Select[Any]:
    """Select the sessions of these arguments, latest first."""
    key = settings_key(settings)
    same = sa.select(session).filter_by(kind=kind, seed=seed, robots=robots, settings_key=key)
    return same.order_by(session.c.id.desc())


def _session_info(row: sa.RowMapping) -> SessionInfo:
    """Return what a row of session says."""
    with reading_what_was_written(f"session {row['id']}"):
        if not (0 <= row["seed"] <= LARGEST_SEED and 0 < row["robots"] <= MOST_ROBOTS):
            raise ValueError("a seed or a number of robots out of range")
        return SessionInfo(
            versions=json.loads(row["versions"]),
            **{
                name: row[name]
                for name in (
                    *("id", "kind", "seed", "robots", "settings", "status"),
                    *("started_at", "finished_at"),
                )
            },
        )
