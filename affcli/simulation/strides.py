"""One push in steps as long as what happens allows: the fast way to the end of `short_steps`.

Only where something changes are short steps needed. What does, and what is done about it:

- **A contact begins.** The tool penetrates the puck by as much as it moves in one step. So nothing
  is longer than a short step until the contact has lasted for some; and so is nothing that could
  bring another part of the tool to the puck.
- **The tool's speed changes**, in the ramps, and the puck moves on as it moved. If that asks for
  less than the table's friction can do, the puck follows: its velocity is scaled by the change, and
  what that leaves out, its inertia, acts as a force against it (d'Alembert).
- **The puck goes another way**, around a corner or off an edge. The engine moves it by the velocity
  at the beginning of a step. Half of the change of the velocity is added afterwards (the rule of
  the trapezoid), so that a puck that goes around a corner goes around it and does not leave it; and
  a stride is as long as this correction, summed over the puck and its rim, is no more than `FINE`.

A stride changes nothing before the first contact, so a push that begins just before it has the same
bits as one that is simulated whole. Against steps of 1/2048 s 99 % of pushes end within 0.01 in.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from affcli.core.geometry import ConvexPolygon, Point, Pose
from affcli.core.workspace import PuckGeometry, SurfaceFriction
from affcli.simulation.puck_and_tool import PuckAndTool
from affcli.simulation.wrist_motion import STAIR, STEP, Stretch

LONGEST = 4
"""A stride is at most so many short steps: with longer ones the solver's own error shows."""
STEADY, LONG = 1e-4, 16
"""But it may be so many where nothing changes: where what is corrected is less than this share of
how far the tool goes."""
SETTLE = 2
"""A contact must last this many short steps before longer ones: the impulse of the impact, from
which the engine starts the next step, has to fade."""
FINE = 0.001
"""How far a stride may be off before it is corrected (in)."""
COARSE = 4.0 * FINE
"""What would be corrected by more (in) is no change of the way: a contact began or ended."""
NOTHING = 0.01 * FINE
"""So little (in) is not corrected."""
MARGIN = 1.5
"""Puck and tool approach each other at most this much faster than the tool moves."""
EASY = 0.5
"""A puck follows a tool whose speed changes by up to this share of what the table's friction would
change it by."""
STILL = 1e-3
"""A puck rests that moves no faster (in/s): friction stops it within a billionth of an inch."""
TURNED = math.radians(0.25)
"""When the puck has turned by as much (rad), its brakes are turned after it."""
REST_STEPS = 512
"""Friction stops a puck pushed at 5 in/s within 0.04 s; after a second something is wrong."""

Moment = Callable[[float, float, Pose], None]
"""Called after each short step: seconds since it began, the tool's travel or arc (in), the puck's
pose."""


class Course(NamedTuple):
    """How a tool moves against a puck.

    Args:
        bodies: the two, laid out.
        move: gives the tool a speed (in/s), which it keeps.
        seen: returns where the puck's centre is in the tool's own frame (in).
        fastest: no point of the tool moves faster than this many times that speed.
    """

    bodies: PuckAndTool
    move: Callable[[float], None]
    seen: Callable[[], tuple[float, float]]
    fastest: float


class Surroundings:
    """What is near a puck: distances to the parts of a tool.

    Args:
        parts: convex parts of the tool (in, tool frame).
        radius: of the puck (in).
    """

    def __init__(self, parts: Sequence[ConvexPolygon], radius: float) -> None:
        # A box is its own bounding box; the distance to a part that is none takes longer to find.
        self._parts = [(*part.bounds, None if part.is_box else part) for part in parts]
        self._radius = radius

    def __call__(self, x: float, y: float) -> tuple[int, float]:
        """Return how many parts a puck at (x, y) overlaps, and how far the nearest other is (in).

        Args:
            x, y: the puck's centre (in, tool frame).
        """
        touched, clearance, radius = 0, math.inf, self._radius
        for left, bottom, right, top, slanted in self._parts:
            # `_gap`, written out: this is the innermost of our own loops.
            dx = left - x if x < left else x - right if x > right else 0.0
            dy = bottom - y if y < bottom else y - top if y > top else 0.0
            gap = math.hypot(dx, dy) - radius
            if gap < 0.0 and slanted is not None:
                gap = slanted.distance(Point(x, y)) - radius
            if gap < 0.0:
                touched += 1
            elif gap < clearance:
                clearance = gap
        return touched, clearance

    def closing(self, before: tuple[float, float], now: tuple[float, float]) -> float:
        """Return by which share of what is left the gap to a part closes, that which is met first.

        Args:
            before, now: centres of the puck (in, tool frame).
        """
        gaps = ((self._gap(part, *before), self._gap(part, *now)) for part in self._parts)
        return max(((far - near) / near for far, near in gaps if near > 0.0), default=0.0)

    def _gap(
        self, part: tuple[float, float, float, float, ConvexPolygon | None], x: float, y: float
    ) -> float:
        """Return how far a puck at (x, y) is from a part, or from the box about it (in)."""
        left, bottom, right, top, slanted = part
        dx = left - x if x < left else x - right if x > right else 0.0
        dy = bottom - y if y < bottom else y - top if y > top else 0.0
        gap = math.hypot(dx, dy) - self._radius
        return slanted.distance(Point(x, y)) - self._radius if gap < 0.0 and slanted else gap


class Strides:
    """Takes one push to its end, or to where the puck lies still behind the tool.

    Args:
        course: the push.
        around: tells what is near the puck.
        puck, friction: which, and on what.
        watch: called after each short step.
        elapsed, gone: seconds since the motion began, and how far the tool is (in).
    """

    def __init__(
        self,
        course: Course,
        around: Surroundings,
        puck: PuckGeometry,
        friction: SurfaceFriction,
        watch: Moment | None = None,
        elapsed: float = 0.0,
        gone: float = 0.0,
    ) -> None:
        self._bodies, self._move, self._seen, self._fastest = course
        self._around, self._radius = around, puck.radius
        self._easy = EASY * friction.puck_table * friction.gravity
        self._watch = watch
        self.elapsed, self.gone = elapsed, gone
        self._velocity = (0.0, 0.0, 0.0)
        self._slowing = self._turned = self._nearer = 0.0
        self._touched = self._lasted = 0
        self._stride = self._last = 1
        self._met = False
        self._center = (0.0, 0.0)

    def run(self, motion: tuple[Stretch, ...]) -> tuple[Stretch, ...]:
        """Move the tool; return what is left of the motion once the puck lies still behind it."""
        before = 0.0
        for k, (speed, steps) in enumerate(motion):
            self._move(speed)
            self._nearer = MARGIN * self._fastest * speed * STEP
            self._slowing = self._follow(before, speed, steps) if before else 0.0
            before, left = speed, steps
            while left:
                stride = self._next(left)
                if not stride:
                    return (Stretch(speed, left), *motion[k + 1 :])
                left -= stride
                self._advance(speed, stride)
        self._move(0.0)
        if not self._follows(before, STAIR):
            self._settle()
        return ()

    def _follows(self, change: float, steps: int) -> bool:
        """Tell whether the puck follows a tool whose speed changes by so much within some steps."""
        lasting = self._touched and self._lasted >= SETTLE
        return bool(lasting) and abs(change) * self._fastest <= self._easy * steps * STEP

    def _follow(self, before: float, speed: float, steps: int) -> float:
        """Let the puck follow a tool that has another speed now, if it does.

        Returns:
            What share of its speed its inertia takes from it, until the next change (1/s).
        """
        if not self._follows(speed - before, steps):
            return 0.0
        x, y, turning = self._velocity
        ratio = speed / before
        self._velocity = (ratio * x, ratio * y, ratio * turning)
        self._bodies.set_velocity(*self._velocity)
        return (1.0 - before / speed) / (steps * STEP)

    def _next(self, left: int) -> int:
        """Return how many short steps the next stride takes; 0 when the puck lies still, the tool
        having left it.

        Args:
            left: short steps left at this speed.
        """
        before, self._center = self._center, self._seen()
        touched, clearance = self._around(*self._center)
        free = left if clearance >= left * self._nearer else int(clearance / self._nearer)
        if touched != self._touched:
            self._touched, self._lasted, self._stride = touched, 0, 1
        if not touched:
            if self._rests():
                return 0 if self._met else max(1, free)
            return 1
        self._met = True
        if self._lasted < SETTLE:
            return 1
        stride = min(self._stride, left)
        if free < stride:
            # Near another part, but maybe not on the way to it.
            closing = self._around.closing(before, self._center) / self._last
            stride = max(1, int(min(stride, 1.0 / (MARGIN * closing) if closing > 0.0 else stride)))
        return stride

    def _rests(self) -> bool:
        """Tell whether the puck lies still."""
        x, y, turning = self._velocity
        return math.hypot(x, y) + self._radius * abs(turning) < STILL

    def _advance(self, speed: float, stride: int) -> None:
        """Make a stride, and see how long the next may be."""
        bodies, seconds, slowing = self._bodies, stride * STEP, self._slowing
        began = None if self._watch is None else bodies.puck_pose()
        other = stride != self._last
        if other:
            bodies.other_steps(seconds)
            self._last = stride
        x, y, turning = self._velocity
        lasting = self._touched and self._lasted >= SETTLE
        if slowing and lasting:
            bodies.accelerate(-slowing * x, -slowing * y, -slowing * turning)
        bodies.step(seconds)
        self._velocity = after = bodies.velocity()
        if self._touched:
            half = 0.5 * seconds
            dx, dy, turn = half * (after[0] - x), half * (after[1] - y), half * (after[2] - turning)
            off = math.hypot(dx, dy) + self._radius * abs(turn)
            if lasting and NOTHING < off <= COARSE:
                bodies.shift(dx, dy, turn)
            self._lasted += 1
            if off > FINE:
                self._stride = max(1, stride // 2)
            elif 4.0 * off < FINE and not other:
                most = LONG if off < STEADY * seconds * speed else LONGEST
                self._stride = min(most, max(self._stride, 2 * stride))
        self._turned += seconds * turning
        if abs(self._turned) > TURNED:
            bodies.align_brakes()
            self._turned = 0.0
        if began is not None:
            self._show(began, speed, stride)

    def _settle(self) -> None:
        """Let the puck come to rest after the tool has stopped."""
        self._bodies.other_steps(STEP)
        for _ in range(REST_STEPS):
            if self._rests():
                return
            began = None if self._watch is None else self._bodies.puck_pose()
            self._bodies.step(STEP)
            self._velocity = self._bodies.velocity()
            if began is not None:
                self._show(began, 0.0, 1)

    def _show(self, began: Pose, speed: float, steps: int) -> None:
        """Show the puck after each of some short steps, in which it went straight on."""
        ends = self._bodies.puck_pose()
        for k in range(1, steps + 1):
            self.elapsed += STEP
            self.gone += speed * STEP
            share = k / steps
            pose = Pose(*(a + share * (b - a) for a, b in zip(began, ends, strict=True)))
            if self._watch is not None:
                self._watch(self.elapsed, self.gone, ends if k == steps else pose)
