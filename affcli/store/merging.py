"""Several databases into one: the robots of the same experiment, each once, whoever lived it."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from itertools import zip_longest
from pathlib import Path
from typing import Any

import sqlalchemy as sa

from affcli.core.specs import REPRODUCE
from affcli.core.trial import named_before
from affcli.errors import DatabaseError, UsageError, one_line
from affcli.store.columns import COLUMNS
from affcli.store.connection import insert_many, insert_one, mappings, tuples
from affcli.store.database_file import require_place
from affcli.store.experiments import sessions_of, settle
from affcli.store.learning import COUNTERS
from affcli.store.opening import Store, open_store
from affcli.store.replacing import replacing
from affcli.store.sessions import forget_failure
from affcli.store.tables import (
    affordance,
    behavior,
    borrowed,
    experiment,
    failed_robot,
    invention,
    invention_try,
    learning_run,
    mask,
    session,
    step,
    tool,
    trial,
    verification,
)

RUN_SUMS = ("behaviors", "rows", "resets", "redraws", "robot_seconds")
TRIAL_SUMS = ("protocol", "tool", "planner", "steps", "robot_seconds")
"""What two records of one run, or of one trial, must have alike, beside the outcome: the rest
follows from them."""
LEFT_OUT = {
    "learning runs of affcli learn and import": sa.select(learning_run).where(
        learning_run.c.session_id.is_(None)
    ),
    "sessions of affcli solve and break-tool": sa.select(session).where(
        session.c.kind.in_(("solve", "break-tool"))
    ),
    "verifications of affcli verify": sa.select(verification),
}
"""What is not merged: it depends on all that was done with a table, in its order.

The counters that it moved are copied as they were when the table was learned.
"""

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Merged:
    """What a merge did.

    Args:
        new: how many robots it brought.
        there: how many it found there already.
        left_out: how many records it left out, by what they are.
    """

    new: int
    there: int
    left_out: dict[str, int]


@dataclass(frozen=True, slots=True)
class _Many:
    """The robots of an experiment, or of a reproduction.

    Args:
        what: which, for messages.
        sessions: those of its conditions in the target, in order.
        lives: where each robot is, by its number: one place at least.
        failed: the notes on those that failed in some place.
    """

    what: str
    sessions: tuple[int, ...]
    lives: dict[int, list["_Life"]] = field(default_factory=dict)
    failed: dict[int, Row] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class _Life:
    """One robot in one database.

    Args:
        connection: to it.
        path: where it is.
        sessions: of the conditions there, in order.
        robot: the number.
        runs: its learning runs there.
    """

    connection: sa.Connection
    path: Path
    sessions: tuple[int, ...]
    robot: int
    runs: tuple[int, ...]

    def learned(self) -> list[Row]:
        """Return its learning runs, oldest first."""
        wanted = sa.select(learning_run).where(learning_run.c.id.in_(self.runs))
        return mappings(self.connection, wanted.order_by(learning_run.c.id))

    def trials(self) -> list[Row]:
        """Return its trials, oldest first."""
        of_robot = sa.select(trial).where(
            trial.c.session_id.in_(self.sessions), trial.c.robot == self.robot
        )
        return mappings(self.connection, of_robot.order_by(trial.c.id))

    def condition(self, row: Row) -> int:
        """Return to which condition one of its runs or trials belongs."""
        return self.sessions.index(row["session_id"])

    def sums(self) -> list[tuple[str, list[Any]]]:
        """Return in words what it learned and tried, each with what came of it."""
        return [
            *(
                (
                    f"the {row['tool']} it learned",
                    [self.condition(row), row["key"], *(row[name] for name in RUN_SUMS)],
                )
                for row in self.learned()
            ),
            *(
                (
                    f"its trial with the {row['shape']} at goal {row['goal']} from {row['start']}",
                    [
                        self.condition(row),
                        named_before(row["outcome"]),
                        *(row[name] for name in TRIAL_SUMS),
                    ],
                )
                for row in self.trials()
            ),
        ]


def merge(
    sources: Sequence[Path],
    into: Path,
    now: str,
    progress: Callable[[int, int], object] = lambda _, __: None,
) -> Merged:
    """Bring the robots of experiments and reproductions together, in one transaction.

    A robot is known by its experiment (name and key) or its reproduction (key), and its number. One
    that is there already stays: the same merge again changes nothing. Robots are taken in the order
    of their numbers, so what was shared out comes together as if it had not been.

    Args:
        sources: the databases; they are only read.
        into: where to; made if it is not there.
        now: ISO text, UTC.
        progress: is told how many robots are done, of how many.

    Raises:
        UsageError: `into` is one of the sources.
        DatabaseError: two databases contradict each other: in one name they have other experiments,
            or one robot did not do the same in both. Nothing is changed then.
    """
    for path in sources:
        if path.exists() and into.exists() and path.samefile(into):
            raise UsageError(f"--into {one_line(into)} is one of those to merge; name another file")
    with ExitStack() as stack:
        stores = [stack.enter_context(open_store(p, create=False, write=False)) for p in sources]
        target = stack.enter_context(_opened(into))
        readers = [stack.enter_context(store.database.reading()) for store in stores]
        with target.database.writing() as connection:
            merging = _Merging(connection, into, now)
            for reader, path in zip(readers, sources, strict=True):
                merging.take_note(reader, path)
            return merging.bring(progress)


@contextmanager
def _opened(into: Path) -> Iterator[Store]:
    """Open the target; one that is not there appears when the merge is done, or not at all."""
    require_place(into, create=True, write=True)
    if into.exists():
        with open_store(into, create=True, write=True) as store:
            yield store
        return
    with replacing(into) as part:
        with open_store(part, create=True, write=True) as store:
            yield store
        if into.exists():
            raise DatabaseError(
                f"{one_line(into)}: another process made it meanwhile; nothing was merged into it: "
                "run the command again"
            )


class _Merging:
    """A merge within an open transaction of the target."""

    def __init__(self, connection: sa.Connection, path: Path, now: str) -> None:
        self._connection, self._path, self._now = connection, path, now
        self._many: dict[tuple[str, str], _Many] = {}
        self._left_out = dict.fromkeys(LEFT_OUT, 0)

    def take_note(self, source: sa.Connection, path: Path) -> None:
        """See which robots a source has; make room for their experiments and tools."""
        here = set(self._connection.scalars(sa.select(tool.c.key)))
        rows = tuples(source, sa.select(*(tool.c[name] for name in COLUMNS["tool"])))
        insert_many(self._connection, tool, [row for row in rows if row[0] not in here])
        for row in mappings(source, sa.select(experiment).order_by(experiment.c.id)):
            sessions = sessions_of(source, row["id"])
            self._see(self._experiment(row, sessions, path), source, path, sessions)
        for row in mappings(source, sa.select(session).filter_by(kind=REPRODUCE)):
            self._see(self._reproduction(row), source, path, [row])
        for what, wanted in LEFT_OUT.items():
            count = sa.select(sa.func.count()).select_from(wanted.subquery())
            self._left_out[what] += source.scalar(count) or 0

    def _experiment(self, row: Row, sessions: Sequence[Row], path: Path) -> _Many:
        """Return the robots of an experiment in the target, made like that of a source."""
        which, name = ("experiment", row["name"]), one_line(row["name"])
        of_name = sa.select(experiment).filter_by(name=row["name"])
        there = next(iter(mappings(self._connection, of_name)), None)
        if there is None:
            number = insert_one(self._connection, experiment, _without(row, "id"))
            for one in sessions:
                part = {**_without(one, "id"), "experiment_id": number}
                insert_one(self._connection, session, part)
        elif there["key"] != row["key"]:
            raise DatabaseError(
                f"{one_line(path)}: its experiment {name} is another than that of "
                f"{one_line(self._path)}; they cannot be one"
            )
        else:
            number = there["id"]
        own = sessions_of(self._connection, number)
        if own[0]["robots"] < sessions[0]["robots"]:  # it was made larger
            more = {key: row[key] for key in ("definition", "question")}
            change = sa.update(experiment).filter_by(id=number).values(more)
            self._connection.execute(change)
            for one, larger in zip(own, sessions, strict=True):
                more = {key: larger[key] for key in ("robots", "key")}
                self._connection.execute(sa.update(session).filter_by(id=one["id"]).values(more))
        ids = tuple(one["id"] for one in own)
        return self._many.setdefault(which, _Many(f"experiment {name}", ids))

    def _reproduction(self, row: Row) -> _Many:
        """Return the robots of a reproduction in the target, made like that of a source."""
        same = sa.select(session.c.id).filter_by(kind=REPRODUCE, key=row["key"])
        number = self._connection.scalar(same)
        if number is None:
            number = insert_one(self._connection, session, _without(row, "id"))
        what = f"the reproduction of seed {row['seed']}"
        return self._many.setdefault((REPRODUCE, row["key"]), _Many(what, (number,)))

    def _see(self, many: _Many, source: sa.Connection, path: Path, sessions: Iterable[Row]) -> None:
        """Take note of the robots of one experiment in one source."""
        ids = tuple(one["id"] for one in sessions)
        c = learning_run.c
        wanted = sa.select(c.robot, c.id).where(c.session_id.in_(ids)).order_by(c.id)
        runs: dict[int, list[int]] = {}
        for robot, run in tuples(source, wanted):
            runs.setdefault(robot, []).append(run)
        for robot, own in runs.items():
            life = _Life(source, path, ids, robot, tuple(own))
            many.lives.setdefault(robot, []).append(life)
        for row in mappings(source, sa.select(failed_robot).filter_by(session_id=ids[0])):
            many.failed.setdefault(row["robot"], row)

    def bring(self, progress: Callable[[int, int], object]) -> Merged:
        """Copy the robots that are not there; mark as done what has all its robots."""
        lives = [
            (many, life)
            for many in self._many.values()
            for robot in sorted(many.lives)
            for life in many.lives[robot]
        ]
        new = 0
        for number, (many, life) in enumerate(lives, 1):
            new += self._bring(many, life)
            progress(number, len(lives))
        for many in self._many.values():
            self._note_failed(many)
            wanted = sa.select(session).where(session.c.id.in_(many.sessions))
            settle(self._connection, mappings(self._connection, wanted), self._now)
        left_out = {what: count for what, count in self._left_out.items() if count}
        return Merged(new, len(lives) - new, left_out)

    def _note_failed(self, many: _Many) -> None:
        """Note which robots failed that live nowhere."""
        first = many.sessions[0]
        known = sa.union(
            *(sa.select(t.c.robot).where(t.c.session_id == first) for t in (trial, failed_robot))
        )
        here = set(self._connection.scalars(known))
        for robot in sorted(many.failed.keys() - here):
            row = {**many.failed[robot], "session_id": first}
            self._connection.execute(sa.insert(failed_robot).values(row))

    def _bring(self, many: _Many, life: _Life) -> bool:
        """Copy a robot; of one that is there make sure that it is the same, and return False."""
        c = learning_run.c
        own = sa.and_(c.session_id.in_(many.sessions), c.robot == life.robot)
        runs = self._connection.scalars(sa.select(c.id).where(own).order_by(c.id)).all()
        if not runs:
            self._copy(many, life)
            return True
        there = _Life(self._connection, self._path, many.sessions, life.robot, tuple(runs))
        difference = _difference(there, life)
        if difference:
            raise DatabaseError(
                f"{one_line(life.path)}: robot {life.robot} of {many.what} is another than in "
                f"{one_line(self._path)}: {difference}"
            )
        return False

    def _copy(self, many: _Many, life: _Life) -> None:
        """Copy a whole robot."""
        sessions = dict(zip(life.sessions, many.sessions, strict=True))
        forget_failure(self._connection, many.sessions[0], life.robot)
        runs, rows, trials = {}, {}, {}
        for row in life.learned():
            own = {**_without(row, "id"), "session_id": sessions[row["session_id"]]}
            runs[row["id"]] = insert_one(self._connection, learning_run, own)
        self._copy_rows(life, behavior, "step", runs)
        self._copy_rows(life, invention, "number", runs)
        self._copy_rows(life, invention_try, "step", runs)
        self._copy_rows(life, mask, "first_column", runs)
        self._copy_rows(life, borrowed, "step", runs)
        rows = self._copy_numbered(life, runs)
        for row in life.trials():
            own = {
                **_without(row, "id"),
                "session_id": sessions[row["session_id"]],
                "learning_run_id": runs[row["learning_run_id"]],
            }
            trials[row["id"]] = insert_one(self._connection, trial, own)
        self._copy_rows(life, step, "number", trials, rows)

    def _copy_rows(
        self,
        life: _Life,
        table: sa.TableClause,
        order: str,
        owners: dict[int, int],
        tried: dict[int, int] | None = None,
    ) -> None:
        """Copy the rows that belong to runs or trials, whose numbers in the target are given."""
        names = COLUMNS[table.name]
        owner = table.c[names[0]]
        columns = (
            sa.literal(1).label(name) if name in COUNTERS else table.c[name] for name in names
        )
        wanted = sa.select(*columns).where(owner.in_(owners))
        copied = []
        for first, second, *rest in tuples(life.connection, wanted.order_by(owner, table.c[order])):
            copied.append((owners[first], tried[second] if tried else second, *rest))
        insert_many(self._connection, table, copied)

    def _copy_numbered(self, life: _Life, runs: dict[int, int]) -> dict[int, int]:
        """Copy the rows of affordance tables; return their numbers in the target by the others."""
        self._copy_rows(life, affordance, "id", runs)
        key = (affordance.c.learning_run_id, affordance.c.step)
        wanted = sa.select(affordance.c.id, *key)
        ours = {
            (run, number): row
            for row, run, number in tuples(
                self._connection, wanted.where(key[0].in_(runs.values()))
            )
        }
        theirs = tuples(life.connection, wanted.where(key[0].in_(runs)))
        return {row: ours[runs[run], number] for row, run, number in theirs}


def _without(row: Row, name: str) -> Row:
    """Return a row without one of its columns."""
    return {key: value for key, value in row.items() if key != name}


def _difference(one: _Life, other: _Life) -> str:
    """Return in words the first thing in which two records of a robot differ, "" if in none."""
    lives = sorted(((life.sums(), life.path) for life in (other, one)), key=lambda p: -len(p[0]))
    (longer, _), (shorter, path) = lives
    for more, less in zip_longest(longer, shorter):
        if more != less:
            what, _ = more
            if len(longer) > len(shorter) and (less is None or less[0] != what):
                return f"{what} is not in {one_line(path)}; was it deleted?"
            return f"{what} differs; were they made by other versions?"
    return ""
