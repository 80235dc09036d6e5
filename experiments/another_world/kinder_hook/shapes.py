"""Where the hook and the block are by what is observed, where the hand can be, and free paths.

Lengths in KinDER's units, angles in radians, in the frame of its room: (0, 0) at the lower left.
The hook is told by its wrist: the place on the middle line of its handle at which it is taken, and
where the handle points; upright is `UP`. Nothing here knows KinDER: it can be tested without.
"""

import math
from collections import deque
from collections.abc import Callable, Hashable, Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple, TypeVar

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity
from shapely.geometry import Polygon

IN = 10.0
"""Inches of ours in one of its units."""
MIDDLE, WALL = 1.75, 1.775
"""x of the middle of the room; y of the upper side of the wall that the block is to touch."""
ROOM = 3.5
UP = 0.5 * math.pi
GRASPED_AT = 0.1
"""From the free end of the handle to the wrist: 1 in, as our usual grasp."""
BASE = 0.24
ARM = (BASE, 2.0 * BASE)
BASE_X, BASE_Y = (0.26, 3.24), (0.26, 1.455)
"""Where the middle of the base can be: at 1.485 it touches the wall in the middle of the room."""
ARMS = (0.36, 0.30, 0.42, 0.245, 0.475)
"""Lengths of the arm that are tried in turn where the place of the hand leaves a choice."""
NEARLY_UP = 0.12
"""Within so much of upright the arm's length is worked out, as far as the room asks."""
TURNS = np.radians(np.arange(-60, 61, 12))
"""How far from upright the hook may be turned while it is carried around the block."""
CLEAR, TOUCHING = 0.02, 0.003
"""How far from the block the hook is carried past, and may come down."""
NEAR_START, NEAR_END = 0.25, 0.16
"""A path begins and ends at a place of its grid so near to the true one."""

QUIET = np.errstate(divide="ignore", invalid="ignore")
"""The engine leaves flags of the processor set, of which shapely would warn."""

Floats = NDArray[np.float64]
Node = TypeVar("Node", bound=Hashable)


class At(NamedTuple):
    """A pose in the room."""

    x: float
    y: float
    angle: float

    def seen_from(self, other: "At") -> "At":
        """Return this pose in the frame of another."""
        cos, sin = math.cos(other.angle), math.sin(other.angle)
        dx, dy = self.x - other.x, self.y - other.y
        return At(dx * cos + dy * sin, dy * cos - dx * sin, wrapped(self.angle - other.angle))

    def of(self, other: "At") -> "At":
        """Return the pose in the room that is this one in the frame of another."""
        cos, sin = math.cos(other.angle), math.sin(other.angle)
        x, y = other.x + self.x * cos - self.y * sin, other.y + self.x * sin + self.y * cos
        return At(x, y, other.angle + self.angle)


class HookSize(NamedTuple):
    """The hook: an L of a handle and a bar."""

    width: float
    handle: float
    bar: float

    def outline(self) -> Polygon:
        """Return it by its wrist, the handle pointing to the right."""
        w, long, short, back = self.width, self.handle, self.bar, -GRASPED_AT
        corner = back + long
        return Polygon(
            [
                (corner, w / 2),
                (back, w / 2),
                (back, -w / 2),
                (corner - w, -w / 2),
                (corner - w, w / 2 - short),
                (corner, w / 2 - short),
            ]
        )

    def wrist(self, corner: At) -> At:
        """Return the wrist of a hook that KinDER tells by its corner."""
        return At(GRASPED_AT - self.handle, -self.width / 2, 0.0).of(corner)

    def corner(self, wrist: At) -> At:
        """Return what KinDER tells of a hook by its wrist."""
        return At(self.handle - GRASPED_AT, self.width / 2, 0.0).of(wrist)

    def free_end(self, corner: At) -> At:
        """Return the middle of the handle's free end."""
        return At(-self.handle, -self.width / 2, 0.0).of(corner)


class Block(NamedTuple):
    """The block: a square."""

    at: At
    side: float

    @property
    def outline(self) -> Polygon:
        """Where it lies."""
        half = self.side / 2
        return placed(shapely.box(-half, -half, half, half), self.at)

    @property
    def below(self) -> float:
        """How far it reaches below its middle."""
        return (abs(math.cos(self.at.angle)) + abs(math.sin(self.at.angle))) * self.side / 2


def wrapped(angle: float) -> float:
    """Return an angle between -pi and pi."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def placed(outline: Polygon, at: At) -> Polygon:
    """Return an outline turned and moved to a pose."""
    turned = affinity.rotate(outline, at.angle, origin=(0, 0), use_radians=True)
    return affinity.translate(turned, at.x, at.y)


def base_for(hand: At) -> tuple[float, float, float] | None:
    """Return x and y of the base, and the arm's length, for the hand; None for nowhere."""
    cos, sin = math.cos(hand.angle), math.sin(hand.angle)
    arms: tuple[float, ...] = ARMS
    if abs(wrapped(hand.angle - UP)) < NEARLY_UP:
        y = min(max(hand.y - ARMS[0], BASE_Y[0]), BASE_Y[1])
        arms = ((hand.y - y) / sin, *ARMS)
    for arm in arms:
        x, y = hand.x - arm * cos, hand.y - arm * sin
        if ARM[0] <= arm <= ARM[1] and within(x, BASE_X) and within(y, BASE_Y):
            return x, y, arm
    return None


def within(value: float, limits: tuple[float, float]) -> bool:
    """Tell whether a value lies between limits, or within a rounding of one."""
    return limits[0] - 1e-9 <= value <= limits[1] + 1e-9


def reached_upright(x: Floats, y: Floats, in_hand: At) -> NDArray[np.bool_]:
    """Tell for each wrist (n,), (n,) whether the hand can hold the hook upright there.

    Args:
        x, y: the wrist.
        in_hand: the wrist as seen from the hand.
    """
    left, right, low, high = upright_limits(in_hand)
    return (x >= left) & (x <= right) & (y >= low) & (y <= high)


def upright_limits(in_hand: At) -> tuple[float, float, float, float]:
    """Return the least and largest x, then y, of the wrist of an upright hook."""
    hand = hand_for(At(0.0, 0.0, UP), in_hand)
    left, right = BASE_X[0] + 0.01 - hand.x, BASE_X[1] - 0.01 - hand.x
    low, high = BASE_Y[0] + ARM[0] + 0.005 - hand.y, BASE_Y[1] + ARM[1] - 0.005 - hand.y
    return left, right, low, high


def hand_for(wrist: At, in_hand: At) -> At:
    """Return where the hand must be for a wrist, which it sees at `in_hand`."""
    return At(0.0, 0.0, 0.0).seen_from(in_hand).of(wrist)


@QUIET
def around(hook: Polygon, block: Polygon, start: At, end: At, in_hand: At) -> list[At] | None:
    """Return a way for the wrist from one pose to another past the block; None if there is none.

    Breadth first over a grid of places and angles; only where it turns off is a place of it told.

    Args:
        hook: its outline by its wrist.
        block: where it lies.
        start, end: the wrist.
        in_hand: as in `reached_upright`.
    """
    xs, ys = np.arange(0.0, ROOM + 0.01, 0.1), np.arange(0.64, 2.11, 0.1)
    x, y = np.meshgrid(xs, ys, indexing="ij")
    free = np.zeros((*x.shape, len(TURNS)), dtype=bool)
    for k, turn in enumerate(TURNS):
        hand = hand_for(At(0.0, 0.0, UP + turn), in_hand)
        held = np.zeros(x.shape, dtype=bool)
        for arm in ARMS:
            base_x = x + hand.x - arm * math.cos(hand.angle)
            base_y = y + hand.y - arm * math.sin(hand.angle)
            held |= (
                (base_x >= BASE_X[0])
                & (base_x <= BASE_X[1])
                & (base_y >= BASE_Y[0])
                & (base_y <= BASE_Y[1])
            )
        # The block is moved the other way in place of the hook: it has fewer corners.
        corners = np.asarray(block.exterior.coords)[None]
        moved = shapely.polygons(corners - np.stack([x.ravel(), y.ravel()], 1)[:, None])
        turned = placed(hook, At(0.0, 0.0, UP + turn))
        free[:, :, k] = held & (shapely.distance(turned, moved).reshape(x.shape) > CLEAR)
    nodes = []
    for at, most in ((start, NEAR_START), (end, NEAR_END)):
        k = int(np.abs(TURNS - wrapped(at.angle - UP)).argmin())
        away = np.where(free[:, :, k], np.hypot(x - at.x, y - at.y), np.inf)
        i, j = np.unravel_index(away.argmin(), away.shape)
        if away[i, j] > most:
            return None
        nodes.append((int(i), int(j), k))
    steps = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    steps += [(1, 1, 0), (1, -1, 0), (-1, 1, 0), (-1, -1, 0)]

    def beside(node: tuple[int, int, int]) -> Iterable[tuple[int, int, int]]:
        for i, j, k in steps:
            near = node[0] + i, node[1] + j, node[2] + k
            inside = all(0 <= n < most for n, most in zip(near, free.shape, strict=True))
            if inside and free[near]:
                yield near

    path = shortest(nodes[0], nodes[1], beside)
    if path is None:
        return None
    return [At(float(xs[i]), float(ys[j]), UP + float(TURNS[k])) for i, j, k in turns_of(path)]


@QUIET
def past_the_hook(hook: Polygon, start: At, end: At) -> list[tuple[float, float]]:
    """Return a way for the bare robot, its arm drawn in, past a hook that lies there.

    Args:
        hook: where it lies.
        start, end: the base.
    """
    xs, ys = np.arange(BASE_X[0], 3.25, 0.08), np.arange(BASE_Y[0], 1.46, 0.08)
    x, y = np.meshgrid(xs, ys, indexing="ij")
    free = shapely.distance(hook, shapely.points(x, y)) > 2.0 * BASE
    nodes = []
    for at in (start, end):
        away = np.where(free, np.hypot(x - at.x, y - at.y), np.inf)
        i, j = np.unravel_index(away.argmin(), away.shape)
        nodes.append((int(i), int(j)))

    def beside(node: tuple[int, int]) -> Iterable[tuple[int, int]]:
        for i in (-1, 0, 1):
            for j in (-1, 0, 1):
                near = node[0] + i, node[1] + j
                inside = all(0 <= n < most for n, most in zip(near, free.shape, strict=True))
                if inside and free[near]:
                    yield near

    path = shortest(nodes[0], nodes[1], beside)
    return [(float(xs[i]), float(ys[j])) for i, j in path[1:]] if path else []


def shortest(start: Node, end: Node, beside: Callable[[Node], Iterable[Node]]) -> list[Node] | None:
    """Return the path of fewest nodes, both ends included; None if there is none."""
    before: dict[Node, Node | None] = {start: None}
    queue = deque([start])
    while queue and end not in before:
        here = queue.popleft()
        for near in beside(here):
            if near not in before:
                before[near] = here
                queue.append(near)
    if end not in before:
        return None
    path, node = [], end
    while node is not None:
        path.append(node)
        node = before[node]  # type: ignore[assignment]  # the start's is None, and ends it
    return path[::-1]


def turns_of(path: Sequence[tuple[int, ...]]) -> list[tuple[int, ...]]:
    """Return the ends of a path and where it turns off."""
    step = [tuple(np.subtract(b, a)) for a, b in pairwise(path)]
    corners = [path[n] for n in range(1, len(path) - 1) if step[n - 1] != step[n]]
    return [path[0], *corners, path[-1]]
