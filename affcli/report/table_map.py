"""The table as a picture made of letters: braille dots, or plain letters where there are none."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.style import Style
from rich.text import Text

from affcli.core.geometry import ConvexPolygon, Point
from affcli.core.scene import Scene
from affcli.core.workspace import Workspace

Coordinates = NDArray[np.float64]
Dots = NDArray[np.bool_]
"""Which dots a thing covers."""

DOTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
"""Bits of a braille letter by row and column of its dots (Unicode, block 2800)."""
ACROSS, DOWN = 2, 4
"""Dots in a letter."""
MARGIN = 1.0
"""Inches shown beyond the table, and nearer to the robot than its wrist can be."""


class Layer(NamedTuple):
    """One kind of thing on the map.

    Args:
        letter: shown where there are no braille letters.
        style: its colour on a terminal that has some.
    """

    letter: str
    style: Style


EDGE = Layer(".", Style(dim=True))
GOAL = Layer("+", Style(color="cyan"))
AHEAD = Layer("?", Style(color="bright_blue"))
PATH = Layer(":", Style(color="yellow"))
TOOL = Layer("#", Style(color="green", bold=True))
PUCK = Layer("o", Style(color="bright_red", bold=True))


@dataclass(frozen=True, slots=True)
class View:
    """What part of the table is shown, and how finely.

    Args:
        left, top: the upper left corner (in, table frame).
        inches: from one dot to the next.
        columns, rows: size in letters.
    """

    left: float
    top: float
    inches: float
    columns: int
    rows: int

    @classmethod
    def of(cls, workspace: Workspace, columns: int, rows: int) -> "View":
        """Return the view of the whole table and the arm's reach that fits into so many letters."""
        table = workspace.table
        half = table.half_width + MARGIN
        near, far = min(table.near, 4.0) - MARGIN, table.far + MARGIN
        inches = max(2.0 * half / (ACROSS * columns), (far - near) / (DOWN * rows))
        used = min(rows, int(np.ceil((far - near) / inches / DOWN)))
        across = min(columns, int(np.ceil(2.0 * half / inches / ACROSS)))
        return cls(-0.5 * across * ACROSS * inches, far, inches, across, used)

    def places(self) -> tuple[Coordinates, Coordinates]:
        """Return x and y of the middle of each dot, (rows * 4, columns * 2) each (in)."""
        x = self.left + self.inches * (np.arange(self.columns * ACROSS) + 0.5)
        y = self.top - self.inches * (np.arange(self.rows * DOWN) + 0.5)
        across, down = np.meshgrid(x, y)
        return across, down

    def dots_at(self, places: Sequence[Point]) -> Dots:
        """Return which dots have one of the places (in) in them, (rows * 4, columns * 2)."""
        dots = np.zeros((self.rows * DOWN, self.columns * ACROSS), bool)
        x, y = np.array(places, float).reshape(-1, 2).T
        row = np.floor((self.top - y) / self.inches).astype(int)
        column = np.floor((x - self.left) / self.inches).astype(int)
        seen = (row >= 0) & (row < dots.shape[0]) & (column >= 0) & (column < dots.shape[1])
        dots[row[seen], column[seen]] = True
        return dots


def table_map(
    scene: Scene,
    workspace: Workspace,
    path: Sequence[Point],
    view: View,
    *,
    braille: bool,
    ahead: Sequence[Point] = (),
) -> Text:
    """Return what is on the table as lines of letters, the robot at the lower edge.

    Args:
        scene: what is on it.
        workspace: its sizes.
        path: where the attractor has been (in, table frame).
        view: what to show.
        braille: with braille letters, eight dots each; without, one letter for each thing.
        ahead: where a plan should leave the attractor, move by move (in, table frame).
    """
    x, y = view.places()
    table, line = workspace.table, 0.6 * view.inches
    edge = _frame(x, y, (-table.half_width, table.near, table.half_width, table.far), line)
    layers = [(EDGE, edge)]
    if scene.goal is not None:
        (gx, gy), half = scene.goal.center, scene.goal.half_width
        goal = _frame(x, y, (gx - half, gy - half, gx + half, gy + half), line)
        layers.append((GOAL, goal))
    rim = workspace.puck.radius
    for ghost in ahead:
        ring = np.abs(np.hypot(x - ghost.x, y - ghost.y) - rim) < line
        layers.append((AHEAD, ring))
    layers.append((PATH, view.dots_at(path)))
    placed = (part.placed(scene.wrist) for part in scene.tool.outlines)
    parts = [_polygon(x, y, part, view.inches) for part in placed]
    held = np.logical_or.reduce(parts)
    if scene.lift > 0.0:
        # A tool in the air hides nothing: every other dot.
        rows, columns = np.indices(x.shape)
        held &= (rows + columns) % 2 == 0
    layers.append((TOOL, held))
    center = scene.attractor
    # The middle of the nearest dot lies within 0.71 of a dot: the smallest puck is one.
    radius = max(workspace.puck.radius, 0.71 * view.inches)
    layers.append((PUCK, np.hypot(x - center.x, y - center.y) <= radius))
    return _letters(layers, view, braille=braille)


def _letters(layers: list[tuple[Layer, Dots]], view: View, *, braille: bool) -> Text:
    """Return the letters of all cells, each in the style of the uppermost thing in it."""
    shape = (view.rows, DOWN, view.columns, ACROSS)
    bits = np.zeros((view.rows, view.columns), int)
    uppermost = np.full((view.rows, view.columns), -1)
    for number, (_, covered) in enumerate(layers):
        dots = covered.reshape(shape).transpose(0, 2, 1, 3)
        bits |= (dots * DOTS).sum(axis=(2, 3))
        uppermost[dots.any(axis=(2, 3))] = number
    text = Text(no_wrap=True)
    for row in range(view.rows):
        text.append("\n" if row else "")
        for highest, run in groupby(range(view.columns), key=uppermost[row].__getitem__):
            if highest < 0:
                text.append(" " * len(list(run)))
            else:
                letter, style = layers[highest][0]
                shown = (chr(0x2800 + bits[row, k]) if braille else letter for k in run)
                text.append("".join(shown), style)
    return text


def _frame(
    x: Coordinates, y: Coordinates, box: tuple[float, float, float, float], line: float
) -> Dots:
    """Return the dots on the outline of a box: left, bottom, right and top."""
    left, bottom, right, top = box
    dx = np.abs(x - 0.5 * (left + right)) - 0.5 * (right - left)
    dy = np.abs(y - 0.5 * (bottom + top)) - 0.5 * (top - bottom)
    return np.abs(np.maximum(dx, dy)) < line


def _polygon(x: Coordinates, y: Coordinates, part: ConvexPolygon, line: float) -> Dots:
    """Return the dots of a convex part of a tool, drawn no thinner than a dot."""
    within = np.ones(x.shape, bool)
    for a, b in part.edges:
        ex, ey = b.x - a.x, b.y - a.y
        cross = ex * (y - a.y) - ey * (x - a.x)
        within &= cross >= -0.5 * line * np.hypot(ex, ey)
    return within
