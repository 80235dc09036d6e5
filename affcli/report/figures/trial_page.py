"""Where things stand on the page of a film strip, and what of the table its panels show."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from affcli.core.geometry import Point
from affcli.core.observation import Movement
from affcli.report.figures.canvas import ONE_COLUMN, TWO_COLUMNS
from affcli.report.film import COLUMNS, FilmedStep, FilmedTrial, Shown

MARGIN, GAP = 0.04, 0.09
"""Around the figure, and between panels (in)."""
HEAD, TITLE, LINE = 0.31, 0.28, 0.15
"""Heights of the figure's title, of a panel's title and of a line below the panels (in)."""
FLATTEST, STEEPEST = 0.62, 1.0
"""Height of a panel over its width, at least and at most."""
UNDER = 0.08
"""Between the panels and the legend (in)."""
ROOM, EDGE = 0.7, 0.35
"""Around all that is drawn in a panel, and around a label in its corner (in, on the table)."""

Box = tuple[float, float, float, float]
"""Left, bottom, right and top (in, table frame)."""


@dataclass(frozen=True, slots=True)
class Section:
    """The part of the table that every panel shows (in, table frame)."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def width(self) -> float:
        """From left to right."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """From bottom to top."""
        return self.top - self.bottom


@dataclass(frozen=True, slots=True)
class Page:
    """Where things stand on a figure's page.

    Args:
        columns, rows: of panels.
        width: of the page (in).
        tall: height of a panel (in).
        below: height of what stands below the panels (in).
        section: the part of the table in each panel.
        across: columns of the legend.
        beside: the legend stands in the last row, where it has room beside the panels.
    """

    columns: int
    rows: int
    width: float
    tall: float
    below: float
    section: Section
    across: int
    beside: bool

    @property
    def panel(self) -> float:
        """Width of a panel (in)."""
        return _panel(self.width, self.columns)

    @property
    def height(self) -> float:
        """Of the page (in)."""
        panels = self.rows * (TITLE + self.tall) + (self.rows - 1) * GAP
        return 2 * MARGIN + HEAD + panels + self.below

    @property
    def point(self) -> float:
        """How long a typographic point is on the table (in)."""
        return self.section.width / self.panel / 72.0

    def place(self, number: int) -> tuple[float, float, float, float]:
        """Return left, bottom, right, top of a panel, counted from 0, as shares of the page."""
        row, column = divmod(number, self.columns)
        left = MARGIN + column * (self.panel + GAP)
        top = self.height - MARGIN - HEAD - row * (TITLE + self.tall + GAP) - TITLE
        right, bottom = left + self.panel, top - self.tall
        return left / self.width, bottom / self.height, right / self.width, top / self.height


def page_for(trial: FilmedTrial, shown: Shown, lines: int) -> Page:
    """Return a page with room for the panels, the notes and the legend.

    Args:
        trial: what is drawn.
        shown: what of it gets a panel.
        lines: entries of the legend, each a line unless they stand side by side.
    """
    section = section_of(trial, shown)
    columns = min(COLUMNS, shown.panels)
    width = ONE_COLUMN if columns <= 2 else TWO_COLUMNS
    rows = math.ceil(shown.panels / columns)
    tall = _panel(width, columns) * section.height / section.width
    beside = columns * rows > shown.panels and TITLE + tall > lines * LINE
    across = 1 if beside else columns
    below = LINE * bool(shown.note)
    if not beside:
        below += LINE * math.ceil(lines / across) + UNDER
    return Page(columns, rows, width, tall, below, section, across, beside)


def _panel(width: float, columns: int) -> float:
    """Return how wide a panel is on a page (in)."""
    return (width - 2 * MARGIN - (columns - 1) * GAP) / columns


def section_of(trial: FilmedTrial, shown: Shown) -> Section:
    """Return the part of the table that holds all that the panels show."""
    panels = [None] * shown.start + [take[-1] for take in shown.takes]
    boxes = [box for step in panels for box in boxes_in(trial, step)]
    lefts, bottoms, rights, tops = zip(*boxes, strict=True)
    return _shaped(min(lefts) - ROOM, min(bottoms) - ROOM, max(rights) + ROOM, max(tops) + ROOM)


def boxes_in(trial: FilmedTrial, step: FilmedStep | None) -> list[Box]:
    """Return boxes around all that a panel shows.

    Args:
        trial: what it is part of.
        step: which panel; None for the start.
    """
    points, wrists = [trial.puck], [trial.wrist]
    if step is not None:
        # The path leads through the steps that have no panel, too.
        points += [s.puck_end for s in trial.steps if s.number <= step.number]
        points += [step.puck_start, _end(step.puck_start, step.expected)]
        wrists = [step.wrist_end] if step.blocked else [step.wrist_start, step.wrist_end]
    boxes = [_around(point, trial.puck_radius) for point in points]
    boxes.append(_around(trial.goal.center, trial.goal.half_width))
    for part in (*trial.parts, *trial.missing):
        left, bottom, right, top = part.outline.bounds
        boxes += [(left + w.x, bottom + w.y, right + w.x, top + w.y) for w in wrists]
    return boxes


def free_corner(section: Section, boxes: Sequence[Box], width: float, height: float) -> Point:
    """Return where a label hides nothing: its lower left corner, in a corner of the panel.

    The lower right one when all are taken.

    Args:
        section: what the panel shows.
        boxes: around what must stay visible.
        width, height: of the label (in, on the table).
    """
    left, right = section.left + EDGE, section.right - EDGE - width
    bottom, top = section.bottom + EDGE, section.top - EDGE - height
    corners = [Point(x, y) for y in (bottom, top) for x in (right, left)]

    def taken(at: Point) -> bool:
        """Tell whether the label would lie over something."""
        return any(
            x < at.x + width and at.x < r and y < at.y + height and at.y < t for x, y, r, t in boxes
        )

    return next((at for at in corners if not taken(at)), corners[0])


def _around(point: Point, half: float) -> Box:
    """Return the square around a point."""
    return point.x - half, point.y - half, point.x + half, point.y + half


def _shaped(left: float, bottom: float, right: float, top: float) -> Section:
    """Return a section that is neither too flat nor too steep, by making it larger."""
    width, height = right - left, top - bottom
    wider = max(0.0, height / STEEPEST - width) / 2
    higher = max(0.0, width * FLATTEST - height) / 2
    return Section(left - wider, bottom - higher, right + wider, top + higher)


def _end(start: Point, movement: Movement) -> Point:
    """Return where a movement leads."""
    return Point(start.x + movement.dx, start.y + movement.dy)
