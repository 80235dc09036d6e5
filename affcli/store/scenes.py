"""What a stored behavior was: enough to lay the table out again as it was then."""

from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.errors import UsageError
from affcli.store.connection import Connected
from affcli.store.mapping import behavior_call, reading_what_was_written
from affcli.store.tables import affordance, behavior, learning_run, step, trial


@dataclass(frozen=True, slots=True)
class StepScene:
    """One step of a trial, or one behavior of a learning run, as it truly was.

    Args:
        title: which, in words.
        key: which, in numbers.
        settings: of the learning run, as canonical JSON.
        tool, shape: what the robot believed to hold and what it held.
        goal: of the trial; None while learning.
        seed, robot: whose.
        wrist_before: where the wrist was when it began; None for the first.
        wrist_start, wrist_end: where it was before and after the exploratory behavior; when the
            tool could not be lowered, before and after it was carried there.
        attractor_start, attractor_end: where the attractor truly was before and after.
        call: the exploratory behavior.
        blocked: the tool could not be lowered, so it was not executed.
    """

    title: str
    key: tuple[int, ...]
    settings: str
    tool: str
    shape: str
    goal: int | None
    seed: int
    robot: int
    wrist_before: Point | None
    wrist_start: Point
    wrist_end: Point
    attractor_start: Point
    attractor_end: Point
    call: BehaviorCall
    blocked: bool


class Scenes(Connected):
    """The part of the store that tells what a behavior looked like."""

    def step_scene(self, trial_id: int, number: int) -> StepScene:
        """Return one step of a trial.

        Raises:
            UsageError: no such trial, or no such step in it.
        """
        t, s, r, a = trial.c, step.c, learning_run.c, affordance.c
        about = (
            sa.select(r.settings, t.tool, t.shape, t.goal, t.seed, t.robot)
            .select_from(trial.join(learning_run, r.id == t.learning_run_id))
            .where(t.id == trial_id)
        )
        taken = (
            sa.select(
                s.number, *_moved(step), s.status, a.exploratory_behavior, a.exploratory_params
            )
            .select_from(step.join(affordance, a.id == s.affordance_id))
            .where(s.trial_id == trial_id, s.number.in_((number - 1, number)))
        )
        steps = sa.select(sa.func.count()).where(s.trial_id == trial_id)
        with self.reading() as connection:
            known = connection.execute(sa.select(sa.func.max(t.id))).scalar()
            found = _one(connection, about, "trial", trial_id, known)
            count = connection.execute(steps).scalar_one()
            row, before = _this_and_the_one_before(connection, taken, number)
        if row is None:
            known = f"it has steps 1 to {count}" if count else "it has none"
            raise UsageError(f"no step {number} in trial {trial_id}; {known}")
        title = f"Trial {trial_id}, step {number} of {count}"
        return _scene(title, (trial_id, number), tuple(found), row, before)

    def behavior_scene(self, run_id: int, number: int) -> StepScene:
        """Return one behavior of a learning run.

        Raises:
            UsageError: no such run, or no such behavior in it.
        """
        r, b = learning_run.c, behavior.c
        about = sa.select(
            *(r.settings, r.tool, r.tool, sa.null(), r.seed, r.robot, r.behaviors)
        ).where(r.id == run_id)
        taken = sa.select(
            b.step, *_moved(behavior), b.status, b.exploratory_behavior, b.exploratory_params
        ).where(b.learning_run_id == run_id, b.step.in_((number - 1, number)))
        with self.reading() as connection:
            known = connection.execute(sa.select(sa.func.max(r.id))).scalar()
            found = _one(connection, about, "learning run", run_id, known)
            row, before = _this_and_the_one_before(connection, taken, number)
        if row is None:
            raise UsageError(f"no behavior {number} in run {run_id}; it has 1 to {found[-1]}")
        title = f"Run {run_id}, behavior {number} of {found[-1]}"
        return _scene(title, (run_id, number), tuple(found[:-1]), row, before)


def _moved(table: sa.TableClause) -> tuple[sa.ColumnClause[float], ...]:
    """Return the columns that say where wrist and attractor were."""
    names = ("wrist_start", "wrist_end", "true_start", "true_end")
    return tuple(table.c[f"{name}_{axis}"] for name in names for axis in "xy")


def _one(
    connection: sa.Connection, wanted: sa.Select[Any], what: str, number: int, last: int | None
) -> sa.Row[Any]:
    """Return the only row; UsageError that says which there are when there is none."""
    row = connection.execute(wanted).first()
    if row is None:
        known = f"they are numbered 1 to {last}" if last else "there are none yet"
        raise UsageError(f"no {what} {number}; {known}")
    return row


def _this_and_the_one_before(
    connection: sa.Connection, wanted: sa.Select[Any], number: int
) -> tuple[sa.Row[Any] | None, sa.Row[Any] | None]:
    """Return the row of this number and of the one before, None where there is none."""
    rows = {row[0]: row for row in connection.execute(wanted)}
    return rows.get(number), rows.get(number - 1)


def _scene(
    title: str,
    key: tuple[int, ...],
    about: tuple[Any, ...],
    row: Any,
    before: Any,
) -> StepScene:
    """Return the scene of a row; `before` is the one before it, or None."""
    settings, tool, shape, goal, seed, robot = about
    places = [Point(row[i], row[i + 1]) for i in (1, 3, 5, 7)]
    with reading_what_was_written(title):
        if min(seed, robot) < 0:
            raise ValueError(f"seed {seed}, robot {robot}")
        return StepScene(
            title,
            key,
            *(settings, tool, shape, goal, seed, robot),
            wrist_before=None if before is None else Point(before[3], before[4]),
            wrist_start=places[0],
            wrist_end=places[1],
            attractor_start=places[2],
            attractor_end=places[3],
            call=behavior_call(row.exploratory_behavior, row.exploratory_params),
            blocked=row.status is None,
        )
