"""Can any wrist position make the tool touch a puck there: against brute force, and shapely."""

import math
from functools import cache

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.tool import ToolName
from affcli.core.workspace import Workspace
from affcli.simulation.arm import Reach, reach_at
from affcli.simulation.reach_of_tool import touchable
from affcli.simulation.tools.paper import TOOL_PARTS, paper_tools

WORKSPACE = Workspace()
ARM, RADIUS = WORKSPACE.arm, WORKSPACE.puck.radius
PAPER_REACH = reach_at(ARM, ARM.flange_height)
TOOLS = paper_tools(WORKSPACE.tools)
CLOSE_CALL = 0.05
"""Within this of the limit either answer is right (in)."""
NARROW = Reach(6.0, 15.0, -math.radians(35.0), math.radians(35.0))
DISC = Reach(0.0, 12.0, -math.radians(90.0), math.radians(90.0))
SLIT = Reach(11.0, 11.5, -math.radians(60.0), math.radians(60.0))
reaches = st.sampled_from([PAPER_REACH, PAPER_REACH, NARROW, DISC, SLIT])
names = st.sampled_from(sorted(TOOL_PARTS))


@cache
def ring(reach: Reach) -> shapely.Polygon:
    """Return all wrist positions as a polygon of many corners, 1e-4 in from the true ring."""
    bearings = np.linspace(-reach.waist_max, reach.waist_max, 721)
    rays = np.stack([-np.sin(bearings), np.cos(bearings)], axis=1)
    inner = rays[::-1] * reach.inner if reach.inner > 0.0 else np.zeros((1, 2))
    return shapely.Polygon(np.concatenate([rays * reach.outer, inner]))


@cache
def shape(name: str) -> shapely.Geometry:
    """Return a tool's outline, in the tool frame."""
    outlines = TOOLS[ToolName(name)].outlines
    return shapely.union_all([shapely.Polygon(outline.vertices) for outline in outlines])


def gap(name: str, reach: Reach, at: Point, radius: float) -> float:
    """Return how far the tool stays from the puck at best; negative: how deep it can go in."""
    turned = shapely.affinity.rotate(shape(name), 180.0, origin=(0.0, 0.0))
    wrists = shapely.affinity.translate(turned, at.x, at.y)
    return float(wrists.distance(ring(reach))) - radius


@cache
def grid(reach: Reach) -> tuple[NDArray[np.float64], float]:
    """Return wrist positions (n, 2) all over the reach, and how far any other is from one."""
    spacing = 0.25
    radii = np.linspace(reach.inner, reach.outer, 2 + int((reach.outer - reach.inner) / spacing))
    turns = 2 + int(2.0 * reach.waist_max * reach.outer / spacing)
    bearings = np.linspace(-reach.waist_max, reach.waist_max, turns)
    r, b = (axis.ravel() for axis in np.meshgrid(radii, bearings))
    return np.stack([-r * np.sin(b), r * np.cos(b)], axis=1), spacing


@st.composite
def attractors(draw: st.DrawFn) -> Point:
    """Draw a place all around, more often near the far edge of what a tool reaches."""
    far = PAPER_REACH.outer + WORKSPACE.tools.handle_length + RADIUS
    distance = draw(st.one_of(st.floats(0.0, 1.2 * far), st.floats(0.9 * far, 1.1 * far)))
    bearing = math.radians(draw(st.floats(-180.0, 180.0)))
    return Point(distance * math.sin(bearing), distance * math.cos(bearing))


def assert_answer_is_exact(name: str, reach: Reach, at: Point, radius: float) -> None:
    best = gap(name, reach, at, radius)
    if abs(best) > CLOSE_CALL:
        assert touchable(TOOLS[ToolName(name)].outlines, reach, at, radius) is (best < 0.0)


@settings(deadline=None)
@given(names, reaches, attractors(), st.floats(0.1, RADIUS))
def test_the_answer_is_that_of_exact_geometry_but_for_close_calls(
    name: str, reach: Reach, at: Point, radius: float
) -> None:
    """Out of tool reach (§6) means: no wrist position from which the tool touches. Never no where
    a touch is deeper than 0.05 in, never yes where the gap exceeds 0.05 in."""
    assert_answer_is_exact(name, reach, at, radius)


@pytest.mark.parametrize("reach", [PAPER_REACH, NARROW, DISC, SLIT])
def test_so_it_is_all_over_the_place_on_both_sides(reach: Reach) -> None:
    """The same, evenly over the disc about the robot that holds all that any tool touches."""
    rng = np.random.default_rng(0)
    far = reach.outer + math.hypot(WORKSPACE.tools.handle_length, WORKSPACE.tools.bar_reach)
    for name in sorted(TOOL_PARTS):
        for share, bearing in rng.random((80, 2)).tolist():
            distance, turn = 1.1 * far * math.sqrt(share), 2.0 * math.pi * bearing
            at = Point(distance * math.sin(turn), distance * math.cos(turn))
            assert_answer_is_exact(name, reach, at, RADIUS)


@settings(deadline=None, max_examples=40)
@given(names, reaches, attractors())
def test_the_answer_is_that_of_trying_wrist_positions_all_over_the_reach(
    name: str, reach: Reach, at: Point
) -> None:
    """The same by brute force: never no where a position tried touches deeper than 0.05 in; never
    yes where all of them stay farther off than their spacing can hide."""
    wrists, spacing = grid(reach)
    offsets = shapely.points(at.x - wrists[:, 0], at.y - wrists[:, 1])
    best = float(shapely.distance(shape(name), offsets).min()) - RADIUS
    answer = touchable(TOOLS[ToolName(name)].outlines, reach, at, RADIUS)
    if best < -CLOSE_CALL:
        assert answer
    if best > CLOSE_CALL + spacing:
        assert not answer


@settings(deadline=None)
@given(names, attractors(), st.floats(0.1, RADIUS))
def test_mirroring_table_and_tool_changes_nothing(name: str, at: Point, radius: float) -> None:
    outlines = TOOLS[ToolName(name)].outlines
    mirrored = tuple(
        ConvexPolygon(tuple(Point(-v.x, v.y) for v in reversed(outline.vertices)))
        for outline in outlines
    )
    if abs(gap(name, PAPER_REACH, at, radius)) > CLOSE_CALL:
        here = touchable(outlines, PAPER_REACH, at, radius)
        assert touchable(mirrored, PAPER_REACH, Point(-at.x, at.y), radius) is here


@settings(deadline=None)
@given(names, reaches, attractors(), st.floats(0.1, RADIUS), st.floats(0.1, RADIUS))
def test_a_bigger_puck_and_more_parts_are_no_harder_to_touch(
    name: str, reach: Reach, at: Point, one: float, other: float
) -> None:
    small, big = sorted((one, other))
    outlines = TOOLS[ToolName(name)].outlines
    if touchable(outlines[:1], reach, at, small):
        assert touchable(outlines[:1], reach, at, big)
        assert touchable(outlines, reach, at, small)


@pytest.mark.parametrize("name", sorted(TOOL_PARTS))
def test_straight_ahead_the_limit_is_arm_and_handle_and_puck(name: str) -> None:
    outlines = TOOLS[ToolName(name)].outlines
    limit = PAPER_REACH.outer + WORKSPACE.tools.handle_length + RADIUS
    assert touchable(outlines, PAPER_REACH, Point(0.0, limit - CLOSE_CALL), RADIUS)
    assert not touchable(outlines, PAPER_REACH, Point(0.0, limit + CLOSE_CALL), RADIUS)


def test_behind_the_robot_nothing_is_touched() -> None:
    below = WORKSPACE.tools.handle_below_grasp + RADIUS + CLOSE_CALL
    for outlines in (tool.outlines for tool in TOOLS.values()):
        assert not touchable(outlines, PAPER_REACH, Point(0.0, -below), RADIUS)
        assert not touchable(outlines, PAPER_REACH, Point(5.0, -below - 9.0), RADIUS)
