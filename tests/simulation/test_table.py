"""The true state of the table, and what sliding the tool does to the puck."""

import math
from dataclasses import replace

import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.config import Settings
from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.tool import PUCK_COLOR, Hold
from affcli.simulation.arm import reach_at
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.table import Table
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.simulation.wrist_motion import GRID, trapezoid
from tests.factories import goal_at, tool_named

SETTINGS = Settings()
WORKSPACE = SETTINGS.workspace
TOOLS = WORKSPACE.tools
RADIUS = WORKSPACE.puck.radius
tools = st.sampled_from(sorted(TOOL_PARTS))
AHEAD = Point(0.0, 1.0)
FIVE = trapezoid(5.0, WORKSPACE.motion.push_speed, WORKSPACE.motion.push_acceleration)


def table_with(tool: str) -> Table:
    table = Table(WORKSPACE, SETTINGS.physics)
    table.put_down(tool_named(tool))
    return table


def in_front(table: Table, gap: float = 0.5) -> Pose:
    """Return where the puck lies straight ahead of the tool, `gap` from it."""
    return Pose(0.25, table.wrist.y + TOOLS.handle_length + RADIUS + gap)


@pytest.mark.parametrize("tool", sorted(TOOL_PARTS))
def test_the_wrist_starts_where_it_holds_a_tool_that_lies_at_the_tables_centre(tool: str) -> None:
    """§7.1: "The tool was always placed in the center of the table"."""
    table = table_with(tool)
    assert table.wrist == table.home
    assert all((c / GRID).is_integer() for c in table.home)
    handle = table.tool.parts[0].outline
    left, near, right, far = handle.placed(table.home).bounds
    top = WORKSPACE.table
    assert 0.5 * (left + right) == pytest.approx(0.0, abs=GRID)
    assert 0.5 * (near + far) == pytest.approx(0.5 * (top.near + top.far), abs=GRID)


def test_at_the_beginning_the_arm_can_hold_the_tool_lifted_and_on_the_table() -> None:
    arm, home = WORKSPACE.arm, Table(WORKSPACE, SETTINGS.physics).home
    for height in (arm.flange_height, arm.flange_height + arm.lift_height):
        assert reach_at(arm, height).holds(home.point)


def test_at_first_the_attractor_lies_on_the_midline_and_there_is_no_goal() -> None:
    scene = table_with("stick").scene
    assert scene.attractor == Pose(0.0, WORKSPACE.layout.midline)
    assert scene.goal is None


def test_without_a_tool_on_the_table_nothing_can_be_asked_of_it() -> None:
    table = Table(WORKSPACE, SETTINGS.physics)
    with pytest.raises(LookupError, match="no tool on the table"):
        _ = table.tool
    with pytest.raises(LookupError, match="lays one out first"):
        _ = table.scene


def test_the_scene_is_the_true_state_of_the_moment() -> None:
    table = table_with("l-hook")
    table.attractor, table.wrist = Pose(1.0, 20.0, 0.5), Pose(-1.0, 11.0)
    table.goal = goal_at(3.0, 15.0)
    scene = table.scene
    assert (scene.attractor, scene.wrist) == (Pose(1.0, 20.0, 0.5), Pose(-1.0, 11.0))
    assert (scene.tool, scene.goal) == (table.tool, table.goal)
    assert scene.attractor_color == PUCK_COLOR
    table.attractor = Pose(2.0, 20.0)
    assert scene.attractor.x == 1.0
    assert table.scene.attractor.x == 2.0


@settings(deadline=None)
@given(tools, st.floats(-12.0, 12.0), st.floats(-6.0, 24.0))
def test_the_tool_comes_down_clear_when_it_would_not_overlap_the_puck(
    tool: str, dx: float, dy: float
) -> None:
    table = table_with(tool)
    wrist = table.wrist
    table.attractor = Pose(wrist.x + dx, wrist.y + dy)
    shape = shapely.union_all([shapely.Polygon(p.vertices) for p in table.tool.outlines])
    gap = shape.distance(shapely.Point(dx, dy)) - RADIUS
    if abs(gap) > 1e-9:
        assert table.clear_of_attractor(wrist) is (gap > 0.0)


def test_sliding_brings_the_wrist_to_the_end_and_the_puck_along() -> None:
    table = table_with("t-stick")
    table.attractor = before = in_front(table)
    end = Point(table.wrist.x, table.wrist.y + 5.0)
    table.slide(AHEAD, end, FIVE)
    assert table.wrist == Pose(*end)
    assert table.attractor.y - before.y == pytest.approx(4.5, abs=0.05)


@settings(deadline=None, max_examples=40)
@given(tools, st.floats(-15.0, 15.0), st.floats(0.1, 10.0))
def test_a_puck_that_is_not_touched_is_not_moved(tool: str, x: float, gap: float) -> None:
    """Untouched means unmoved, to the last bit."""
    table = table_with(tool)
    y = table.wrist.y + TOOLS.handle_length + 5.0 + RADIUS + gap
    table.attractor = puck = Pose(x, y, 0.3)
    table.slide(AHEAD, Point(table.wrist.x, table.wrist.y + 5.0), FIVE)
    assert table.attractor == puck


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(tools, st.floats(-7.0, 7.0)), min_size=1, max_size=4))
def test_a_table_used_before_gives_the_same_to_the_bit_as_a_fresh_one(
    pushes: list[tuple[str, float]],
) -> None:
    """The same inputs give the same bits, whatever was pushed before and with which tool."""
    shared = table_with("stick")
    for tool, x in pushes:
        fresh = table_with(tool)
        shared.put_down(fresh.tool)
        shared.wrist = fresh.wrist
        fresh.attractor = shared.attractor = in_front(fresh)._replace(x=x)
        for table in (shared, fresh):
            table.slide(AHEAD, Point(table.wrist.x, table.wrist.y + 5.0), FIVE)
        assert shared.attractor == fresh.attractor


def test_paint_changes_nothing_of_what_a_tool_does() -> None:
    """§7.2: a broken tool is another shape in the colour of the old one."""
    plain, painted = table_with("l-hook"), table_with("l-hook")
    painted.put_down(painted.tool.painted(tool_named("t-hook").color))
    for table in (plain, painted):
        table.attractor = in_front(table)
        table.slide(AHEAD, Point(table.wrist.x, table.wrist.y + 5.0), FIVE)
    assert plain.attractor == painted.attractor


def test_the_shape_held_decides_not_its_name() -> None:
    """A T-hook's name on a stick's shape pushes like a stick: beside the handle it misses."""
    table = table_with("stick")
    x = TOOLS.part_width / 2.0 + RADIUS + 0.5
    table.attractor = puck = in_front(table)._replace(x=x)
    table.slide(AHEAD, Point(table.wrist.x, table.wrist.y + 5.0), FIVE)
    assert table.attractor == puck
    hooked = table_with("t-hook")
    hooked.attractor = puck
    hooked.slide(AHEAD, Point(hooked.wrist.x, hooked.wrist.y + 5.0), FIVE)
    assert math.dist(hooked.attractor.point, puck.point) > 1.0


def test_tools_whose_parts_have_the_same_names_do_not_share_their_physics() -> None:
    """The second is pushed by its own outline, not by that of the first."""
    table = table_with("stick")
    thin = table.tool
    (handle,) = thin.parts
    wide = replace(thin, parts=(replace(handle, outline=ConvexPolygon.box(-3.0, -1.0, 3.0, 14.6)),))
    beside = TOOLS.part_width / 2.0 + RADIUS + 0.5
    table.attractor = puck = in_front(table)._replace(x=beside)
    start = table.wrist
    for tool, touches in ((thin, False), (wide, True), (thin, False)):
        table.put_down(tool)
        table.wrist, table.attractor = start, puck
        table.slide(AHEAD, Point(start.x, start.y + 5.0), FIVE)
        assert (table.attractor != puck) is touches


@settings(deadline=None, max_examples=40)
@given(tools, st.floats(-3.2, 3.2), st.floats(-9.0, 9.0), st.floats(-15.0, 20.0))
def test_a_turned_wrist_pushes_like_the_turned_outline(
    tool: str, angle: float, x: float, y: float
) -> None:
    """To the bit; the wrist keeps its angle."""
    turned, plain = table_with(tool), table_with(tool)
    parts = tuple(replace(p, outline=p.outline.turned(angle)) for p in plain.tool.parts)
    plain.put_down(replace(plain.tool, parts=parts))
    turned.wrist = turned.wrist._replace(angle=angle)
    puck = Pose(turned.wrist.x + x, turned.wrist.y + y)
    turned.attractor = plain.attractor = puck
    clear = turned.clear_of_attractor(turned.wrist)
    assert plain.clear_of_attractor(plain.wrist) is clear
    for table in (turned, plain) if clear else ():
        table.slide(AHEAD, Point(table.wrist.x, table.wrist.y + 5.0), FIVE)
    assert turned.attractor == plain.attractor
    assert turned.wrist == plain.wrist._replace(angle=angle)


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_a_wrist_that_is_not_turned_pushes_as_if_there_were_no_angle(zero: float) -> None:
    table, direct = (
        table_with("t-hook"),
        PushSimulator(
            tool_named("t-hook").outlines, WORKSPACE.puck, WORKSPACE.friction, SETTINGS.physics
        ),
    )
    table.wrist = table.wrist._replace(angle=zero)
    table.attractor = puck = in_front(table)
    expected = direct.push(puck, table.wrist.point, AHEAD, FIVE)
    table.slide(AHEAD, Point(table.wrist.x, table.wrist.y + 5.0), FIVE)
    assert table.attractor == expected


@pytest.mark.parametrize("tool", sorted(TOOL_PARTS))
def test_a_grasp_farther_up_the_handle_brings_the_tool_nearer_by_as_much(tool: str) -> None:
    """§5.1: the grasp "takes as a parameter the location of a single grasp point"."""
    table = table_with(tool)
    before = table.scene
    table.take(Hold(TOOLS.handle_below_grasp + 2.0))
    after = table.scene
    assert after.wrist == before.wrist
    for one, other in zip(before.tool.outlines, after.tool.outlines, strict=True):
        assert [(v.x, v.y - 2.0) for v in one.vertices] == [
            pytest.approx(tuple(v)) for v in other.vertices
        ]


def test_taken_anew_a_tool_is_held_as_the_last_grasp_says() -> None:
    """Grasps do not add up: each is told from the tool's own frame."""
    table = table_with("l-hook")
    whole = table.tool
    for point in (3.0, 0.0, 3.0):
        table.take(Hold(point, 0.5))
        assert table.tool == whole.held(Hold(point, 0.5))
    table.take(Hold(TOOLS.handle_below_grasp))
    assert table.tool == whole
