"""A second opinion on pushing: a quasi-static solver that shares no code with the simulation.

A disc presses evenly on the table; a tool of convex parts moves straight, or turns about a point,
and pushes it. Nothing has inertia: at each instant the table's friction balances the contact
forces. Lengths are in inches, forces in units of the table's friction (mu m g) and torques in units
of that times the radius.

**The table.** A disc that moves at v and turns at w about its centre turns about a point at the
distance d = |v| / |w| from its centre. In polar coordinates about that point every element of area
moves along the angle, so the integral over the distance is elementary and the one over the angle is
done by the trapezoidal rule: `limit_surface`. No ellipsoid is fitted.

**One contact.** It lies on the rim at -R n, with n the unit normal into the disc and t = n turned
left. A contact force N (n + f t) is, by symmetry, met by a velocity along itself, v = v_n (1, f),
and by the turning s = R |w| / |v| at which torque / force of the limit surface is
|f| / sqrt(1 + f^2).
The rim at the contact then moves by v_n K(f) along t, with K(f) = f + sqrt(1 + f^2) s(f), which
grows with f. So the modes are solved outright: the contact sticks with the f for which K(f) is the
tool's ratio of tangential to normal velocity, if that |f| <= mu; otherwise it slides with f = +-mu.

**Two contacts.** If either of them alone would leave the other free, it alone acts. Otherwise both
stay closed; then the disc can only move as the tool does, and turns as it does.

**Time.** All is reckoned in axes that move with the tool. It advances by a small stride; the
overlap that results is the normal displacement of the stride. Strides and quadrature nodes are
chosen by the tests of convergence.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from affcli.core.geometry import ConvexPolygon, Point, Pose

Array: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]

STRIDE = 2e-3
"""Travel of the tool in a step (in)."""
NODES = 256
"""Angles of the quadrature."""
TURNINGS = 2048
"""Entries of the table from tangential velocity to contact force."""
CLOSED = 1e-9
"""Overlaps below this (in) do not count: far above rounding, far below a stride."""


@dataclass(frozen=True, slots=True)
class Push:
    """One push: the tool moves straight, or turns where it is.

    Args:
        parts: convex parts of the tool where the motion starts (in, table frame).
        direction: unit vector of the motion.
        length: of the motion; of a turn the way of the part that is farthest from the pivot (in).
        puck: pose of the disc at rest before it (in, rad).
        turn: by how much the tool turns (rad); then it does not move along `direction`.
        pivot: about which it turns (in, table frame).
    """

    parts: tuple[ConvexPolygon, ...]
    direction: Point
    length: float
    puck: Pose
    turn: float = 0.0
    pivot: Point = Point(0.0, 0.0)


def limit_surface(distance: float, nodes: int = NODES) -> tuple[float, float]:
    """Return force and torque that turn the disc about a point at `distance` radii of its centre.

    Force in units of mu m g, torque about the centre in units of mu m g R.
    """
    if distance < 1.0:
        angle = (np.arange(nodes) + 0.5) * (2.0 * np.pi / nodes)
        rim = distance * np.cos(angle) + np.sqrt(1.0 - (distance * np.sin(angle)) ** 2)
        force = float(np.mean(np.cos(angle) * rim**2))
        return force, float(np.mean(rim**3)) * 2.0 / 3.0 - distance * force
    # Outside, the substitution sin(angle) = sin(theta) / distance takes the roots out of the ends.
    theta = ((np.arange(nodes) + 0.5) / nodes - 0.5) * np.pi
    cos_angle = np.sqrt(1.0 - (np.sin(theta) / distance) ** 2)
    force = 2.0 * float(np.mean(cos_angle * np.cos(theta) ** 2))
    return force, 2.0 / 3.0 / distance * float(np.mean(np.cos(theta) ** 4 / cos_angle))


@dataclass(frozen=True, slots=True)
class ContactLaw:
    """What one contact does, as tables over growing f (see the module's docstring).

    Args:
        force: f, tangential over normal force; from -mu to mu.
        rim: K(f), tangential over normal velocity of the rim at the contact.
        turning: -R w / v_n.
    """

    force: Array
    rim: Array
    turning: Array

    def __call__(self, normal: Array, tangential: Array, _: Array) -> tuple[Array, Array]:
        """Return tangential displacement of the centre and clockwise turn of the rim (in, in).

        Args:
            normal: displacement of the tool along n, > 0 (in).
            tangential: displacement of the tool along t (in).
            _: where the heavy side is, for a disc that has one.
        """
        # np.interp holds the ends: beyond them the contact slides.
        ratio = tangential / normal
        force = np.interp(ratio, self.rim, self.force)
        return normal * force, normal * np.interp(ratio, self.rim, self.turning)


@lru_cache
def contact_law(friction: float, nodes: int = NODES) -> ContactLaw:
    """Return the law of a contact with the coefficient `friction`."""
    turning = np.tan(np.linspace(0.0, 0.5 * np.pi, TURNINGS, endpoint=False))
    pairs = [limit_surface(1.0 / s, nodes) if s else (1.0, 0.0) for s in turning]
    lever = np.array([torque / force for force, torque in pairs])
    needed = int(np.searchsorted(lever, friction / np.hypot(1.0, friction))) + 1
    lever, turning = lever[:needed], turning[:needed]
    force = lever / np.sqrt(1.0 - lever**2)
    turn = np.hypot(1.0, force) * turning
    end = np.interp(friction, force, turn)
    force = np.append(force[force < friction], friction)
    turn = np.append(turn[: force.size - 1], end)
    force = np.concatenate([-force[:0:-1], force])
    turn = np.concatenate([-turn[:0:-1], turn])
    return ContactLaw(force, force + turn, turn)


@dataclass(frozen=True, slots=True)
class UnevenLaw:
    """The law of a contact of a disc that presses with 1 + 3 e cos, by the angle from its heavy
    side; see `uneven_law`.

    Args:
        force: f, as in `ContactLaw` (F,).
        rim, aside, turning: K(f), tangential velocity of the centre, and -R w, all over v_n, by the
            angle from n to the heavy side, which goes around in equal steps (A, F).
    """

    force: Array
    rim: Array
    aside: Array
    turning: Array

    def __call__(self, normal: Array, tangential: Array, heavy: Array) -> tuple[Array, Array]:
        """Return tangential displacement of the centre and clockwise turn of the rim (in, in)."""
        angles = len(self.rim)
        place = heavy / (2.0 * np.pi) * angles
        low, share = np.floor(place).astype(np.intp), (place - np.floor(place))[:, None]

        def between(table: Array) -> Array:
            mixed: Array = (1.0 - share) * table[low % angles] + share * table[(low + 1) % angles]
            return mixed

        rim, aside, turning = map(between, (self.rim, self.aside, self.turning))
        ratio = np.clip(tangential / normal, rim[:, 0], rim[:, -1])
        at = np.clip((rim <= ratio[:, None]).sum(axis=1) - 1, 0, rim.shape[1] - 2)
        each = np.arange(len(at))
        part = (ratio - rim[each, at]) / (rim[each, at + 1] - rim[each, at])

        def along(table: Array) -> Array:
            value: Array = table[each, at] + part * (table[each, at + 1] - table[each, at])
            return value

        return normal * along(aside), normal * along(turning)


@lru_cache
def uneven_law(friction: float, offset: float, angles: int = 24, forces: int = 9) -> UnevenLaw:
    """Return the law of a contact of a disc whose centre of mass lies `offset` radii off centre.

    For each f the disc's twist is the one of least power of the table's friction among those on
    which the contact force does one unit of work: there the friction is along that force. Found by
    Newton's method for all angles and f at once, the power as a sum over small areas (R = 1).
    """
    rings, spokes = 12, 60
    radius = ((np.arange(rings) + 0.5) / rings)[:, None]
    around = (np.arange(spokes) + 0.5) * 2.0 * np.pi / spokes
    along, across = (radius * np.cos(around)).ravel(), (radius * np.sin(around)).ravel()
    heavy = np.arange(angles)[:, None] * 2.0 * np.pi / angles
    force = np.linspace(-friction, friction, forces)
    area = np.broadcast_to(radius, (rings, spokes)).ravel() * 2.0 / (rings * spokes)
    bearing = np.broadcast_to(around, (rings, spokes)).ravel()
    weight = np.repeat(area * (1.0 + 3.0 * offset * np.cos(bearing - heavy)), forces, axis=0)
    f = np.tile(force, angles)[:, None]
    # The velocity at each point is linear in what is sought, v_t and w: v_n = 1 - f (v_t - w).
    slopes = np.stack(
        [
            np.stack([-f + 0.0 * along, 1.0 + 0.0 * along + 0.0 * f], axis=2),
            np.stack([f - across, along + 0.0 * f], axis=2),
        ],
        axis=2,
    )
    found = np.zeros((len(f), 2))
    found[:, 0] = f[:, 0]
    step = np.full_like(found, np.inf)
    for _ in range(100):
        velocity = np.einsum("npvc,nv->npc", slopes, found)
        velocity[..., 0] += 1.0
        share = weight / np.sqrt(np.sum(velocity**2, axis=2) + 1e-6)
        gradient = np.einsum("np,npvc,npc->nv", share, slopes, velocity)
        squares = np.einsum("np,npvc,npuc->nvu", share, slopes, slopes)
        step = np.linalg.solve(squares, gradient[..., None])[..., 0]
        found -= step
        if np.abs(step).max() < 1e-6:
            break
    else:
        raise ArithmeticError(f"no twist of least power: it still moves by {np.abs(step).max():g}")
    aside, turn = (column.reshape(angles, forces) for column in found.T)
    normal = 1.0 - force * (aside - turn)
    return UnevenLaw(force, (aside - turn) / normal, aside / normal, -turn / normal)


class _Tools:
    """The parts of all tools as one array of edges, padded with points far away."""

    def __init__(self, pushes: Sequence[Push]) -> None:
        parts = max(len(push.parts) for push in pushes)
        corners = max(len(part.vertices) for push in pushes for part in push.parts)
        self._start = np.full((len(pushes), parts, corners, 2), 1e6)
        for i, push in enumerate(pushes):
            for j, part in enumerate(push.parts):
                self._start[i, j] = part.vertices[-1]
                self._start[i, j, : len(part.vertices)] = part.vertices
        self._edge = np.roll(self._start, -1, axis=2) - self._start
        square = np.sum(self._edge**2, axis=3)
        self._scale = np.divide(1.0, square, out=np.zeros_like(square), where=square > 0.0)

    def contacts(self, rows: Indices, at: Array) -> tuple[Array, Array]:
        """Return, for each part, the distance of the points `at` and the unit normal toward them.

        The points lie outside: the disc's centre never comes within a radius of a part.
        """
        from_start = at[:, None, None, :] - self._start[rows]
        edge = self._edge[rows]
        along = np.clip(np.sum(from_start * edge, axis=3) * self._scale[rows], 0.0, 1.0)
        gap = from_start - along[..., None] * edge
        square = np.sum(gap**2, axis=3)
        nearest = np.argmin(square, axis=2)[..., None]
        distance = np.sqrt(np.take_along_axis(square, nearest, axis=2)[..., 0])
        normal = np.take_along_axis(gap, nearest[..., None], axis=2)[:, :, 0] / distance[..., None]
        return distance, normal


@dataclass(frozen=True, slots=True)
class _Touched:
    """The pushes in which some part overlaps the disc, one row each.

    Args:
        rows: which pushes.
        at: centres of the discs, in the frame in which the tools rest where they began (in).
        overlap: of the disc with each part, negative where they are apart (in).
        normal: unit vectors from each part into the disc.
        move: displacement of the tool in this step where it touches with each part (in).
        heading: where the discs' own x axes point (rad).
    """

    rows: Indices
    at: Array
    overlap: Array
    normal: Array
    move: Array
    heading: Array

    def only(self, chosen: Indices | NDArray[np.bool_]) -> "_Touched":
        """Return some of the rows."""
        return _Touched(
            self.rows[chosen],
            self.at[chosen],
            self.overlap[chosen],
            self.normal[chosen],
            self.move[chosen],
            self.heading[chosen],
        )


class _Mechanics:
    """How discs answer to the overlap of one step."""

    def __init__(self, tools: _Tools, law: ContactLaw | UnevenLaw, radius: float) -> None:
        self._tools = tools
        self._law = law
        self._radius = radius

    def touched(
        self, at: Array, heading: Array, slid: Array, turned: Array, pivot: Array
    ) -> _Touched:
        """Return the pushes whose tool overlaps the disc.

        Args:
            at, heading: of the discs, as in `_Touched` (N, 2), (N,).
            slid, turned: how far the tools moved and turned in this step (N, 2), (N,).
            pivot: about which they turned (N, 2).
        """
        distance, normal = self._tools.contacts(np.arange(len(at)), at)
        arm = (at - pivot)[:, None, :] - self._radius * normal
        across = np.stack([-arm[..., 1], arm[..., 0]], axis=2)
        move = slid[:, None, :] + turned[:, None, None] * across
        every = _Touched(np.arange(len(at)), at, self._radius - distance, normal, move, heading)
        return every.only(every.overlap.max(axis=1) > CLOSED)

    def answer(self, touched: _Touched, turned: Array) -> Array:
        """Return how the discs move (in, in) and turn (rad): (N, 3).

        Args:
            touched: the discs.
            turned: how far their tools turned in this step (N,).
        """
        first = np.argmax(touched.overlap, axis=1)
        answer = self._one_contact(touched, first)
        left = self._left(touched, answer)
        held = np.flatnonzero(left.max(axis=1) > CLOSED)
        if held.size == 0:
            return answer
        first, second = first[held], np.argmax(left[held], axis=1)
        touched = touched.only(held)
        # The other part alone, if it touches by now and leaves the first one free.
        alone = self._one_contact(touched, second)
        touches = touched.overlap[np.arange(held.size), second] > CLOSED
        frees = self._left(touched, alone).max(axis=1) <= CLOSED
        both = _two_contacts(touched, first, second, turned[held])
        answer[held] = np.where((touches & frees)[:, None], alone, both)
        left = self._left(touched, answer[held]).max(axis=1)
        if np.any(left > np.sum(touched.move**2, axis=2).max(axis=1)):
            raise ArithmeticError(f"{left.max():.6f} in of overlap left: three parts hold the disc")
        return answer

    def _left(self, touched: _Touched, answer: Array) -> Array:
        """Return the overlap with each part that an answer leaves (in)."""
        return self._radius - self._tools.contacts(touched.rows, touched.at + answer[:, :2])[0]

    def _one_contact(self, touched: _Touched, part: Indices) -> Array:
        """Return how the discs move and turn when only the contact with `part` acts: (N, 3)."""
        each = np.arange(part.size)
        n = touched.normal[each, part]
        t = np.stack([-n[:, 1], n[:, 0]], axis=1)
        depth = np.maximum(touched.overlap[each, part], CLOSED)
        heavy = touched.heading - np.arctan2(n[:, 1], n[:, 0])
        aside, turned = self._law(depth, np.sum(touched.move[each, part] * t, axis=1), heavy)
        shift = depth[:, None] * n + aside[:, None] * t
        return np.column_stack([shift, -turned / self._radius])


def _two_contacts(touched: _Touched, first: Indices, second: Indices, turned: Array) -> Array:
    """Return how the discs move when both contacts stay closed: (N, 3)."""
    each = np.arange(first.size)
    normals = np.stack([touched.normal[each, first], touched.normal[each, second]], axis=1)
    depths = np.stack([touched.overlap[each, first], touched.overlap[each, second]], axis=1)
    shift = np.linalg.solve(normals, depths[..., None])[..., 0]
    return np.column_stack([shift, turned])


def _rotated(vectors: Array, angle: Array) -> Array:
    """Return vectors (N, 2) turned by angles (N,)."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = vectors.T
    return np.column_stack([cos * x - sin * y, sin * x + cos * y])


def push_all(
    pushes: Sequence[Push],
    radius: float,
    friction: float,
    stride: float = STRIDE,
    nodes: int = NODES,
    offset: float = 0.0,
) -> Array:
    """Return where the disc of each push comes to rest: (N, 3) array of x, y (in), angle (rad).

    Args:
        pushes: any number of pushes; they do not know each other.
        radius: of the disc (in).
        friction: Coulomb coefficient between the tool and the rim.
        stride: travel of the tool in a step (in).
        nodes: angles of the quadrature.
        offset: how far the discs' centres of mass lie off their middles along their own x axes, as
            a share of the radius; then the pressure is uneven and `nodes` does not count.

    Raises:
        ArithmeticError: three parts hold the disc at once, which this solver does not know.
    """
    law = uneven_law(friction, offset) if offset else contact_law(friction, nodes)
    mechanics = _Mechanics(_Tools(pushes), law, radius)
    pucks = np.array([push.puck for push in pushes], dtype=np.float64)
    turn = np.array([push.turn for push in pushes], dtype=np.float64)
    pivot = np.array([push.pivot for push in pushes], dtype=np.float64)
    direction = np.array([push.direction for push in pushes], dtype=np.float64)
    direction[turn != 0.0] = 0.0
    length = np.array([push.length for push in pushes], dtype=np.float64)
    gone = np.zeros_like(length)
    for step in range(1, int(np.ceil(length.max() / stride - 1e-9)) + 1):
        ahead = np.minimum(step * stride, length)
        slid = (ahead - gone)[:, None] * direction
        turned, angle = (ahead - gone) / length * turn, ahead / length * turn
        gone = ahead
        slid_so_far = gone[:, None] * direction
        at = _rotated(pucks[:, :2] - slid_so_far - pivot, -angle) + pivot
        touched = mechanics.touched(at, pucks[:, 2] - angle, slid, turned, pivot)
        if touched.rows.size:
            answer = mechanics.answer(touched, turned[touched.rows])
            answer[:, :2] = _rotated(answer[:, :2], angle[touched.rows])
            pucks[touched.rows] += answer
    return pucks
