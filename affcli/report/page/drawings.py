"""Arrows over tools as the page draws them: one panel a behavior, as in Fig. 6."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from affcli.core.affordance import Affordance
from affcli.core.geometry import direction_degrees
from affcli.core.tool import Tool, ToolPart

SECTORS = ("right", "away", "left", "toward")
"""Where a movement goes, by quarters of a turn: away from the robot is a push, toward it a pull."""
MARGIN = 1.6
"""Inches around the tool and all arrows."""


@dataclass(frozen=True, slots=True)
class Arrow:
    """One row of an affordance table, drawn in wrist coordinates (in).

    Args:
        id: the row's number in the store.
        x, y: where the attractor was, as seen from the wrist.
        dx, dy: its movement.
        sector: one of `SECTORS`.
        counters: successes/uses.
        excluded: in how many trials the row was excluded; 0 when it was kept in all.
        part: the part of the tool nearest to where the attractor was.
    """

    id: int
    x: float
    y: float
    dx: float
    dy: float
    sector: str
    counters: str
    excluded: int
    part: str


@dataclass(frozen=True, slots=True)
class Panel:
    """The rows of one behavior with one value of its parameter."""

    title: str
    arrows: Sequence[Arrow]


@dataclass(frozen=True, slots=True)
class Frame:
    """What all panels of a tool show of the wrist's frame: left, bottom, width and height (in)."""

    left: float
    bottom: float
    width: float
    height: float


def sector(dx: float, dy: float) -> str:
    """Return where a movement goes: the one of `SECTORS` that it is nearest to."""
    return SECTORS[int((direction_degrees(dx, dy) + 45.0) // 90.0) % 4]


def panels(
    tool: Tool, rows: Mapping[int, Affordance], excluded: Mapping[int, int] | None = None
) -> list[Panel]:
    """Return the panels of a tool, behaviors in alphabetical order, the shorter distance first.

    Args:
        tool: as it was when the rows were made.
        rows: by number.
        excluded: in how many trials a row was excluded, by number. None: those whose probability is
            1/2 or below now count as excluded.
    """
    by_call: dict[tuple[str, float], list[Arrow]] = {}
    for number, row in rows.items():
        moved, start = row.expected_movement, row.start.wrist_to_object
        gone = 2 * row.times_successful <= row.times_used
        arrow = Arrow(
            number,
            *(start.x, start.y, moved.dx, moved.dy),
            sector=sector(moved.dx, moved.dy),
            counters=f"{row.times_successful}/{row.times_used}",
            excluded=int(gone) if excluded is None else excluded.get(number, 0),
            part=tool.part_nearest(start).name,
        )
        distance = row.exploratory.params[0][1]
        by_call.setdefault((row.exploratory.name, distance), []).append(arrow)
    return [
        Panel(f"{name}, {distance:g} in", by_call[name, distance])
        for name, distance in sorted(by_call)
    ]


def frame(tools: Sequence[Tool], drawn: Sequence[Panel]) -> Frame:
    """Return what the panels must show so that every arrow and the tools fit."""
    corners = [corner for tool in tools for part in tool.parts for corner in part.outline.vertices]
    arrows = [arrow for panel in drawn for arrow in panel.arrows]
    xs = [x for x, _ in corners] + [x for a in arrows for x in (a.x, a.x + a.dx)]
    ys = [y for _, y in corners] + [y for a in arrows for y in (a.y, a.y + a.dy)]
    left, bottom = min(xs) - MARGIN, min(ys) - MARGIN
    return Frame(left, bottom, max(xs) + MARGIN - left, max(ys) + MARGIN - bottom)


def points(part: ToolPart) -> str:
    """Return a part's outline as SVG wants it, y upward (in, tool frame)."""
    return " ".join(f"{x:g},{y:g}" for x, y in part.outline.vertices)
