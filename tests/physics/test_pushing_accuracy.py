"""Pushes end where the quasi-static solver says, and two contacts where geometry says (§4, §5)."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from affcli.core.geometry import Point, Pose
from affcli.simulation.wrist_motion import STAIR, trapezoid
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

FAST, SLOW = WORKSPACE.motion.push_speed, 1.25
"""In a push the puck's inertia takes it further, by the square of its speed: 5 in/s as in a robot's
pushes, and so slow that it hardly does (in/s). The solver has none."""
WRIST = Point(1.0, 10.0)
TOOLS = WORKSPACE.tools
UNDER_BAR = TOOLS.handle_length - TOOLS.part_width - RADIUS
"""y, in the tool frame, of a puck that touches a bar from below."""
IN_HOOK = TOOLS.bar_reach - TOOLS.part_width - RADIUS
"""|x|, in the tool frame, of a puck that touches a hook from inside."""
AT_HANDLE = TOOLS.part_width / 2.0 + RADIUS
"""|x|, in the tool frame, of a puck that touches the handle."""


def simulated(cases: list[Case], speed: float = FAST, *, simply: bool = False) -> Array:
    """Return where the simulation leaves the puck: (N, 3) array of x, y (in), angle (rad).

    Args:
        cases: the pushes.
        speed: of the tool, which it reaches as soon after as far (in/s).
        simply: in steps of 1/2048 s all along, and its speed changes at each short step.
    """
    simulators = {shape: simulator(shape) for shape in {case.shape for case in cases}}
    gain = WORKSPACE.motion.push_acceleration * (speed / FAST) ** 2
    ends = []
    for case in cases:
        motion = trapezoid(case.distance, speed, gain, 1 if simply else STAIR)
        way = (case.puck, case.wrist, case.direction, motion)
        ends.append(simulators[case.shape].push(*way, finer=4 if simply else 0))
    return np.array(ends)


def errors(cases: list[Case], speed: float) -> tuple[Array, Array]:
    """Return how far the simulation is off in position (in) and in angle (degrees)."""
    right = push_all([case.quasi_static for case in cases], RADIUS, WORKSPACE.friction.tool_puck)
    return apart(simulated(cases, speed), right)


def apart(these: Array, those: Array) -> tuple[Array, Array]:
    """Return how far ends are apart in position (in) and in angle (degrees)."""
    off = these - those
    return np.hypot(off[:, 0], off[:, 1]), np.abs(np.degrees(off[:, 2]))


def figures(what: str, position: Array, angle: Array) -> str:
    """Return the figures in a line."""
    return (
        f"{what}: {np.median(position):.3f} | {np.percentile(position, 95):.3f} | "
        f"{position.max():.3f} in; {np.median(angle):.1f}, {angle.max():.1f} degrees"
    )


def fork_cases() -> list[Case]:
    """Return pushes of forks: they catch the puck at first with one of their bars, often with the
    outer corner.
    """
    rng = np.random.default_rng(23)
    return [draw_case(rng, shape, AHEAD) for shape in FORKS for _ in range(15)]


PUSHES: dict[str, list[Case]] = {
    "five tools": draw_cases(21, each=6, shapes=tuple(PAPER_SHAPES)),
    "inclined": draw_cases(22, each=6, shapes=tuple(INCLINED_SHAPES)),
    "forks": fork_cases(),
}
BOUNDS: dict[float, tuple[float, float, float, float]] = {
    FAST: (0.02, 0.35, 3.0, 8.0),
    SLOW: (0.02, 0.05, 3.0, 8.0),
}
"""What the median and the largest may be: off in position (in), turned wrong (degrees)."""


@pytest.mark.parametrize("speed", [FAST, SLOW])
@pytest.mark.parametrize("what", list(PUSHES))
def test_pushes_end_where_the_quasi_static_solver_says(
    what: str, speed: float, tell: Callable[[str], None]
) -> None:
    """Edges and corners, all four directions, one contact and two."""
    position, angle = errors(PUSHES[what], speed)
    tell(figures(f"{position.size} pushes of 5 in at {speed} in/s, {what}", position, angle))
    median, most, turned, turned_most = BOUNDS[speed]
    assert position.size >= 60
    assert np.median(position) <= median
    assert position.max() <= most
    assert np.median(angle) <= turned
    assert angle.max() <= turned_most


def test_what_the_solver_does_not_have_is_inertia() -> None:
    """It grows with the square of the speed: at half of it, it is a quarter, within a quarter."""
    cases = PUSHES["five tools"]
    worst = [float(errors(cases, speed)[0].max()) for speed in (FAST, FAST / 2.0)]
    assert worst[1] == pytest.approx(worst[0] / 4.0, rel=0.25)


def test_strides_end_where_simple_steps_of_a_2048th_of_a_second_end(
    tell: Callable[[str], None],
) -> None:
    """99 % within 0.01 in, all within 0.02 in and 3 degrees."""
    cases = [case for some in PUSHES.values() for case in some]
    position, angle = apart(simulated(cases), simulated(cases, simply=True))
    most = float(np.percentile(position, 99))
    tell(f"{figures('strides and simple steps', position, angle)}; 99 % within {most:.4f} in")
    assert most <= 0.01
    assert position.max() <= 0.02
    assert angle.max() <= 3.0


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
