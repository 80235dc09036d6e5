"""A tool that turns about the wrist, and one that slides at an angle (§7.1)."""

import math
import sys
from collections.abc import Callable, Mapping

import numpy as np
import pytest

from affcli.core.geometry import Pose
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.wrist_motion import distance_of, tip_of
from tests.physics.pushes import PAPER_SHAPES, RADIUS, SHAPES, WORKSPACE, simulator
from tests.physics.quasi_static import Array, push_all
from tests.physics.test_pushing import mirrored_point, mirrored_pose, mirrored_tool
from tests.physics.turns import TurnCase, draw_slide, draw_turn, draw_turns, turned_shape

TOOLS = tuple(PAPER_SHAPES)
ANYWHERE = (*TOOLS, "bar at 35 degrees", "wedge of 50 degrees", "fork of 45 and 45 degrees")
MEDIAN, MAX = 0.05, 0.35
"""How far a puck may end from where the quasi-static solver says (in)."""


@pytest.fixture(scope="module")
def used() -> Mapping[str, PushSimulator]:
    """One simulator a shape, which the tests of this file keep using."""
    return {shape: simulator(shape) for shape in ANYWHERE}


def test_skipping_what_touches_nothing_changes_no_bit(used: Mapping[str, PushSimulator]) -> None:
    """Turns that meet the puck early, late or not at all; also in an engine that was never used."""
    rng, moved = np.random.default_rng(41), 0
    for k in range(60):
        case = draw_turn(rng, ANYWHERE[k % len(ANYWHERE)], rng.uniform(3.0, 90.0), furthest=1.4)
        end = case.end(used[case.shape])
        assert end == case.end(used[case.shape], whole=True)
        if k < len(ANYWHERE):
            assert end == case.end(simulator(case.shape))
        moved += end != case.puck
    assert 30 <= moved < 60


def test_skipping_the_way_of_a_slide_in_any_direction_changes_no_bit(
    used: Mapping[str, PushSimulator],
) -> None:
    rng = np.random.default_rng(47)
    for k in range(40):
        shape = ANYWHERE[k % len(ANYWHERE)]
        case = draw_slide(rng, shape, rng.uniform(-math.pi, math.pi), 5.0)
        way = (case.puck, case.wrist, case.direction, case.motion)
        assert used[shape].push(*way) == used[shape].push(*way, whole=True) != case.puck


def test_a_puck_that_the_tool_turns_past_stays_bit_for_bit(
    used: Mapping[str, PushSimulator],
) -> None:
    """It lies just outside of the circle of all that turns, or just where the turn ends before."""
    rng = np.random.default_rng(42)
    for shape in ANYWHERE:
        case = draw_turn(rng, shape, 60.0)
        far = max(math.hypot(*corner) for part in SHAPES[shape] for corner in part.vertices)
        around = rng.uniform(-math.pi, math.pi)
        at = far + RADIUS + 1e-6
        puck = Pose(case.wrist.x + at * math.cos(around), case.wrist.y + at * math.sin(around), 1.0)
        beside = TurnCase(shape, case.wrist, case.lever, case.arc, puck)
        for whole in (False, True):
            assert beside.end(used[shape], whole=whole) == puck


def test_mirrored_turns_end_mirrored(used: Mapping[str, PushSimulator]) -> None:
    """Within 1e-3 in and rad."""
    worst = 0.0
    for shape in ANYWHERE:
        mirror = PushSimulator(
            mirrored_tool(SHAPES[shape]), WORKSPACE.puck, WORKSPACE.friction, PhysicsSettings()
        )
        for case in draw_turns(43, 5, [shape], 30.0):
            puck, wrist = mirrored_pose(case.puck), mirrored_point(case.wrist)
            other = mirrored_pose(mirror.turn(puck, wrist, -case.lever, case.motion))
            end = case.end(used[shape])
            worst = max(worst, *(abs(a - b) for a, b in zip(end, other, strict=True)))
    sys.stdout.write(f"\nmirrored turns differ by at most {worst:.6f}\n")
    assert worst <= 1e-3


def test_no_point_of_the_tool_is_faster_than_a_push() -> None:
    """And the tip is hardly slower; the whole arc is covered to the bit."""
    for case in draw_turns(44, len(ANYWHERE), ANYWHERE, 60.0):
        ratio = tip_of(SHAPES[case.shape]) / abs(case.lever)
        top = ratio * max(stretch.speed for stretch in case.motion)
        assert 0.95 * WORKSPACE.motion.push_speed < top <= WORKSPACE.motion.push_speed
        assert distance_of(case.motion) == case.arc


def off(ends: list[Pose], right: Array) -> Array:
    """Return how far pucks ended from where the quasi-static solver says (in)."""
    shift: Array = np.array(ends) - right
    x, y = shift[:, 0], shift[:, 1]
    return np.sqrt(x * x + y * y)


def report(what: str, position: Array) -> str:
    """Return the figures in a line."""
    return (
        f"{position.size} {what}: median {np.median(position):.3f} in, "
        f"95 % {np.percentile(position, 95):.3f} in, max {position.max():.3f} in"
    )


@pytest.mark.torture
def test_turns_end_where_the_quasi_static_solver_says(
    used: Mapping[str, PushSimulator], torture: bool, tell: Callable[[str], None]
) -> None:
    """A sample of short ones; 60 of 15 to 60 degrees in the long run."""
    cases = draw_turns(45, 15, TOOLS, 10.0)
    if torture:
        angles = (15.0, 30.0, 45.0, 60.0)
        cases = [c for k, each in enumerate(angles) for c in draw_turns(46 + k, 15, TOOLS, each)]
    right = push_all([c.quasi_static for c in cases], RADIUS, WORKSPACE.friction.tool_puck)
    position = off([case.end(used[case.shape]) for case in cases], right)
    tell(report("turns", position))
    assert np.median(position) <= MEDIAN
    assert position.max() <= MAX


@pytest.mark.torture
def test_slides_at_an_angle_end_where_the_quasi_static_solver_says(
    torture: bool, tell: Callable[[str], None]
) -> None:
    """The tools held at any angle, pushed in any direction."""
    rng, cases = np.random.default_rng(51), []
    for k in range(60 if torture else 12):
        shape = turned_shape(TOOLS[k % 5], rng.uniform(-90.0, 90.0))
        direction = rng.uniform(-math.pi, math.pi)
        cases.append(draw_slide(rng, shape, direction, 5.0 if torture else 2.0))
    right = push_all([c.quasi_static for c in cases], RADIUS, WORKSPACE.friction.tool_puck)
    ends = [simulator(c.shape).push(c.puck, c.wrist, c.direction, c.motion) for c in cases]
    position = off(ends, right)
    tell(report("slides", position))
    assert np.median(position) <= MEDIAN
    assert position.max() <= MAX
