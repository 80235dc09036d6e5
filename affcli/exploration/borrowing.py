"""Carrying rows over to a new tool by its shape: "similarity to previous tools" (§8).

A row is about the few inches of a tool that the attractor meets. It carries over wherever the new
tool looks alike there: at the same place about the wrist, at another, or mirrored. The robot sees
masks and rows; nothing here knows an outline.

Choice: where the attractor goes in the tool frame is a straight line, from where it is when the
behavior begins to where it is at its end.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, Repertoire, motion_of
from affcli.core.geometry import Point
from affcli.core.mask import SCALE, Grid, Mask
from affcli.core.motion import Motion, Slide, Turn, turned_by
from affcli.core.observation import Observation
from affcli.core.transfer import WHOLE, Borrowed, Borrowing

Streams = Callable[[str], np.random.Generator]
"""Gives the random stream of a name: of a lender's key, or of `KEPT`."""
KEPT = "kept"
"""Names the stream by which it is drawn what is kept."""


@dataclass(frozen=True, slots=True)
class Lender:
    """A learning run whose rows may be borrowed.

    Args:
        key: of the run.
        tool: the name of its tool.
        rows: what its robot learned, oldest first.
        mask: what its camera saw of the tool.
    """

    key: str
    tool: str
    rows: Sequence[Affordance]
    mask: Mask


def borrow(
    lenders: Sequence[Lender],
    mask: Mask,
    repertoire: Repertoire,
    borrowing: Borrowing,
    streams: Streams,
) -> tuple[Borrowed, ...]:
    """Return what a robot borrows: a function of the arguments, whatever the order of the lenders.

    Args:
        lenders: whose rows.
        mask: what its camera sees of the new tool.
        repertoire: what it can do.
        borrowing: how.
        streams: of the robot's choices.
    """
    lenders = sorted(lenders, key=lambda one: one.key)
    seen = mask.grown(borrowing.grown)
    if borrowing.way == WHOLE:
        nearest = max(lenders, key=lambda one: one.mask.overlap(seen))
        found = [_Found(nearest, row, row, Point(0.0, 0.0), mirrored=False) for row in nearest.rows]
        return _numbered(found, mask, repertoire)
    shapes = Shapes(seen, borrowing)
    carried: list[_Found] = []
    for lender in lenders:
        rng = streams(lender.key)
        drawn = rng.permutation(len(lender.rows))[: borrowing.each]
        for position in sorted(drawn.tolist()):
            carried += shapes.carried(lender, lender.rows[position], repertoire, rng)
    kept = streams(KEPT).permutation(len(carried))[: borrowing.most]
    return _numbered([carried[i] for i in sorted(kept.tolist())], mask, repertoire)


class _Found(NamedTuple):
    """A row that carries over.

    Args:
        lender: whose.
        origin: the row as it was made.
        row: the row, mirrored where it is.
        shift: by how much the attractor stands elsewhere to the tool (in, tool frame).
        mirrored: whether it is.
    """

    lender: Lender
    origin: Affordance
    row: Affordance
    shift: Point
    mirrored: bool


class Shapes:
    """A new tool's mask, held against the surroundings of rows.

    Args:
        mask: of the new tool.
        borrowing: how it is held against them.
    """

    def __init__(self, mask: Mask, borrowing: Borrowing) -> None:
        self._mask, self._borrowing = mask, borrowing
        self._spectra: dict[tuple[int, int], NDArray[np.complexfloating]] = {}

    def carried(
        self, lender: Lender, row: Affordance, repertoire: Repertoire, rng: np.random.Generator
    ) -> Iterator[_Found]:
        """Yield how a row carries over: where it was if it can be, else at other places."""
        for mirrored in (False, True):
            own = mirrored_row(row, repertoire) if mirrored else row
            way = None if own is None else way_of(own, repertoire)
            if own is None or way is None:
                continue
            old = lender.mask.mirrored() if mirrored else lender.mask
            for shift in self._shifts(old, way, rng):
                yield _Found(lender, row, own, shift, mirrored)

    def _shifts(self, old: Mask, way: "Way", rng: np.random.Generator) -> list[Point]:
        """Return at which other places the new tool looks as the old one does along a way."""
        limit = self._borrowing.limit
        column, row, swept = sweep(way, self._borrowing.radius)
        covered = old.window(column, row, *swept.shape) & swept
        if covered.sum() * SCALE**2 <= limit:
            return []  # nothing of the tool is there: it would look alike beside any tool
        most = math.floor(limit / SCALE**2 + 1e-9)
        there = self._mask.window(column, row, *swept.shape)
        if ((there ^ covered) & swept).sum() <= most:
            return [Point(0.0, 0.0)]
        if not self._borrowing.shifts:
            return []
        differing, left, near = self._everywhere(swept, covered)
        places = np.argwhere(differing <= most)
        chosen = rng.permutation(len(places))[: self._borrowing.shifts]
        return [
            Point(float(left + i - column) * SCALE, float(near + j - row) * SCALE)
            for i, j in places[chosen]
        ]

    def _everywhere(self, swept: Grid, covered: Grid) -> tuple[NDArray[np.int64], int, int]:
        """Return in how many cells the new tool differs along a way, wherever that touches it.

        It is the number of cells that the old tool covers, and for each that the new one covers 1
        more where the old does not, 1 less where it does: a correlation.

        Returns:
            The numbers, and column and row of the way's first cell at the first of them.
        """
        (width, depth), (columns, rows) = swept.shape, self._mask.grid.shape
        shape = _sizes(columns + width), _sizes(rows + depth)
        if shape not in self._spectra:
            self._spectra[shape] = np.fft.rfft2(self._mask.grid.astype(np.float32), shape)
        kernel = swept.astype(np.float32) - 2.0 * covered.astype(np.float32)
        product = self._spectra[shape] * np.conj(np.fft.rfft2(kernel, shape))
        sums = np.rint(np.fft.irfft2(product, shape)).astype(np.int64)
        # What lies before the first cell stands at the end.
        around = np.roll(sums, (width - 1, depth - 1), (0, 1))
        kept = around[: columns + width - 1, : rows + depth - 1]
        first = self._mask.column - (width - 1), self._mask.row - (depth - 1)
        return kept + int(covered.sum()), *first


def _sizes(least: int) -> int:
    """Return the next size of which transforms are quick: a multiple of 64."""
    return 64 * math.ceil(least / 64)


class Way(NamedTuple):
    """Where the attractor goes in the tool frame (in).

    Args:
        start, end: of its middle.
    """

    start: Point
    end: Point


def way_of(row: Affordance, repertoire: Repertoire) -> Way | None:
    """Return where the attractor goes in the tool frame; None where the row does not tell it.

    A row says at which angle its behavior began, and not how far a turn came that was cut short.
    """
    motion = motion_of(row.exploratory, repertoire)
    if motion is None or not row.is_placed():
        return None
    turned = turned_by(motion)[-1]
    if turned and row.truncated:
        return None
    start, end = row.wrist_angle, row.wrist_angle + turned
    return Way(
        turned_point(row.start.wrist_to_object, -start), turned_point(row.end.wrist_to_object, -end)
    )


def turned_point(point: Point, angle: float) -> Point:
    """Return a point turned about the origin (rad, counter-clockwise)."""
    if not angle:
        return point
    cos, sin = math.cos(angle), math.sin(angle)
    return Point(cos * point.x - sin * point.y, sin * point.x + cos * point.y)


def sweep(way: Way, radius: float) -> tuple[int, int, Grid]:
    """Return the cells that a disc sweeps along a way.

    Args:
        way: of its middle.
        radius: of the disc (in).

    Returns:
        Column and row of the first cell, and which cells from there on (columns, rows).
    """
    (x0, y0), (x1, y1) = way
    left, right = min(x0, x1) - radius, max(x0, x1) + radius
    near, far = min(y0, y1) - radius, max(y0, y1) + radius
    column, row = math.floor(left / SCALE), math.floor(near / SCALE)
    x = SCALE * (np.arange(column, math.ceil(right / SCALE)) + 0.5)[:, None] - x0
    y = SCALE * (np.arange(row, math.ceil(far / SCALE)) + 0.5)[None, :] - y0
    dx, dy = x1 - x0, y1 - y0
    squared = dx * dx + dy * dy
    share = np.clip((x * dx + y * dy) / squared, 0.0, 1.0) if squared > 1e-12 else 0.0 * (x + y)
    return column, row, np.hypot(x - share * dx, y - share * dy) <= radius


def mirrored_call(call: BehaviorCall, repertoire: Repertoire) -> BehaviorCall | None:
    """Return the behavior that does the same with left and right exchanged; None when the robot has
    none.
    """
    motion = motion_of(call, repertoire)
    wanted = None if motion is None else mirrored_motion(motion)
    if wanted is None:
        return None
    if wanted == motion:
        return call
    return next((one.call for one in repertoire if one.motion == wanted), None)


def mirrored_motion(motion: Motion) -> Motion | None:
    """Return a motion with left and right exchanged; None of one that leads to a place of the
    table.
    """
    found: list[Slide | Turn] = []
    for segment in motion:
        match segment:
            case Slide(dx, dy):
                found.append(Slide(0.0 - dx, dy))
            case Turn(degrees):
                found.append(Turn(0.0 - degrees))
            case _:
                return None
    return tuple(found)


def mirrored_row(row: Affordance, repertoire: Repertoire) -> Affordance | None:
    """Return a row with left and right exchanged; None when the robot cannot do that."""
    call = mirrored_call(row.exploratory, repertoire)
    if call is None:
        return None
    return replace(
        row,
        exploratory=call,
        start=_mirrored_observation(row.start),
        end=_mirrored_observation(row.end),
        wrist_angle=0.0 - row.wrist_angle,
        travel=Point(0.0 - row.travel.x, row.travel.y),
    )


def _mirrored_observation(seen: Observation) -> Observation:
    """Return what is seen with left and right exchanged."""
    return seen._replace(
        object_x=0.0 - seen.object_x, wrist_to_object_x=0.0 - seen.wrist_to_object_x
    )


def _numbered(found: Sequence[_Found], mask: Mask, repertoire: Repertoire) -> tuple[Borrowed, ...]:
    """Return what carries over as rows of the new tool, the last of them at step 0."""
    return tuple(
        Borrowed(
            row=_of_new_tool(one, mask, repertoire, number),
            lender=one.lender.key,
            tool=one.lender.tool,
            step=one.origin.step,
            shift=one.shift,
            mirrored=one.mirrored,
        )
        for number, one in enumerate(found, 1 - len(found))
    )


def _of_new_tool(one: _Found, mask: Mask, repertoire: Repertoire, step: int) -> Affordance:
    """Return a row as one of the new tool: shifted, in its colour, with the counters of a new one.

    The wrist is where it was, and the attractor elsewhere to it.
    """
    motion = motion_of(one.row.exploratory, repertoire) or ()
    begun = one.row.wrist_angle
    ended = begun + turned_by(motion)[-1]
    return replace(
        one.row,
        step=step,
        times_used=1,
        times_successful=1,
        start=_elsewhere(one.row.start, turned_point(one.shift, begun), mask),
        end=_elsewhere(one.row.end, turned_point(one.shift, ended), mask),
    )


def _elsewhere(seen: Observation, by: Point, mask: Mask) -> Observation:
    """Return what is seen with the attractor elsewhere, and the tool in its own colour."""
    red, green, blue = mask.color
    return seen._replace(
        object_x=seen.object_x + by.x,
        object_y=seen.object_y + by.y,
        wrist_to_object_x=seen.wrist_to_object_x + by.x,
        wrist_to_object_y=seen.wrist_to_object_y + by.y,
        tool_red=red,
        tool_green=green,
        tool_blue=blue,
    )
