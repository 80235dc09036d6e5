"""Arrows over tools as the page draws them: one panel for each behavior, as in Fig. 6."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from affcli.analysis.regions import parts_at, region_of
from affcli.core.affordance import Affordance, is_probable
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import direction_degrees
from affcli.core.tool import Tool, ToolPart
from affcli.report.words import call_title, call_words

SECTORS = ("right", "away", "left", "toward")
"""Where a movement goes, by quarters of a turn: away from the robot is a push, toward it a pull."""
LOGGED = (
    "a log does not say what the tool looked like; where it does not say where it was either, all "
    "arrows begin at one origin"
)
"""Of a run that was imported."""
GRID = 5
"""Inches from one line of the grid to the next."""
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
    """The rows of one behavior with one value of its parameters, the tool held and turned alike.

    Args:
        title: behavior, parameters, and what of the hold is not usual.
        call: the behavior as the terminal writes it.
        parts: of the tool, as it lay around the wrist (in).
        arrows: the rows.
    """

    title: str
    call: str
    parts: Sequence[ToolPart]
    arrows: Sequence[Arrow]


@dataclass(frozen=True, slots=True)
class Frame:
    """What all panels of a tool show of the wrist's frame: left, bottom, width and height (in)."""

    left: float
    bottom: float
    width: float
    height: float

    @property
    def across(self) -> list[int]:
        """Where lines of the grid stand on the x axis (in)."""
        return _multiples(self.left, self.width)

    @property
    def up(self) -> list[int]:
        """Where lines of the grid stand on the y axis (in)."""
        return _multiples(self.bottom, self.height)


def _multiples(first: float, size: float) -> list[int]:
    """Return the multiples of 5 in, of more where the axis is long, that lie on an axis."""
    apart = GRID * max(1, round(size / (8 * GRID)))
    return list(range(math.ceil(first / apart) * apart, math.floor(first + size) + 1, apart))


def sector(dx: float, dy: float) -> str:
    """Return where a movement goes: the one of `SECTORS` that it is nearest to."""
    return SECTORS[int((direction_degrees(dx, dy) + 45.0) // 90.0) % 4]


def panels(
    tool: Tool,
    binding: BehaviorCall,
    rows: Mapping[int, Affordance],
    excluded: Mapping[int, int] | None = None,
    calls: Sequence[BehaviorCall] = (),
) -> list[Panel]:
    """Return the panels of a tool: smaller parameters first, then in the order of the behaviors.

    Args:
        tool: as it was when the rows were made, in the tool frame.
        binding: how it was held; a panel of rows with another one says so.
        rows: by number.
        excluded: in how many trials a row was excluded, by number. None: those whose probability is
            1/2 or below now count as excluded.
        calls: the behaviors; one that made no row has a panel too.
    """
    order = list(
        dict.fromkeys([*(c.name for c in calls), *(r.exploratory.name for r in rows.values())])
    )
    tried = {row.exploratory for row in rows.values()}
    grouped: dict[tuple[BehaviorCall, BehaviorCall, int], list[tuple[int, Affordance]]]
    grouped = {(call, binding, 0): [] for call in calls if call not in tried}
    for number, row in rows.items():
        turn = row.wrist_degrees
        grouped.setdefault((row.exploratory, row.binding, turn), []).append((number, row))
    made = []

    def place(panel: tuple[BehaviorCall, BehaviorCall, int]) -> tuple[object, ...]:
        call, held, turn = panel
        return [value for _, value in call.params], order.index(call.name), str(held), turn

    for (call, held, turn), own in sorted(grouped.items(), key=lambda item: place(item[0])):
        title = [call_title(call)]
        title += [] if held == binding else [call_words(held)]
        title += [f"wrist at {turn} deg"] if turn else []
        arrows = [_arrow(tool, number, row, excluded) for number, row in own]
        made.append(
            Panel(
                "; ".join(title), call_words(call), parts_at(tool, held, math.radians(turn)), arrows
            )
        )
    return made


def _arrow(tool: Tool, number: int, row: Affordance, excluded: Mapping[int, int] | None) -> Arrow:
    """Return a row as it is drawn."""
    moved, start = row.expected_movement, row.drawn_at
    gone = not is_probable(row.times_successful, row.times_used)
    return Arrow(
        number,
        *(start.x, start.y, moved.dx, moved.dy),
        sector=sector(moved.dx, moved.dy),
        counters=f"{row.times_successful}/{row.times_used}",
        excluded=int(gone) if excluded is None else excluded.get(number, 0),
        part=region_of(tool, row),
    )


def frame(drawn: Iterable[Panel]) -> Frame:
    """Return what the panels must show so that every arrow and the tools fit."""
    panels = list(drawn)
    corners = [c for panel in panels for part in panel.parts for c in part.outline.vertices]
    arrows = [arrow for panel in panels for arrow in panel.arrows]
    xs = [0.0, *(x for x, _ in corners), *(x for a in arrows for x in (a.x, a.x + a.dx))]
    ys = [0.0, *(y for _, y in corners), *(y for a in arrows for y in (a.y, a.y + a.dy))]
    left, bottom = min(xs) - MARGIN, min(ys) - MARGIN
    return Frame(left, bottom, max(xs) + MARGIN - left, max(ys) + MARGIN - bottom)


def outline(vertices: Iterable[tuple[float, float]]) -> str:
    """Return corners as SVG wants them (in)."""
    return " ".join(f"{x:g},{y:g}" for x, y in vertices)
