"""What holds for every push: no overlap, no ghost motion, mirrored alike, the same to the bit."""

import math
import sys
from collections.abc import Mapping

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.simulation.physics_settings import PhysicsSettings
from affcli.simulation.puck_and_tool import PuckAndTool
from affcli.simulation.pushing import PushSimulator
from tests.physics.pushes import (
    DIRECTIONS,
    RADIUS,
    SHAPES,
    WORKSPACE,
    Case,
    draw_case,
    draw_cases,
    simulator,
)

shapes = st.sampled_from(tuple(SHAPES))
directions = st.sampled_from(DIRECTIONS)
seeds = st.integers(0, 2**32 - 1)


@pytest.fixture(scope="module")
def used() -> Mapping[str, PushSimulator]:
    """One simulator a shape, which the tests of this file keep using."""
    return {shape: simulator(shape) for shape in SHAPES}


def push(case: Case, by: PushSimulator, *, whole: bool = False) -> Pose:
    """Return where a simulator leaves the puck."""
    return by.push(case.puck, case.wrist, case.direction, case.motion, whole=whole)


def mirrored_point(point: Point) -> Point:
    """Return a point mirrored at the y axis."""
    return Point(-point.x, point.y)


def mirrored_pose(pose: Pose) -> Pose:
    """Return a pose mirrored at the y axis."""
    return Pose(-pose.x, pose.y, -pose.angle)


def mirrored_tool(outlines: tuple[ConvexPolygon, ...]) -> tuple[ConvexPolygon, ...]:
    """Return convex parts mirrored at the y axis, counter-clockwise again."""
    return tuple(
        ConvexPolygon(tuple(mirrored_point(v) for v in reversed(part.vertices)))
        for part in outlines
    )


def mirrored_push(case: Case, by: PushSimulator) -> Pose:
    """Return where a simulator leaves the puck when everything is mirrored, mirrored back."""
    puck, wrist = mirrored_pose(case.puck), mirrored_point(case.wrist)
    return mirrored_pose(by.push(puck, wrist, mirrored_point(case.direction), case.motion))


def deepest_overlap(case: Case, by: PushSimulator) -> float:
    """Return the largest overlap of tool and puck at any moment of a push (in), by shapely."""
    moments: list[tuple[float, float, float]] = []

    def watch(elapsed: float, gone: float, puck: Pose) -> None:
        moments.append((gone, puck.x, puck.y))

    by.push(case.puck, case.wrist, case.direction, case.motion, watch)
    gone, x, y = np.array(moments).T
    tool = shapely.union_all([shapely.Polygon(part.vertices) for part in case.parts])
    seen = shapely.points(x - gone * case.direction.x, y - gone * case.direction.y)
    return RADIUS - float(np.min(shapely.distance(seen, tool)))


def test_tool_and_puck_overlap_by_at_most_a_hundredth_of_an_inch_at_every_moment(
    used: Mapping[str, PushSimulator],
) -> None:
    """Pushes that meet the puck at any speed, with edges, corners and two contacts."""
    cases = draw_cases(seed=31, each=6, furthest=1.9)
    deepest = max(deepest_overlap(case, used[case.shape]) for case in cases)
    sys.stdout.write(f"\n{len(cases)} pushes: overlap at most {deepest:.5f} in\n")
    assert deepest <= 0.01


@given(
    shape=shapes,
    direction=directions,
    distance=st.sampled_from((2.0, 5.0)),
    x=st.floats(-12.0, 12.0),
    y=st.floats(-6.0, 24.0),
    angle=st.floats(-10.0, 10.0),
)
@settings(max_examples=150, deadline=None)
def test_a_puck_that_the_tool_does_not_touch_stays_bit_for_bit(
    used: Mapping[str, PushSimulator],
    shape: str,
    direction: Point,
    distance: float,
    x: float,
    y: float,
    angle: float,
) -> None:
    case = Case(shape, Point(0.5, 9.25), direction, distance, Pose(0.5 + x, 9.25 + y, angle))
    swept = [
        shapely.MultiPoint(
            [*part.vertices, *part.moved(distance * direction.x, distance * direction.y).vertices]
        ).convex_hull
        for part in case.parts
    ]
    assume(shapely.union_all(swept).distance(shapely.Point(*case.puck.point)) > RADIUS + 1e-9)
    assert push(case, used[shape]) == case.puck
    assert push(case, used[shape], whole=True) == case.puck


def test_mirrored_pushes_end_mirrored(used: Mapping[str, PushSimulator]) -> None:
    """Tools whose parts are mirrored, within 1e-3 in."""
    worst = 0.0
    cases = draw_cases(seed=33, each=4, furthest=1.0)
    mirrored = {
        shape: PushSimulator(
            mirrored_tool(outlines), WORKSPACE.puck, WORKSPACE.friction, PhysicsSettings()
        )
        for shape, outlines in SHAPES.items()
    }
    for case in cases:
        end = push(case, used[case.shape])
        other = mirrored_push(case, mirrored[case.shape])
        worst = max(worst, math.dist(end.point, other.point))
        assert end.angle == pytest.approx(other.angle, abs=1e-3)
    sys.stdout.write(f"\n{len(cases)} pushes: mirrored ends differ by at most {worst:.6f} in\n")
    assert worst <= 1e-3


@pytest.mark.parametrize("shape", ["stick", "t-stick", "t-hook"])
def test_tools_that_are_their_own_mirror_image_push_alike_to_both_sides(
    used: Mapping[str, PushSimulator], shape: str
) -> None:
    for case in draw_cases(seed=34, each=6, shapes=[shape], furthest=1.0):
        end = tuple(push(case, used[shape]))
        assert end == pytest.approx(tuple(mirrored_push(case, used[shape])), abs=1e-3)


@given(shape=shapes, direction=directions, seed=seeds, gap=st.floats(0.0, 1.9))
@settings(max_examples=100, deadline=None)
def test_skipping_the_steps_before_contact_changes_no_bit(
    used: Mapping[str, PushSimulator], shape: str, direction: Point, seed: int, gap: float
) -> None:
    case = draw_case(np.random.default_rng(seed), shape, direction, 5.0, gap)
    assert push(case, used[shape]) == push(case, used[shape], whole=True)


def test_what_fades_in_the_engine_beyond_counting_leaves_no_angle(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The engine forgets impulses by squaring them: of some 1e-165 something is left."""
    told = PuckAndTool.puck_pose
    case = draw_case(np.random.default_rng(0), "t-hook", DIRECTIONS[0])
    moved = push(case, simulator("t-hook"))
    assert moved != case.puck
    monkeypatch.setattr(PuckAndTool, "puck_pose", lambda self: told(self)._replace(angle=7e-321))
    left = push(case, simulator("t-hook"))
    assert (left.x, left.y, left.angle) == (moved.x, moved.y, 0.0)


@given(shape=shapes, direction=directions, seed=seeds, history=st.lists(seeds, max_size=3))
@settings(max_examples=60, deadline=None)
def test_what_a_simulator_did_before_changes_no_bit(
    shape: str, direction: Point, seed: int, history: list[int]
) -> None:
    before = simulator(shape)
    for other in history:
        rng = np.random.default_rng(other)
        push(draw_case(rng, shape, DIRECTIONS[other % 4]), before)
    case = draw_case(np.random.default_rng(seed), shape, direction)
    assert push(case, before) == push(case, simulator(shape))


@pytest.mark.parametrize("shape", tuple(SHAPES))
def test_a_push_that_begins_in_the_contact_in_which_the_last_one_ended_has_the_same_bits(
    shape: str,
) -> None:
    """The engine keeps the impulses of contacts and joints from step to step; a push must not."""
    rng = np.random.default_rng(36)
    for case in (draw_case(rng, shape, d) for d in DIRECTIONS for _ in range(5)):
        going_on = simulator(shape)
        puck, wrist = case.puck, case.wrist
        for _ in range(3):
            follow = Case(shape, wrist, case.direction, 5.0, puck)
            puck = push(follow, going_on)
            assert puck == push(follow, simulator(shape))
            assert puck == push(follow, simulator(shape), whole=True)
            wrist = Point(wrist.x + 5.0 * case.direction.x, wrist.y + 5.0 * case.direction.y)
