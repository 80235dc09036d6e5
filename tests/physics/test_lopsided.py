"""A puck whose centre of mass lies off its middle (§8)."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from affcli.core.geometry import Point, Pose
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.pushing import PushSimulator
from tests.physics.pushes import (
    BACK,
    DIRECTIONS,
    LEFT,
    PAPER_SHAPES,
    RADIUS,
    SHAPES,
    WORKSPACE,
    Case,
    draw_case,
    draw_cases,
)
from tests.physics.quasi_static import contact_law, push_all, uneven_law
from tests.physics.test_turning import MAX, MEDIAN, off, report

FRICTION = WORKSPACE.friction.tool_puck
SHAPES_PUSHED = (*PAPER_SHAPES, "bar at 35 degrees")


def simulator(shape: str, offset: float, degrees: float = 0.0) -> PushSimulator:
    """Return a simulator of a shape and a puck with its heavy side in some direction."""
    puck = replace(WORKSPACE.puck, mass_offset=offset, mass_direction_degrees=degrees)
    return PushSimulator(SHAPES[shape], puck, WORKSPACE.friction, PhysicsSettings())


def pushed(case: Case, by: PushSimulator, *, whole: bool = False) -> Pose:
    """Return where a simulator leaves the puck."""
    return by.push(case.puck, case.wrist, case.direction, case.motion, whole=whole)


def test_the_law_of_an_uneven_pressure_ends_in_that_of_an_even_one() -> None:
    """Found in two ways: by the closed form and by least power."""
    even, almost = contact_law(FRICTION), uneven_law(FRICTION, 1e-9)
    assert np.abs(almost.aside - almost.force).max() < 1e-6
    for table, other in ((almost.rim, even.rim), (almost.turning, even.turning)):
        assert np.abs(table - np.interp(almost.force, even.force, other)).max() < 5e-3


@pytest.mark.torture
def test_pushes_of_a_lopsided_puck_end_where_the_quasi_static_solver_says(
    torture: bool, tell: Callable[[str], None]
) -> None:
    """A sample of short ones; 120 of 5 in with two centres of mass in the long run."""
    told = []
    for offset in (0.2, 1.0 / 3.0) if torture else (1.0 / 3.0,):
        cases = draw_cases(61, 5 if torture else 1, shapes=SHAPES_PUSHED)
        if not torture:
            cases = [replace(case, distance=1.5) for case in cases]
        by = {shape: simulator(shape, offset) for shape in SHAPES_PUSHED}
        ends = [pushed(case, by[case.shape]) for case in cases]
        right = push_all([c.quasi_static for c in cases], RADIUS, FRICTION, offset=offset)
        position = off(ends, right)
        told.append(report(f"pushes, centre of mass off by {offset:.2f} R", position))
        assert np.median(position) <= MEDIAN
        assert position.max() <= MAX
    tell("; ".join(told))


def test_a_lopsided_puck_turns_its_heavy_side_back() -> None:
    """Pushed left by a straight edge it turns until its heavy side trails."""
    by = simulator("stick", 0.3)
    at = Point(-RADIUS - 0.5 * WORKSPACE.tools.part_width, 8.0)
    wrist = Point(6.0, 10.0)
    for heavy in (1.5, -1.5):
        puck = Pose(wrist.x + at.x, wrist.y + at.y, heavy)
        end = pushed(Case("stick", wrist, LEFT, 5.0, puck), by)
        assert abs(end.angle) < abs(heavy) - 0.3
        assert math.copysign(1.0, end.angle) == math.copysign(1.0, heavy)


def test_where_the_heavy_side_is_counts_as_the_puck_s_angle_does() -> None:
    """To a hair: its twelve points lie otherwise."""
    case = draw_case(np.random.default_rng(62), "t-hook", BACK)
    turned = replace(case, puck=Pose(*case.puck.point, case.puck.angle + math.radians(40.0)))
    one = pushed(case, simulator("t-hook", 0.3, 40.0))
    other = pushed(turned, simulator("t-hook", 0.3))
    assert math.dist(one.point, other.point) < 0.02
    assert other.angle - one.angle == pytest.approx(math.radians(40.0), abs=0.02)


@pytest.mark.parametrize("shape", ["stick", "l-hook"])
def test_the_same_push_has_the_same_bits_skipped_or_not_and_whatever_came_before(
    shape: str,
) -> None:
    rng, used = np.random.default_rng(63), simulator(shape, 0.25, 70.0)
    for direction in DIRECTIONS:
        case = draw_case(rng, shape, direction, gap=0.7)
        end = pushed(case, used)
        assert end == pushed(case, used, whole=True) == pushed(case, simulator(shape, 0.25, 70.0))
        away = Case(shape, case.wrist, direction, 5.0, Pose(90.0, 0.0, 0.3))
        assert pushed(away, used, whole=True) == away.puck
