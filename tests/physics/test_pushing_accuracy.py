"""Pushes end where the quasi-static solver says, and two contacts where geometry says (§4, §5)."""

import math
import sys

import numpy as np
import pytest

from affcli.core.geometry import Point, Pose
from tests.physics.pushes import (
    AHEAD,
    BACK,
    FORK_ANGLES,
    FORKS,
    INCLINED_SHAPES,
    LEFT,
    PAPER_SHAPES,
    RADIUS,
    RIGHT,
    WORKSPACE,
    Case,
    draw_case,
    draw_cases,
    seat,
    simulator,
)
from tests.physics.quasi_static import Array, push_all

WRIST = Point(1.0, 10.0)
TOOLS = WORKSPACE.tools
UNDER_BAR = TOOLS.handle_length - TOOLS.part_width - RADIUS
"""y, in the tool frame, of a puck that touches a bar from below."""
IN_HOOK = TOOLS.bar_reach - TOOLS.part_width - RADIUS
"""|x|, in the tool frame, of a puck that touches a hook from inside."""
AT_HANDLE = TOOLS.part_width / 2.0 + RADIUS
"""|x|, in the tool frame, of a puck that touches the handle."""


def simulated(cases: list[Case]) -> Array:
    """Return where the simulation leaves the puck: (N, 3) array of x, y (in), angle (rad)."""
    simulators = {shape: simulator(shape) for shape in {case.shape for case in cases}}
    ends = [
        simulators[case.shape].push(case.puck, case.wrist, case.direction, case.motion)
        for case in cases
    ]
    return np.array(ends)


def errors(cases: list[Case]) -> tuple[Array, Array]:
    """Return how far the simulation is off in position (in) and in angle (degrees)."""
    right = push_all([case.quasi_static for case in cases], RADIUS, WORKSPACE.friction.tool_puck)
    off = simulated(cases) - right
    return np.hypot(off[:, 0], off[:, 1]), np.abs(np.degrees(off[:, 2]))


def report(what: str, position: Array, angle: Array) -> None:
    """Write the figures; pytest -s shows them."""
    sys.stdout.write(
        f"\n{position.size} pushes of 5 in at 5 in/s, {what}: "
        f"median {np.median(position):.3f} in, 95 % {np.percentile(position, 95):.3f} in, "
        f"max {position.max():.3f} in; median {np.median(angle):.1f}, max {angle.max():.1f} deg\n"
    )


@pytest.mark.parametrize(
    ("what", "shapes", "seed"),
    [("the five tools", tuple(PAPER_SHAPES), 21), ("inclined edges", tuple(INCLINED_SHAPES), 22)],
)
def test_pushes_end_where_the_quasi_static_solver_says(
    what: str, shapes: tuple[str, ...], seed: int
) -> None:
    """Edges and corners, all four directions: median within 0.02 in, all within 0.22 in."""
    position, angle = errors(draw_cases(seed, each=6, shapes=shapes))
    report(what, position, angle)
    assert position.size >= 60
    assert np.median(position) <= 0.02
    assert position.max() <= 0.22


def test_pushes_with_two_contacts_end_where_the_quasi_static_solver_says() -> None:
    """Forks catch the puck at first with one of their bars, often with the outer corner."""
    rng = np.random.default_rng(23)
    position, angle = errors([draw_case(rng, shape, AHEAD) for shape in FORKS for _ in range(15)])
    report("forks", position, angle)
    assert position.size >= 60
    assert np.median(position) <= 0.02
    assert position.max() <= 0.22


@pytest.mark.parametrize("angles", FORK_ANGLES)
def test_a_puck_held_by_two_inclined_bars_goes_where_they_go(angles: tuple[float, float]) -> None:
    left, right = angles
    shape = f"fork of {left:.0f} and {right:.0f} degrees"
    at = seat(left, right)
    puck = Pose(WRIST.x + at.x, WRIST.y + at.y, 0.4)
    end = simulated([Case(shape, WRIST, AHEAD, 5.0, puck)])[0]
    assert end[:2] == pytest.approx([puck.x, puck.y + 5.0], abs=0.01)
    assert end[2] == pytest.approx(puck.angle, abs=math.radians(1.0))


@pytest.mark.parametrize(
    ("shape", "x", "direction"),
    [
        pytest.param("t-hook", -IN_HOOK, BACK, id="left hook of the t-hook, contract"),
        pytest.param("t-hook", IN_HOOK, BACK, id="right hook of the t-hook, contract"),
        pytest.param("t-hook", -IN_HOOK, RIGHT, id="left hook of the t-hook, slide right"),
        pytest.param("t-hook", IN_HOOK, LEFT, id="right hook of the t-hook, slide left"),
        pytest.param("l-hook", -IN_HOOK, BACK, id="hook of the l-hook, contract"),
        pytest.param("t-stick", AT_HANDLE, BACK, id="right of the handle, contract"),
        pytest.param("t-stick", AT_HANDLE, RIGHT, id="right of the handle, slide right"),
        pytest.param("l-stick", -AT_HANDLE, BACK, id="left of the handle, contract"),
        pytest.param("l-stick", -AT_HANDLE, LEFT, id="left of the handle, slide left"),
    ],
)
def test_a_puck_in_an_inner_corner_of_the_tool_goes_where_the_tool_goes(
    shape: str, x: float, direction: Point
) -> None:
    """Within 0.02 in and a degree, however the puck was turned before."""
    by = simulator(shape)
    for angle in np.linspace(-1.0, 1.0, 9):
        case = Case(shape, WRIST, direction, 5.0, Pose(WRIST.x + x, WRIST.y + UNDER_BAR, angle))
        end = by.push(case.puck, WRIST, direction, case.motion)
        goes = Point(case.puck.x + 5.0 * direction.x, case.puck.y + 5.0 * direction.y)
        assert math.dist(end.point, goes) <= 0.02
        assert end.angle == pytest.approx(angle, abs=math.radians(1.0))


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("below", [0.5, 2.0, 4.0])
def test_contract_brings_a_puck_anywhere_between_hook_and_handle_to_the_bar(
    side: float, below: float
) -> None:
    x = side * 0.5 * (IN_HOOK + AT_HANDLE)
    puck = Pose(WRIST.x + x, WRIST.y + UNDER_BAR - below)
    end = simulated([Case("t-hook", WRIST, BACK, 5.0, puck)])[0]
    assert end == pytest.approx([puck.x, WRIST.y + UNDER_BAR - 5.0, 0.0], abs=0.01)
