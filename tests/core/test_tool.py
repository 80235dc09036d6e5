"""Tools by value, and how they are held (§5.1)."""

import json
import math
from collections.abc import Iterable

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from affcli.analysis.regions import region_at
from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.tool import (
    Hold,
    Tool,
    hold_of,
    middle_x,
    placed_parts,
    tool_from_canonical,
    turned_outlines,
    unknown_tool,
)
from affcli.core.workspace import ToolGeometry
from affcli.simulation.tools.paper import paper_tools
from tests.factories import BINDING

GEOMETRY = ToolGeometry()
PAPER_HOLD = Hold(GEOMETRY.handle_below_grasp)
tools = st.sampled_from(sorted(paper_tools(GEOMETRY).values(), key=lambda tool: tool.name))
holds = st.builds(Hold, st.floats(0.0, 15.0), st.floats(-math.pi, math.pi))
poses = st.builds(Pose, st.floats(-20.0, 20.0), st.floats(0.0, 30.0), st.floats(-7.0, 7.0))


def shapes(outlines: Iterable[ConvexPolygon]) -> shapely.MultiPolygon:
    """Return outlines as shapely has them; not as their union, for turned ones hardly touch."""
    return shapely.MultiPolygon([shapely.Polygon(outline.vertices) for outline in outlines])


def assert_same(one: shapely.MultiPolygon, other: shapely.MultiPolygon) -> None:
    assert len(one.geoms) == len(other.geoms)
    for a, b in zip(one.geoms, other.geoms, strict=True):
        assert a.symmetric_difference(b).area == pytest.approx(0.0, abs=1e-9)


@given(tools, holds)
def test_a_tool_is_the_same_after_its_canonical_form(tool: Tool, hold: Hold) -> None:
    held = tool.held(hold)
    again = tool_from_canonical(json.loads(json.dumps(held.canonical())))
    assert again == held
    assert again.key == held.key


@given(tools, holds)
def test_a_hold_moves_the_tool_along_the_handle_and_then_turns_it(tool: Tool, hold: Hold) -> None:
    """A grasp farther up brings the tool nearer to the robot, by as much."""
    lower_end = shapes(tool.outlines).bounds[1]
    moved = shapely.affinity.translate(shapes(tool.outlines), 0.0, -lower_end - hold.grasp_point)
    turned = shapely.affinity.rotate(moved, hold.angle, origin=(0.0, 0.0), use_radians=True)
    assert_same(shapes(tool.held(hold).outlines), turned)


@pytest.mark.parametrize("tool", paper_tools(GEOMETRY).values(), ids=lambda tool: tool.name)
def test_the_paper_s_own_grasp_leaves_the_tool_frame_as_it_is(tool: Tool) -> None:
    assert tool.held(PAPER_HOLD) is tool


@given(tools, st.floats(-7.0, 7.0))
def test_outlines_turn_about_the_wrist(tool: Tool, angle: float) -> None:
    turned = shapes(turned_outlines(tool.outlines, angle))
    assert_same(
        turned,
        shapely.affinity.rotate(shapes(tool.outlines), angle, origin=(0.0, 0.0), use_radians=True),
    )


def test_outlines_turned_by_nothing_are_the_same_to_the_bit() -> None:
    for tool in paper_tools(GEOMETRY).values():
        assert turned_outlines(tool.outlines, 0.0) == tool.outlines


@given(tools, poses)
def test_parts_lie_on_the_table_where_the_wrist_s_pose_puts_them(tool: Tool, wrist: Pose) -> None:
    placed = placed_parts(tool.parts, wrist)
    turned = shapely.affinity.rotate(
        shapes(tool.outlines), wrist.angle, origin=(0.0, 0.0), use_radians=True
    )
    lies = shapes(part.outline for part in placed)
    assert_same(lies, shapely.affinity.translate(turned, wrist.x, wrist.y))
    assert [part.name for part in placed] == [part.name for part in tool.parts]


@given(tools, st.floats(-10.0, 10.0), st.floats(-5.0, 20.0))
def test_the_region_is_the_part_that_no_other_is_nearer_than(
    tool: Tool, x: float, y: float
) -> None:
    region = region_at(tool, BINDING, 0.0, Point(x, y))
    distances = {
        part.name: shapely.Polygon(part.outline.vertices).distance(shapely.Point(x, y))
        for part in tool.held(hold_of(BINDING)).parts
    }
    assert distances[region] == pytest.approx(min(distances.values()), abs=1e-9)


def test_a_tool_of_which_only_the_name_is_known_has_no_parts() -> None:
    tool = unknown_tool("rake")
    assert (tool.name, tool.parts, tool.outlines) == ("rake", (), ())
    assert middle_x(tool.parts) == 0.0
