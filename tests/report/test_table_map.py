"""The table as letters: whatever stands on it is seen where it stands, at any width."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from rich.text import Text

from affcli.config import Settings
from affcli.core.geometry import Point, Pose
from affcli.core.scene import Scene
from affcli.core.tool import PUCK_COLOR
from affcli.core.workspace import PuckGeometry, ToolGeometry, Workspace
from affcli.report.table_map import EDGE, GOAL, PATH, PUCK, TOOL, Layer, View, table_map
from affcli.simulation.tasks.extension_of_reach import goal_regions
from affcli.simulation.tools.paper import TOOL_PARTS, paper_tools

WORKSPACE = Settings().workspace
TABLE = WORKSPACE.table
AWAY = Pose(0.0, 12.0)
"""Where the wrist is out of the way of what lies to the left and the right."""

widths = st.integers(20, 120)
heights = st.integers(6, 60)
on_table = st.builds(
    Point,
    st.floats(-TABLE.half_width, TABLE.half_width),
    st.floats(TABLE.near, TABLE.far),
)
wrists = on_table.map(lambda at: Pose(*at))
tools = st.sampled_from(sorted(TOOL_PARTS))


def scene(
    puck: Point = Point(0.0, 22.4),
    *,
    wrist: Pose = AWAY,
    tool: str = "stick",
    goal: str | None = None,
    lift: float = 0.0,
    workspace: Workspace = WORKSPACE,
) -> Scene:
    """Return what is on the table."""
    held = {str(name): one for name, one in paper_tools(workspace.tools).items()}[tool]
    region = None if goal is None else goal_regions(workspace.layout)[goal]
    return Scene(Pose(*puck), PUCK_COLOR, wrist, held, region, lift)


def drawn(
    shown: Scene,
    view: View,
    path: tuple[Point, ...] = (),
    *,
    braille: bool = False,
    workspace: Workspace = WORKSPACE,
) -> list[str]:
    """Return the lines of a map."""
    return table_map(shown, workspace, path, view, braille=braille).plain.split("\n")


def cell(view: View, point: Point) -> tuple[int, int]:
    """Return row and column of the letter in which a point lies: a letter is 2 x 4 dots."""
    row = math.floor((view.top - point.y) / view.inches / 4)
    return row, math.floor((point.x - view.left) / view.inches / 2)


def cells_of(lines: list[str], layer: Layer) -> set[tuple[int, int]]:
    """Return rows and columns of the letters of one kind of thing."""
    return {
        (row, column)
        for row, line in enumerate(lines)
        for column, letter in enumerate(line)
        if letter == layer.letter
    }


def middle(view: View, place: tuple[int, int]) -> Point:
    """Return the middle of a letter (in, table frame)."""
    row, column = place
    return Point(
        view.left + 2 * view.inches * (column + 0.5), view.top - 4 * view.inches * (row + 0.5)
    )


@given(widths, heights)
def test_the_map_is_no_wider_or_higher_than_asked_and_holds_the_table(
    width: int, height: int
) -> None:
    view = View.of(WORKSPACE, width, height)
    lines = drawn(scene(), view)
    assert len(lines) == view.rows <= height
    assert {len(line) for line in lines} == {view.columns}
    assert view.columns <= width
    for x in (-TABLE.half_width, TABLE.half_width):
        for y in (TABLE.near, TABLE.far):
            row, column = cell(view, Point(x, y))
            assert 0 <= row < view.rows
            assert 0 <= column < view.columns
    assert width in {view.columns, view.columns + 1} or view.rows == height


@given(on_table, widths, heights)
def test_a_puck_anywhere_is_seen_at_the_letter_where_it_is(
    puck: Point, width: int, height: int
) -> None:
    """And nowhere else: no letter of it is farther from its middle than its rim and a letter."""
    view = View.of(WORKSPACE, width, height)
    lines = drawn(scene(puck, tool="t-hook"), view)
    cells = cells_of(lines, PUCK)
    assert cell(view, puck) in cells
    reach = WORKSPACE.puck.radius + view.inches * math.hypot(1.0, 2.0)
    assert all(math.dist(middle(view, one), puck) <= reach for one in cells)


@given(on_table, widths, st.floats(1e-3, 1.5))
def test_a_puck_of_any_size_is_seen(puck: Point, width: int, radius: float) -> None:
    workspace = replace(WORKSPACE, puck=PuckGeometry(radius=radius))
    view = View.of(workspace, width, 18)
    assert cell(view, puck) in cells_of(drawn(scene(puck), view, workspace=workspace), PUCK)


@given(wrists, on_table, tools, widths, st.sampled_from([0.0, 1.6]))
def test_a_tool_is_seen_along_all_its_parts(
    wrist: Pose, puck: Point, tool: str, width: int, lift: float
) -> None:
    """The middle of each part and of each of its edges, but where the puck lies over it."""
    view = View.of(WORKSPACE, width, 40)
    shown = scene(puck, wrist=wrist, tool=tool, lift=lift)
    lines = drawn(shown, view)
    for part in shown.tool.outlines:
        left, bottom, right, top = part.bounds
        for share in (0.1, 0.3, 0.5, 0.7, 0.9):
            x, y = left + share * (right - left), bottom + share * (top - bottom)
            row, column = cell(view, Point(wrist.x + x, wrist.y + y))
            if 0 <= row < view.rows and 0 <= column < view.columns:
                near = lines[row][max(0, column - 1) : column + 2]
                assert set(near) & {TOOL.letter, PUCK.letter}, (x, y)


@given(wrists, widths, st.floats(1e-3, 0.4))
def test_a_tool_of_thin_wood_is_seen_too(wrist: Pose, width: int, wood: float) -> None:
    """No thinner than a dot: the handle is without gaps."""
    workspace = replace(WORKSPACE, tools=ToolGeometry(part_width=wood))
    view = View.of(workspace, width, 40)
    lines = drawn(scene(Point(-15.0, 30.0), wrist=wrist, workspace=workspace), view)
    assume(abs(wrist.x + 15.0) > 3.0)
    top = min(wrist.y + 14.6, TABLE.far)
    y = max(wrist.y - 1.0, 4.0)
    while y < top:
        row, column = cell(view, Point(wrist.x, y))
        near = lines[row][max(0, column - 1) : column + 2]
        assert TOOL.letter in near, y
        y += 0.5


@given(on_table, widths, st.sampled_from(["1", "2", "3", "4"]))
def test_a_goal_is_an_outline_around_its_middle(puck: Point, width: int, goal: str) -> None:
    """What lies in it is seen."""
    view = View.of(WORKSPACE, width, 40)
    region = goal_regions(WORKSPACE.layout)[goal]
    shown = scene(puck, wrist=Pose(0.0, -20.0), goal=goal)
    assume(math.dist(puck, region.center) > 6.0)
    cells = cells_of(drawn(shown, view), GOAL)
    reach = view.inches * 2.5
    x, y = region.center
    for corner in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        at = Point(x + corner[0] * region.half_width, y + corner[1] * region.half_width)
        assert any(math.dist(middle(view, one), at) <= reach for one in cells)
    if view.inches < 0.5:
        assert cell(view, region.center) not in cells


@given(st.lists(on_table, max_size=30), on_table, widths)
def test_the_path_is_seen_under_what_stands_on_it(
    path: list[Point], puck: Point, width: int
) -> None:
    view = View.of(WORKSPACE, width, 40)
    shown = scene(puck, tool="t-hook", goal="2")
    lines = drawn(shown, view, tuple(path))
    for place in path:
        row, column = cell(view, place)
        assert lines[row][column] in {PATH.letter, TOOL.letter, PUCK.letter}
    without = drawn(shown, view)
    other = cells_of(lines, PATH)
    assert other <= {cell(view, place) for place in path}
    changed = {
        (row, column)
        for row in range(view.rows)
        for column in range(view.columns)
        if lines[row][column] != without[row][column]
    }
    assert changed == other


def test_what_lies_beyond_the_map_is_not_drawn() -> None:
    view = View.of(WORKSPACE, 40, 18)
    far = (Point(1e5, 22.0), Point(0.0, -1e5), Point(-1e5, 1e5), Point(0.0, 33.0))
    assert drawn(scene(Point(500.0, 22.4)), view, far) == drawn(scene(Point(0.0, -90.0)), view)


@given(
    on_table,
    wrists,
    tools,
    widths,
    st.sampled_from([None, "1", "2", "3", "4"]),
    st.sampled_from([0.0, 1.6]),
    st.lists(on_table, max_size=5),
)
def test_plain_letters_and_braille_agree(
    puck: Point,
    wrist: Pose,
    tool: str,
    width: int,
    goal: str | None,
    lift: float,
    path: list[Point],
) -> None:
    """A letter stands where there are dots; both have the style of the uppermost thing."""
    view = View.of(WORKSPACE, width, 40)
    shown = scene(puck, wrist=wrist, tool=tool, goal=goal, lift=lift)
    plain, dots = (
        table_map(shown, WORKSPACE, path, view, braille=braille) for braille in (False, True)
    )
    assert [letter == " " for letter in plain.plain] == [letter == " " for letter in dots.plain]
    assert {*plain.plain} <= {" ", "\n", *(one.letter for one in (EDGE, GOAL, PATH, TOOL, PUCK))}
    assert all(letter in " \n" or 0x2800 < ord(letter) <= 0x28FF for letter in dots.plain)
    assert spans(plain) == spans(dots)


def spans(text: Text) -> list[tuple[int, int, str]]:
    """Return where which styles are."""
    return [(span.start, span.end, str(span.style)) for span in text.spans]


def test_each_thing_has_its_style() -> None:
    view = View.of(WORKSPACE, 60, 40)
    shown = scene(Point(10.0, 22.4), wrist=Pose(-8.0, 14.0), goal="2")
    drawn_map = table_map(shown, WORKSPACE, [Point(5.0, 14.0)], view, braille=False)
    layers = {one.letter: one.style for one in (EDGE, GOAL, PATH, TOOL, PUCK)}
    seen = {drawn_map.plain[span.start]: span.style for span in drawn_map.spans}
    assert seen == layers
    for span in drawn_map.spans:
        assert len({*drawn_map.plain[span.start : span.end]}) == 1


def test_a_lifted_tool_hides_nothing() -> None:
    """In braille every other dot of it is left out."""
    view = View.of(WORKSPACE, 60, 40)
    down, lifted = (
        sum(
            ord(letter).bit_count()
            for line in drawn(scene(Point(14.0, 30.0), lift=lift), view, braille=True)
            for letter in line
            if letter != " "
        )
        for lift in (0.0, 1.6)
    )
    assert lifted < down


@pytest.mark.parametrize("braille", [False, True])
def test_a_table_of_any_size_fits(braille: bool) -> None:
    """Sizes that the settings allow."""
    for half, near, far in ((1e-3, 1e-3, 2e-3), (1e6, 1e-3, 1e6), (1e-3, 1e-3, 1e6)):
        table = replace(TABLE, half_width=half, near=near, far=far)
        workspace = replace(WORKSPACE, table=table)
        view = View.of(workspace, 40, 18)
        lines = drawn(scene(), view, braille=braille, workspace=workspace)
        assert len(lines) <= 18
        assert max(map(len, lines)) <= 40


def test_where_a_plan_should_leave_the_attractor_is_a_ring_there() -> None:
    here = scene(Point(0.0, 20.0))
    view = View.of(WORKSPACE, 42, 18)
    plain, planned = (
        table_map(here, WORKSPACE, (), view, braille=False, ahead=ahead).plain
        for ahead in ((), (Point(8.0, 24.0),))
    )
    assert "?" not in plain
    assert planned.count("?") >= 4
    assert planned.replace("?", " ") == plain
