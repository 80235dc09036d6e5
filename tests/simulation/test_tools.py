"""The five tools by their parts and colours (§4, Figs. 1 and 9)."""

import math
from itertools import combinations

import pytest
import shapely

from affcli import registry
from affcli.core.affordance_table import COLOR_TOLERANCE
from affcli.core.geometry import Point
from affcli.core.tool import PUCK_COLOR, Color, Tool, ToolName
from affcli.core.workspace import Workspace
from affcli.simulation.tools.paper import TOOL_COLORS, TOOL_PARTS, paper_tools

GEOMETRY = Workspace().tools
TOOLS = paper_tools(GEOMETRY)
GRASP_POINT = Point(0.0, 0.0)
"""The origin of the tool frame."""
every_tool = pytest.mark.parametrize("tool", TOOLS.values(), ids=list(TOOLS))


def outline_of(tool: Tool) -> shapely.Geometry:
    return shapely.union_all([shapely.Polygon(outline.vertices) for outline in tool.outlines])


def test_there_are_the_five_tools_in_the_order_of_the_results_table() -> None:
    """§4: "stick, L-stick, L-hook, T-stick, and T-hook"."""
    assert list(TOOLS) == ["stick", "l-stick", "l-hook", "t-stick", "t-hook"]
    assert [tool.name for tool in TOOLS.values()] == list(TOOLS)
    assert list(TOOL_COLORS) == list(TOOL_PARTS) == list(TOOLS)


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("stick", {"handle"}),
        ("l-stick", {"handle", "left bar"}),
        ("l-hook", {"handle", "left bar", "left hook"}),
        ("t-stick", {"handle", "left bar", "right bar"}),
        ("t-hook", {"handle", "left bar", "right bar", "left hook", "right hook"}),
    ],
)
def test_each_tool_has_the_parts_of_its_name(name: str, parts: set[str]) -> None:
    tool = TOOLS[ToolName(name)]
    assert {part.name for part in tool.parts} == parts
    assert len(tool.parts) == len(parts)


def test_a_part_of_one_name_is_the_same_in_every_tool() -> None:
    outlines = {(part.name, part.outline) for tool in TOOLS.values() for part in tool.parts}
    assert len(outlines) == len({name for name, _ in outlines}) == 5


@every_tool
def test_the_parts_are_convex_and_counter_clockwise_and_do_not_overlap(tool: Tool) -> None:
    for outline in tool.outlines:
        polygon = shapely.Polygon(outline.vertices)
        assert outline.area > 0.0
        assert polygon.convex_hull.area == pytest.approx(outline.area)
    areas = sum(outline.area for outline in tool.outlines)
    assert areas == pytest.approx(outline_of(tool).area)


@every_tool
def test_a_tool_is_in_one_piece(tool: Tool) -> None:
    assert outline_of(tool).geom_type == "Polygon"


@every_tool
def test_a_tool_is_as_large_as_the_geometry_says(tool: Tool) -> None:
    left, bottom, right, top = outline_of(tool).bounds
    names = {part.name for part in tool.parts}
    half = GEOMETRY.part_width / 2.0
    assert top == GEOMETRY.handle_length
    assert bottom == -GEOMETRY.handle_below_grasp
    assert -left == (GEOMETRY.bar_reach if "left bar" in names else half)
    assert right == (GEOMETRY.bar_reach if "right bar" in names else half)


def test_hooks_hang_from_the_outer_ends_of_the_bars_back_toward_the_robot() -> None:
    parts = {part.name: part.outline for part in TOOLS[ToolName("t-hook")].parts}
    left, bottom, right, top = parts["left hook"].bounds
    assert left == parts["left bar"].bounds[0]
    assert right - left == pytest.approx(GEOMETRY.part_width)
    assert top == parts["left bar"].bounds[1]
    assert bottom == pytest.approx(GEOMETRY.handle_length - GEOMETRY.hook_length)


@pytest.mark.parametrize("name", ["stick", "t-stick", "t-hook"])
def test_symmetric_tools_are_their_own_mirror_image(name: str) -> None:
    outline = outline_of(TOOLS[ToolName(name)])
    mirrored = shapely.affinity.scale(outline, xfact=-1.0, origin=(0.0, 0.0))
    assert outline.symmetric_difference(mirrored).area == pytest.approx(0.0, abs=1e-9)


@every_tool
def test_the_grasp_point_lies_on_the_lower_part_of_the_handle(tool: Tool) -> None:
    """§5.1: "a single grasp point located at the lower part of the tool's handle"."""
    handle = next(part.outline for part in tool.parts if part.name == "handle")
    assert handle.distance(GRASP_POINT) == 0.0
    middle = 0.5 * (handle.bounds[1] + handle.bounds[3])
    assert GRASP_POINT.y < middle


def test_a_t_hook_without_its_right_bar_and_right_hook_is_the_l_hook() -> None:
    """§7.2, Fig. 9: "A T-hook missing its right hook is equivalent to an L-hook"."""
    t_hook, l_hook = TOOLS[ToolName("t-hook")], TOOLS[ToolName("l-hook")]
    missing = t_hook.parts_missing_in(l_hook)
    assert {part.name for part in missing} == {"right bar", "right hook"}
    assert set(t_hook.parts) - set(missing) == set(l_hook.parts)
    assert l_hook.parts_missing_in(t_hook) == ()
    assert t_hook.parts_missing_in(t_hook) == ()


def test_any_two_colours_differ_by_more_than_twice_the_tolerance() -> None:
    """§7.2: "color is the only feature used to recognize tools": no colour fits two of them."""
    colors = [*TOOL_COLORS.values(), PUCK_COLOR]
    for a, b in combinations(colors, 2):
        assert math.dist(a, b) > 2.0 * COLOR_TOLERANCE


@pytest.mark.parametrize("color", [*TOOL_COLORS.values(), PUCK_COLOR])
def test_a_colour_has_three_components_of_0_to_255(color: Color) -> None:
    assert len(color) == 3
    assert all(0.0 <= component <= 255.0 for component in color)


def test_painting_a_tool_changes_its_colour_alone() -> None:
    stick, color = TOOLS[ToolName("stick")], TOOL_COLORS[ToolName("t-hook")]
    painted = stick.painted(color)
    assert painted.color == color
    assert (painted.name, painted.parts) == (stick.name, stick.parts)
    assert stick.color == TOOL_COLORS[ToolName("stick")]


@pytest.mark.parametrize("name", registry.parts("tools"))
def test_every_part_of_every_tool_is_as_thick_as_the_geometry_says(name: str) -> None:
    for part in registry.tool(name, GEOMETRY).parts:
        left, bottom, right, top = part.outline.bounds
        assert min(right - left, top - bottom) == pytest.approx(GEOMETRY.part_width)
