"""Finding the grid of markers among other things of their colour.

A grid is grown from three neighbours: what they predict next to them is looked for, and with each
point that is found the prediction reaches farther.
"""

from itertools import permutations
from typing import Any

import cv2
import numpy as np

from affcli.perception.camera import Array

SEEDS, NEIGHBOURS = 12, 6
"""A grid is grown from so many points, from the middle on, and so many of the nearest to each."""
CLOSE = 0.25
"""How far from its predicted place a marker may lie (in spacings)."""
BENT = 8
"""Points from which on the prediction knows perspective; fewer would not determine it well."""
LEAST_ANGLE = 0.3
"""Sine of the angle between the two directions of a grid, at the least."""


def grid_among(points: Array, columns: int, rows: int) -> Array | None:
    """Return the points that form a grid, in no order.

    Args:
        points: pixels (n, 2) of all that looks like a marker.
        columns, rows: markers along the sides of the grid, either way round.

    Returns:
        (columns * rows, 2), px; None when there is no such grid, or a doubt which points are its.
    """
    wanted = sorted((columns, rows))
    from_middle = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    for seed in np.argsort(from_middle)[:SEEDS].tolist():
        nearest = np.argsort(np.linalg.norm(points - points[seed], axis=1))[1 : NEIGHBOURS + 1]
        for right, up in permutations(nearest.tolist(), 2):
            axes = points[[right, up]] - points[seed]
            lengths = np.linalg.norm(axes, axis=1)
            if np.linalg.det(axes) < LEAST_ANGLE * float(np.prod(lengths)):
                continue
            taken = _trimmed(_grown(points, {(0, 0): seed, (1, 0): right, (0, 1): up}))
            sides = sorted(np.ptp(np.array(list(taken)), axis=0) + 1) if taken else []
            if sides == wanted and len(taken) == columns * rows:
                # By the whole grid: of two things at one place nobody knows which is the marker.
                last = [(p, k) for k, p in _places(points, taken).items() if p in taken]
                clear = len(last) == len(taken) == len(dict(last))
                return points[[k for _, k in last]] if clear else None
    return None


def _grown(points: Array, taken: dict[tuple[int, int], int]) -> dict[tuple[int, int], int]:
    """Return which point is at which place of the grid that three begin; empty if unclear."""
    while True:
        grown = dict(taken)
        for point, (x, y) in _places(points, taken).items():
            if any((x + i, y + j) in taken for i in (-1, 0, 1) for j in (-1, 0, 1)):
                grown.setdefault((x, y), point)
        if len(set(grown.values())) < len(grown):
            return {}
        if grown == taken:
            return taken
        taken = grown


def _places(points: Array, taken: dict[tuple[int, int], int]) -> dict[int, tuple[int, int]]:
    """Return the place of each point that is close to one, by those that are taken."""
    predicted = _predicted(points, taken)
    if predicted is None:
        return {}
    nearest = np.rint(predicted)
    close = np.flatnonzero(np.abs(predicted - nearest).max(axis=1) <= CLOSE)
    return {k: (int(nearest[k, 0]), int(nearest[k, 1])) for k in close.tolist()}


def _predicted(points: Array, taken: dict[tuple[int, int], int]) -> Array | None:
    """Return where in the grid all points (n, 2) lie, by those that are taken; None if nowhere."""
    places = np.array(list(taken), dtype=np.float64)
    pixels = points[list(taken.values())]
    whole = np.column_stack([points, np.ones(len(points))])
    if len(taken) < BENT:
        flat = np.column_stack([pixels, np.ones(len(pixels))])
        return np.asarray(whole @ np.linalg.lstsq(flat, places, rcond=None)[0], np.float64)
    perspective: Any = cv2.findHomography(pixels, places)[0]
    if perspective is None:  # points on a line
        return None
    seen = whole @ perspective.T
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.nan_to_num(seen[:, :2] / seen[:, 2:], nan=0.5), np.float64)


def _trimmed(taken: dict[tuple[int, int], int]) -> dict[tuple[int, int], int]:
    """Return a grid without the lines at its edges of which less than half is there."""
    for axis in (0, 1, 0, 1):
        for end in (min, max):
            line = end((place[axis] for place in taken), default=0)
            across = {place[1 - axis] for place in taken}
            there = [place for place in taken if place[axis] == line]
            if 2 * len(there) < len(across):
                taken = {place: point for place, point in taken.items() if place not in there}
    return taken
