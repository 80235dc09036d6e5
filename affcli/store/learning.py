"""Learning runs, their behaviors and their rows (§3.2, §6)."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sqlalchemy as sa

from affcli.core.affordance_table import AffordanceTable
from affcli.core.log import LOG, LoggedTry
from affcli.core.records import AlikeRun, ChangedPart, LearningRunInfo, StepScene, StoredRow
from affcli.core.replay import Difference
from affcli.core.specs import LearningSpec, LearningStep, RowStarts
from affcli.core.transfer import Borrowed, borrowed_starts
from affcli.core.trial import Attempt
from affcli.errors import DatabaseError, UsageError, one_line
from affcli.store import reading, rows
from affcli.store.comparing import by_number, differences
from affcli.store.connection import Database, insert_many, insert_one, mappings, numbered
from affcli.store.keeping import require_kept
from affcli.store.tables import affordance, behavior, borrowed, learning_run, tool, trial

COUNTERS = frozenset({"times_used", "times_successful"})
"""Trials change them after a row is made."""


def selected_runs() -> sa.Select[Any]:
    """Select learning runs, each with the definition of its tool."""
    return sa.select(learning_run, tool.c.definition).select_from(
        learning_run.outerjoin(tool, tool.c.key == learning_run.c.tool_key)
    )


@dataclass(frozen=True, slots=True)
class Learning:
    """Learning runs, with the behaviors and the rows of each."""

    database: Database

    def begin(
        self,
        spec: LearningSpec,
        versions: Mapping[str, str],
        now: str,
        session_id: int | None = None,
        borrowing: Sequence[Borrowed] = (),
    ) -> LearningRunInfo:
        """Return the stored run of `spec`, new or as far as it came.

        What it borrows is saved with its beginning: going on with it needs no lender.

        Args:
            spec: what the run is a function of.
            versions: recorded with a new run.
            now: ISO text, UTC.
            session_id: the reproduction it is part of.
            borrowing: what a new run borrows.
        """
        found = self.find(spec, session_id)
        if found is not None:
            return found
        with self.database.writing() as connection:
            # Another process may have begun it in between.
            if connection.execute(_the_run(spec, session_id)).first() is None:
                row = rows.learning_run_row(spec, versions, now, session_id)
                row["rows"] = len(borrowing)
                run_id = insert_run(connection, row, spec)
                insert_borrowed(connection, run_id, spec.tool, borrowing)
            (stored,) = mappings(connection, _the_run(spec, session_id))
            return reading.learning_run(stored)

    def find(self, spec: LearningSpec, session_id: int | None = None) -> LearningRunInfo | None:
        """Return the stored run of `spec`, None when there is none."""
        found = self.database.mappings(_the_run(spec, session_id))
        return reading.learning_run(found[0]) if found else None

    def find_alike(self, spec: LearningSpec) -> tuple[AlikeRun, ...]:
        """Return the stored runs that differ from `spec` in settings or the world's version alone.

        A tool and its hold are taken to follow from the settings: both are told where they differ.
        """
        c = learning_run.c
        wanted = selected_runs().where(
            c.session_id.is_(None),
            *(c.tool == spec.tool, c.seed == spec.seed, c.robot == spec.robot),
            *(c.hours.is_(spec.hours), c.behaviors_limit.is_(spec.behaviors)),
            *(c.explorer == str(spec.explorer), c.sensor == spec.sensor, c.key != spec.key),
        )
        runs = map(reading.learning_run, self.database.mappings(wanted.order_by(c.id)))
        return tuple(
            AlikeRun(run, _changed(run.spec, spec))
            for run in runs
            if run.spec.repertoire == spec.repertoire
            and run.spec.world.name == spec.world.name
            and run.spec.transfer == spec.transfer
        )

    def append(
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
            UsageError: the run was deleted meanwhile.
        """
        with self.database.writing() as connection:
            row = numbered(
                connection, sa.select(learning_run), learning_run, "learning run", run_id
            )
            if row["behaviors"] > after_step or row["status"] == "done":
                return False
            if row["behaviors"] < after_step:
                raise ValueError(f"run {run_id}: {row['behaviors']} behaviors, not {after_step}")
            made = insert_steps(connection, run_id, row["tool"], steps)
            connection.execute(
                sa.update(learning_run)
                .filter_by(id=run_id)
                .values(
                    behaviors=row["behaviors"] + len(steps),
                    rows=row["rows"] + made,
                    resets=row["resets"] + sum(record.resets for record, _ in steps),
                    redraws=row["redraws"] + sum(record.redraws for record, _ in steps),
                    robot_seconds=robot_seconds,
                    checkpoint=None if done or checkpoint is None else rows.to_json(checkpoint),
                    status="done" if done else "running",
                    finished_at=now if done else None,
                    calibration=calibration,
                )
            )
            return True

    def run(self, run_id: int) -> LearningRunInfo:
        """Return a learning run, one of a reproduction too.

        Raises:
            UsageError: there is none of that number; the message says which there are.
        """
        with self.database.reading() as connection:
            found = numbered(connection, selected_runs(), learning_run, "learning run", run_id)
        return reading.learning_run(found)

    def runs(
        self,
        *,
        tool: str | None = None,
        session_id: int | None = None,
        status: str | None = None,
        tested: bool = False,
    ) -> tuple[LearningRunInfo, ...]:
        """Return the stored runs that can be read, oldest first; DatabaseError if none of them can.

        Args:
            tool: only those of this tool.
            session_id: those that the robots of this session used, also when another condition of
                their experiment learned them; None for those that stand for themselves.
            status: only ``running`` or only ``done`` ones.
            tested: only those whose tables trials of the session used: not those in which its
                robots invented, nor those from which they borrowed.
        """
        wanted = selected_runs().where(_tested_in(session_id) if tested else used_in(session_id))
        for column, value in (("tool", tool), ("status", status)):
            if value is not None:
                wanted = wanted.where(learning_run.c[column] == value)
        found = self.database.mappings(wanted.order_by(learning_run.c.id))
        runs = tuple(self.database.readable(reading.learning_run, found))
        if found and not runs:
            reading.learning_run(found[0])  # says why there is none
        return runs

    def tools(self, *, usable: bool = False) -> frozenset[str]:
        """Return the names of the tools with a finished run that stands for itself.

        Args:
            usable: there must be a robot that can use it: it was not imported from a log.
        """
        wanted = sa.select(learning_run.c.tool).where(_finished(usable=usable))
        with self.database.reading() as connection:
            return frozenset(connection.scalars(wanted))

    def latest(self, tool: str, *, usable: bool = False) -> LearningRunInfo | None:
        """Return the finished run of `tool` that was begun last, no part of a reproduction.

        Args:
            tool: its name.
            usable: as in `tools`.

        Raises:
            DatabaseError: it cannot be read; an older one does not take its place.
        """
        wanted = selected_runs().where(_finished(usable=usable)).filter_by(tool=tool)
        found = self.database.mappings(wanted.order_by(learning_run.c.id.desc()).limit(1))
        return reading.learning_run(found[0]) if found else None

    def table(
        self, run_id: int, *, as_learned: bool = False
    ) -> tuple[AffordanceTable, dict[int, int]]:
        """Return the affordance table of a run.

        Args:
            run_id: the run.
            as_learned: with counters 1 and 1 in every row, whatever trials have made of them.

        Returns:
            The table; and the id of each row in the store by its learning step.
        """
        learned = self.run(run_id).spec
        require_kept(self.database, "rows", learning_run.c.id == run_id)
        found = self.database.mappings(sa.select(affordance).filter_by(learning_run_id=run_id))
        fresh = dict.fromkeys(COUNTERS, 1) if as_learned else {}
        place, counted = (
            f"the affordance table of run {run_id}",
            ({**row, **fresh} for row in found),
        )
        table = reading.affordance_table(place, counted, learned)
        return table, {row["step"]: row["id"] for row in found}

    def row(self, row_id: int) -> StoredRow:
        """Return a row of an affordance table.

        Raises:
            UsageError: there is none of that number; the message says which there are.
        """
        with self.database.reading() as connection:
            found = numbered(connection, sa.select(affordance), affordance, "affordance", row_id)
        return reading.stored_row(found)

    def rows(self, run_id: int) -> tuple[StoredRow, ...]:
        """Return the rows of a learning run, oldest first."""
        require_kept(self.database, "rows", learning_run.c.id == run_id)
        wanted = sa.select(affordance).filter_by(learning_run_id=run_id)
        return tuple(
            map(reading.stored_row, self.database.mappings(wanted.order_by(affordance.c.step)))
        )

    def row_starts(self, run_id: int) -> RowStarts:
        """Return where the wrist and, truly, the attractor were when each row of a run was made.

        Empty for a world that does not tell where the attractor truly is. A borrowed row was not
        made there: it is taken as it says.

        Raises:
            DatabaseError: behaviors that made rows are missing.
        """
        b = behavior.c
        require_kept(self.database, "behaviors", learning_run.c.id == run_id)
        wanted = sa.select(behavior).where(b.learning_run_id == run_id, b.change_detected == 1)
        made = self.database.mappings(wanted)
        stored = [one.row for one in self.rows(run_id)]
        own = [row for row in stored if not row.is_borrowed]
        known, count = {row["step"] for row in made}, self.run(run_id).rows
        borrowing = borrowed_starts(stored)
        if len(made) + len(borrowing) < count or any(row.step not in known for row in own):
            raise DatabaseError(
                f"learning run {run_id} lacks behaviors that made its rows; restore a copy of the "
                "database"
            )
        return borrowing | {
            row["step"]: (reading.pose(row, "wrist_start"), reading.pose(row, "true_start"))
            for row in made
            if row["true_start_x"] is not None
        }

    def tries(self, run_id: int) -> tuple[LoggedTry, ...]:
        """Return what each behavior of an imported run did, in their order."""
        require_kept(self.database, "behaviors", learning_run.c.id == run_id)
        wanted = sa.select(behavior).filter_by(learning_run_id=run_id).order_by(behavior.c.step)
        found = self.database.mappings(wanted)
        with reading.reading_what_was_written(f"learning run {run_id}"):
            return tuple(map(reading.logged_try, found))

    def scene(self, run_id: int, number: int) -> StepScene:
        """Return one behavior of a learning run, held by the first of its grasps.

        Raises:
            UsageError: no such run, or no such behavior in it, or its world does not tell where the
                attractor truly was.
        """
        info, b = self.run(run_id), behavior.c
        require_kept(self.database, "behaviors", learning_run.c.id == run_id)
        wanted = sa.select(behavior).where(
            b.learning_run_id == run_id, b.step.in_((number - 1, number))
        )
        found = {row["step"]: row for row in self.database.mappings(wanted)}
        title = f"Run {run_id}, behavior {number} of {info.behaviors}"
        with reading.reading_what_was_written(title):
            row, before = found.get(number), found.get(number - 1)
            if row is None:
                raise UsageError(
                    f"no behavior {number} in run {run_id}; it has 1 to {info.behaviors}"
                )
            start = reading.point_or_none(row, "true_start")
            end = reading.point_or_none(row, "true_end")
            if start is None or end is None:
                raise UsageError(f"run {run_id}: its world does not tell where the attractor was")
            return StepScene(
                *(title, (run_id, number), info.spec, info.spec.tool, info.spec.held),
                goal=None,
                seed=info.spec.seed,
                robot=info.spec.robot,
                wrist_before=None if before is None else reading.pose(before, "wrist_end"),
                wrist_start=reading.pose(row, "wrist_start"),
                wrist_end=reading.pose(row, "wrist_end"),
                attractor_start=start,
                attractor_end=end,
                binding=info.spec.binding,
                call=reading.behavior_call(row["exploratory_behavior"], row["exploratory_params"]),
                blocked=False,
            )

    def differences(
        self, run_id: int, tool: str, steps: Sequence[LearningStep]
    ) -> tuple[Difference, ...]:
        """Return where behaviors of a learning run that were done again differ from their record.

        The rows they made are compared too, but for the counters, which trials change.

        Args:
            run_id: the record.
            tool: the name of the tool held.
            steps: what was done: behaviors that follow one another.
        """
        if not steps:
            return ()
        require_kept(self.database, "behaviors", learning_run.c.id == run_id)
        first, last = steps[0][0].step, steps[-1][0].step
        done = {record.step: rows.behavior_row(run_id, record, truth) for record, truth in steps}
        made = {
            record.step: rows.affordance_row(run_id, tool, record.affordance)
            for record, _ in steps
            if record.affordance is not None
        }
        kept, kept_rows = (
            by_number(
                self.database.mappings(
                    sa.select(table)
                    .filter_by(learning_run_id=run_id)
                    .where(table.c.step.between(first, last))
                ),
                "step",
            )
            for table in (behavior, affordance)
        )
        return (
            *differences("behavior", kept, done),
            *(d for d in differences("affordance", kept_rows, made) if d.column not in COUNTERS),
        )


def _finished(*, usable: bool) -> sa.ColumnElement[bool]:
    """Tell whether a learning run is finished and stands for itself; and there is a robot."""
    c = learning_run.c
    own = sa.and_(used_in(None), c.status == "done")
    return sa.and_(own, c.world.not_like(f"{LOG}:%")) if usable else own


def used_in(session_id: int | None) -> sa.ColumnElement[bool]:
    """Tell whether a learning run is part of a session or was used in it, or stands for itself."""
    c = learning_run.c
    if session_id is None:
        return c.session_id.is_(None)
    # The first as the unique index spells it.
    return sa.or_(sa.func.coalesce(c.session_id, 0) == session_id, _tested_in(session_id))


def _tested_in(session_id: int | None) -> sa.ColumnElement[bool]:
    """Tell whether trials of a session used the table of a learning run."""
    used = sa.select(trial.c.learning_run_id).where(trial.c.session_id == session_id)
    return learning_run.c.id.in_(used)


def insert_run(connection: sa.Connection, row: Mapping[str, Any], spec: LearningSpec) -> int:
    """Insert a learning run and its tool, unless that is there; return the run's id."""
    insert_tools(connection, spec)
    return insert_one(connection, learning_run, row)


def insert_tools(connection: sa.Connection, *specs: Any) -> None:
    """Insert the tools that specs hold, but for those that are there and those without a shape."""
    held = {spec.held for spec in specs if spec.held.parts}
    if held:
        connection.exec_driver_sql(
            "INSERT INTO tool (key, name, definition) VALUES (?, ?, ?) "
            "ON CONFLICT (key) DO NOTHING",
            [rows.tool_row(tool) for tool in held],
        )


def insert_borrowed(
    connection: sa.Connection, run_id: int, tool: str, made: Sequence[Borrowed]
) -> None:
    """Insert what a run borrowed."""
    own = [rows.affordance_row(run_id, tool, one.row) for one in made]
    insert_many(connection, affordance, own)
    insert_many(connection, borrowed, [rows.borrowed_row(run_id, one) for one in made])


def insert_steps(
    connection: sa.Connection, run_id: int, tool: str, steps: Sequence[LearningStep]
) -> int:
    """Insert the behaviors of `steps` and the affordances they made; return how many these are."""
    made = [record.affordance for record, _ in steps if record.affordance is not None]
    insert_many(connection, behavior, [rows.behavior_row(run_id, *step) for step in steps])
    insert_many(connection, affordance, [rows.affordance_row(run_id, tool, row) for row in made])
    return len(made)


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


def _the_run(spec: LearningSpec, session_id: int | None) -> sa.Select[Any]:
    """Select the one run that `spec` names, by the columns of the unique index."""
    c = learning_run.c
    return selected_runs().where(
        sa.func.coalesce(c.session_id, 0) == (session_id or 0), c.key == spec.key
    )


def _changed(stored: LearningSpec, wanted: LearningSpec) -> tuple[ChangedPart, ...]:
    """Return in which settings, and in what else, two specs differ."""

    def bindings_of(spec: LearningSpec) -> str:
        return " or ".join(map(str, spec.bindings))

    old, new = json.loads(stored.settings), json.loads(wanted.settings)
    parts = [(name, old.get(name), new.get(name)) for name in sorted(old.keys() | new.keys())]
    parts += [
        ("world", str(stored.world), str(wanted.world)),
        ("binding", bindings_of(stored), bindings_of(wanted)),
        ("tool", stored.held.key[:8], wanted.held.key[:8]),
    ]
    return tuple(ChangedPart(*part) for part in parts if part[1] != part[2])
