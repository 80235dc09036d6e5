"""What a stored step was: enough to lay the table out again as it was then."""

from dataclasses import dataclass

import sqlalchemy as sa

from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.errors import UsageError
from affcli.store.connection import Connected
from affcli.store.mapping import behavior_call, reading_what_was_written
from affcli.store.tables import affordance, learning_run, step, trial


@dataclass(frozen=True, slots=True)
class StepScene:
    """One step of a trial as it truly was.

    Args:
        settings: of the learning run, as canonical JSON.
        tool, shape: what the robot believed to hold and what it held.
        goal, start, seed, robot: which trial.
        number, steps: which step of how many.
        wrist_before: where the wrist was when the step began; None for the trial's first step.
        wrist_start, wrist_end: where it was before and after the exploratory behavior; when the
            tool could not be lowered, before and after it was carried there.
        attractor_start, attractor_end: where the attractor truly was before and after.
        call: the exploratory behavior.
        blocked: the tool could not be lowered, so it was not executed.
    """

    settings: str
    tool: str
    shape: str
    goal: int
    start: int
    seed: int
    robot: int
    number: int
    steps: int
    wrist_before: Point | None
    wrist_start: Point
    wrist_end: Point
    attractor_start: Point
    attractor_end: Point
    call: BehaviorCall
    blocked: bool


class Scenes(Connected):
    """The part of the store that tells what a step looked like."""

    def step_scene(self, trial_id: int, number: int) -> StepScene:
        """Return one step of a trial.

        Raises:
            UsageError: no such trial, or no such step in it.
        """
        t, s, r, a = trial.c, step.c, learning_run.c, affordance.c
        about = (
            sa.select(r.settings, t.tool, t.shape, t.goal, t.start, t.seed, t.robot)
            .select_from(trial.join(learning_run, r.id == t.learning_run_id))
            .where(t.id == trial_id)
        )
        taken = (
            sa.select(
                *(s.number, s.wrist_start_x, s.wrist_start_y, s.wrist_end_x, s.wrist_end_y),
                *(s.true_start_x, s.true_start_y, s.true_end_x, s.true_end_y, s.status),
                *(a.exploratory_behavior, a.exploratory_params),
            )
            .select_from(step.join(affordance, a.id == s.affordance_id))
            .where(s.trial_id == trial_id)
            .order_by(s.number)
        )
        with self.reading() as connection:
            trial_row = connection.execute(about).first()
            last = connection.execute(sa.select(sa.func.max(t.id))).scalar()
            rows = connection.execute(taken).all()
        if trial_row is None:
            known = (
                f"trials are 1 to {last}" if last else "there are no trials; `affcli solve` does"
            )
            raise UsageError(f"no trial {trial_id}; {known}")
        row = next((row for row in rows if row.number == number), None)
        if row is None:
            raise UsageError(f"no step {number} in trial {trial_id}; it has steps 1 to {len(rows)}")
        before = next((row for row in rows if row.number == number - 1), None)
        with reading_what_was_written(f"step {number} of trial {trial_id}"):
            return StepScene(
                *trial_row,
                number=number,
                steps=len(rows),
                wrist_before=None if before is None else Point(*before[3:5]),
                wrist_start=Point(*row[1:3]),
                wrist_end=Point(*row[3:5]),
                attractor_start=Point(*row[5:7]),
                attractor_end=Point(*row[7:9]),
                call=behavior_call(row.exploratory_behavior, row.exploratory_params),
                blocked=row.status is None,
            )
