"""Goal regions and starts of the extension-of-reach tasks (§7.1, Fig. 8)."""

import math
from itertools import pairwise

import pytest

from affcli.core.geometry import Point
from affcli.core.task import GoalRegion
from affcli.core.workspace import Workspace
from affcli.simulation.arm import reach_at
from affcli.simulation.tasks.extension_of_reach import goal_regions, start_positions

WORKSPACE = Workspace()
LAYOUT, TABLE = WORKSPACE.layout, WORKSPACE.table
GOALS = goal_regions(LAYOUT)
STARTS = start_positions(LAYOUT)
ARM_REACH = reach_at(WORKSPACE.arm, WORKSPACE.arm.flange_height).outer


def test_there_are_four_goals_and_four_starts() -> None:
    """§7.1: "4 goals x 4 attractor positions x 5 tools"."""
    assert tuple(GOALS) == ("1", "2", "3", "4")
    assert tuple(STARTS) == ("1", "2", "3", "4")
    assert all(goal.name == name for name, goal in GOALS.items())


def test_starts_lie_on_the_mid_line_6_inches_apart_with_the_robot_in_the_middle() -> None:
    """§7.1: "located along the mid-line of the table, 6 inches apart"."""
    assert {start.y for start in STARTS.values()} == {LAYOUT.midline}
    assert [b.x - a.x for a, b in pairwise(STARTS.values())] == [6.0, 6.0, 6.0]
    assert sum(start.x for start in STARTS.values()) == 0.0


def test_goal_1_is_near_goal_2_is_far_goals_3_and_4_lie_on_the_mid_line_to_the_sides() -> None:
    """§7.1, Figs. 1, 2 and 8."""
    one, two, three, four = (goal.center for goal in GOALS.values())
    assert one.x == two.x == 0.0
    assert one.y < LAYOUT.midline < two.y
    assert three.y == four.y == LAYOUT.midline
    assert three.x == -four.x < 0.0


@pytest.mark.parametrize("start", STARTS.values(), ids=list(STARTS))
def test_every_start_lies_beyond_the_bare_arm(start: Point) -> None:
    """Fig. 8: the starts lie outside "the robot's sphere of reach when it is not holding any
    tool"."""
    assert math.hypot(*start) > ARM_REACH


@pytest.mark.parametrize("place", [*STARTS.values(), *(g.center for g in GOALS.values())])
def test_starts_and_goals_lie_on_the_table(place: Point) -> None:
    assert abs(place.x) <= TABLE.half_width
    assert TABLE.near <= place.y <= TABLE.far


@pytest.mark.parametrize("goal", GOALS.values())
def test_no_start_lies_over_a_goal(goal: GoalRegion) -> None:
    assert not any(goal.contains(start) for start in STARTS.values())
