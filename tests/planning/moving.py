"""Rows that move the attractor as far as the wrist goes, and a robot that stands before them."""

from collections.abc import Callable
from dataclasses import replace

from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.choice import Choice, Situation
from affcli.core.geometry import Point, Pose
from affcli.core.task import GoalRegion
from tests.factories import affordance, observation, situation
from tests.fakes import FakeRobot, FakeTable, everywhere

HERE = Point(0.0, 0.0)
RIGHT, LEFT, AWAY = (5.0, 0.0), (-5.0, 0.0), (0.0, 5.0)


def row(
    step: int,
    moved: tuple[float, float],
    offset: Point = HERE,
    *,
    used: int = 1,
    successful: int = 1,
) -> Affordance:
    """Return a row whose wrist goes as far as it moves the attractor."""
    made = affordance(step, moved=moved, offset=offset, used=used, successful=successful)
    return replace(made, travel=Point(*moved))


def standing(
    rows: list[Affordance],
    goal: GoalRegion,
    reachable: Callable[[Point], bool] = everywhere,
    wrist: Point = HERE,
) -> Situation:
    """Return a robot whose attractor lies at (0, 0)."""
    robot = FakeRobot(FakeTable(wrist=Pose(*wrist)), reachable=reachable)
    return situation(AffordanceTable(rows), observation(HERE, wrist=HERE), goal, robot)


def steps_of(choice: Choice) -> list[int]:
    """Return the rows of the plan that is followed, by the steps that made them."""
    plans = [reason for reason in choice.reasons if reason.moves]
    return [move.step for move in plans[0].moves]
