"""Solving a tool-using task with the affordance table: the procedure of Fig. 7 (§6.2, §7)."""

from collections.abc import Generator
from dataclasses import dataclass

from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall
from affcli.core.choice import Reason, Situation
from affcli.core.goal import Goal
from affcli.core.observation import Observation
from affcli.core.ports import Experimenter, Planner, Robot, Sensor, can_slide
from affcli.core.setting import setting
from affcli.core.trial import Outcome, StepRecord, TrialEnd
from affcli.errors import PartFailedError, SimulationDivergedError
from affcli.planning.nested_query import usable_rows
from affcli.procedures.attempt import attempt


@dataclass(frozen=True, slots=True)
class TrialLimits:
    """When a trial is given up."""

    max_steps: int = setting(
        60,
        "",
        "Steps after which the experimenter ends the trial; the paper names no limit.",
    )


def extension_of_reach(
    robot: Robot,
    sensor: Sensor,
    experimenter: Experimenter,
    table: AffordanceTable,
    binding: BehaviorCall,
    limits: TrialLimits,
    planner: Planner,
) -> Generator[StepRecord, None, TrialEnd]:
    """Bring the attractor over the goal region, one behavior at a time.

    Observe; done if the attractor is over the goal; let the planner choose a row; position the
    wrist so that the attractor stands to it as in the row's O^s; run the row's behavior; observe;
    count the use of the row and whether it replicated; again.

    The flowchart itself (Fig. 7) is lost with the paper's figures; this follows §5 and §6.2.

    Args:
        robot, sensor, experimenter: the world as the robot meets it.
        table: what the robot learned. Its counters are updated as the trial goes on (§3.2).
        binding: the binding behavior, executed once at the start.
        limits: when to give up.
        planner: chooses the rows.

    Yields:
        A record of each step, after the counters were updated.

    Returns:
        How the trial ended.
    """
    number = 1
    try:
        robot.execute(binding, None)
        seen = sensor.observe()
        goal = sensor.observe_goal()
        for number in range(1, limits.max_steps + 1):
            if goal.reached(seen):
                return TrialEnd(Outcome.SOLVED, number - 1, robot.clock)
            if experimenter.attractor_out_of_reach():
                return TrialEnd(Outcome.ATTRACTOR_OUT_OF_REACH, number - 1, robot.clock)
            step = _step(number, robot, sensor, table, seen, goal, planner)
            if isinstance(step, TrialEnd):
                return step
            yield step
            seen = step.end
        outcome = Outcome.SOLVED if goal.reached(seen) else Outcome.STEP_LIMIT
        return TrialEnd(outcome, limits.max_steps, robot.clock)
    except SimulationDivergedError:
        # Kept as a trial of its own kind, which counts neither as solved nor as failed.
        return TrialEnd(Outcome.INVALID, number - 1, robot.clock)
    except PartFailedError as error:
        # So is that of a planner, a sensor or a world of another package, with what it did.
        return TrialEnd(Outcome.INVALID, number - 1, robot.clock, (Reason(str(error)),))


def _step(
    number: int,
    robot: Robot,
    sensor: Sensor,
    table: AffordanceTable,
    seen: Observation,
    goal: Goal,
    planner: Planner,
) -> StepRecord | TrialEnd:
    """Choose a row, try it, judge it, count it; or end the trial when none is chosen."""
    slides = robot.slides if can_slide(robot) else None
    situation = Situation(table, seen, goal, robot.wrist, robot.reaches, robot.holding, slides)
    choice = planner.choose(situation)
    if choice.position is None:
        _, usable, _ = usable_rows(situation, planner.threshold)
        outcome = Outcome.NO_PLAN if len(usable) else Outcome.NO_ROW
        return TrialEnd(outcome, number - 1, robot.clock, choice.reasons)
    use = attempt(
        robot,
        sensor,
        table.row(choice.position),
        seen,
        angle_degrees=planner.angle_degrees,
        threshold=planner.threshold,
    )
    table.count_use(choice.position, success=use.replicated)
    return StepRecord(**use.by_name(), number=number, clock=robot.clock, reasons=choice.reasons)
