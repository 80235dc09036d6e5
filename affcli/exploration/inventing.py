"""Inventing behaviors: motor schemas composed, tried, and kept where they bring something new (§8).

§7.1, §8: a robot with "the capability of learning new exploratory behaviors" could pull with a
stick. It babbles with what it can do; composes turns and straight moves and tries them; of those
that moved the attractor it takes the one that brings most, tries it again, and keeps it when that
gives the same again; and so on. What brings most is what moves the attractor in directions and at
places where nothing in its repertoire does.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from affcli.core.affordance import Affordance, replicates
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall, composed, composed_motion
from affcli.core.choice import Reaches
from affcli.core.geometry import Point, direction_degrees
from affcli.core.invention import Invention
from affcli.core.motion import Motion, Slide, Turn, motion_from_json, motion_json
from affcli.core.observation import Movement, Observation
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.core.trial import BabblingRecord
from affcli.exploration.random_babbling import drawn

VERSION = 1
"""Of the state."""
WIDTH, DEPTH = 4.0, 3.0
"""Of the cells of the table in which it is counted where the attractor can be moved (in)."""
SECTOR = 30.0
"""Width of the sectors of directions in which it is counted where to (degrees)."""
LEAST_GAIN = 3
"""Cells of place and direction: what brings fewer is not tried again."""
SHORT, DISCOUNT = 3.0, 0.15
"""What moves the attractor farther (in) counts for less, by so much an inch: it may push it off the
table."""
TRIES, GOOD = 3, 2
"""Of so many tries so many must move the attractor alike for a behavior to be kept."""
JITTER = 0.4
"""As far beside the place where it was found it is tried again, at most, along x and y (in)."""
ALIKE = 1.5
"""The attractor moved alike when it ends this near (in), and the movement replicates (§5.2)."""
LEAST_TURN, LEAST_SLIDE = 5.0, 1.0
"""A motor schema turns or moves at least so far (degrees, in)."""
MOST_IDEAS = 300
"""Remembered at once: a state must have room in a database."""
MOST_ROWS = 2_000
"""Remembered of the repertoire, likewise."""
PATIENCE = 100
"""So often in a row the attractor is put back to try a behavior again; then it is given up."""
MOST_GIVEN_UP = 5
"""Before one behavior."""
PLACES = 8
"""At once, to try a behavior again."""

PARAMS: Mapping[str, Setting] = {
    "babbling": Setting(
        *(30.0, "min", "First the robot babbles for so long with what it can do."),
        *(0.1, 600.0),
    ),
    "composing": Setting(
        *(20.0, "min", "Then it composes behaviors and tries each once for so long."),
        *(0.1, 600.0),
    ),
    "turn": Setting(45.0, "degrees", "A schema turns the wrist by at most so much.", 5.0, 180.0),
    "slide": Setting(5.0, "in", "A schema moves the wrist at most so far.", 1.0, 20.0),
    "schemas": Setting(1, "", "At most so many schemas follow one another.", 1, 5),
    "most": Setting(6, "", "So many behaviors are kept at most.", 1, 20),
}


class Idea(NamedTuple):
    """A composed behavior that moved the attractor once.

    Args:
        motion: what it is composed of.
        x, y: where the attractor stood to the wrist (in).
        dx, dy: how it moved (in).
        step: the behavior of the run.
    """

    motion: Motion
    x: float
    y: float
    dx: float
    dy: float
    step: int

    @property
    def movement(self) -> Movement:
        """How the attractor moved."""
        return Movement(self.dx, self.dy, 0.0)

    def json(self) -> list[Any]:
        """Return it as JSON types."""
        return [motion_json(self.motion), *self[1:]]

    @classmethod
    def from_json(cls, value: Any) -> "Idea":
        """Return what `json` wrote; ValueError or TypeError for anything else."""
        motion, x, y, dx, dy, step = value
        made = cls(motion_from_json(motion), float(x), float(y), float(dx), float(dy), int(step))
        if not all(map(math.isfinite, made[1:])):
            raise ValueError("a place that is none")
        return made


class Tested(NamedTuple):
    """An idea that is tried again, or was.

    Args:
        idea: the idea.
        gain: what it brings, in cells.
        tries: the behaviors in which it was tried, each with whether it moved the attractor alike.
    """

    idea: Idea
    gain: int
    tries: tuple[tuple[int, bool], ...] = ()

    @property
    def good(self) -> int:
        """How many tries speak for it."""
        return sum(alike for _, alike in self.tries)

    @property
    def kept(self) -> bool:
        """Enough do."""
        return self.good >= GOOD

    @property
    def decided(self) -> bool:
        """More tries cannot change that."""
        return self.kept or len(self.tries) - self.good > TRIES - GOOD

    def json(self) -> list[Any]:
        """Return it as JSON types."""
        return [self.idea.json(), self.gain, [list(one) for one in self.tries]]

    @classmethod
    def from_json(cls, value: Any) -> "Tested":
        """Return what `json` wrote; ValueError or TypeError for anything else."""
        idea, gain, tries = value
        tried = tuple((int(step), bool(alike)) for step, alike in tries)
        return cls(Idea.from_json(idea), int(gain), tried)


@dataclass(frozen=True, slots=True)
class Limits:
    """How long it takes, and how far it goes.

    Args:
        babbling, composing: minutes of the robot clock for which the robot does so.
        turn, slide: how far a motor schema goes at most (degrees, in).
        schemas: how many follow one another at most.
        most: so many behaviors are kept at most.
    """

    babbling: float
    composing: float
    turn: float
    slide: float
    schemas: int
    most: int


class Inventing:
    """An `Explorer` that invents; an `Inventor`.

    Args:
        exploratory: the calls that the robot has.
        box: where the attractor may stand to the wrist.
        rng: the robot's choices.
        limits: how long it takes, and how far it goes.
    """

    def __init__(
        self,
        exploratory: Sequence[BehaviorCall],
        box: BabblingSettings,
        rng: np.random.Generator,
        limits: Limits,
    ) -> None:
        self._given, self._box, self._rng = tuple(exploratory), box, rng
        self._limits = limits
        self._until = 60.0 * limits.babbling, 60.0 * (limits.babbling + limits.composing)
        self._clock = 0.0
        self._cells: set[tuple[int, int]] = set()
        """Of the table: those in which the attractor was seen."""
        self._rows: set[tuple[int, int, int]] = set()
        """Of what the robot can do: where the attractor is to the wrist (in), and the sector."""
        self._ideas: list[Idea] = []
        self._tested: list[Tested] = []
        self._now: Tested | None = None
        """What is tried again now."""
        self._asked = self._given_up = 0

    @property
    def _calls(self) -> tuple[BehaviorCall, ...]:
        """What the robot can do: what it was given, and what it kept."""
        return (*self._given, *(composed(one.idea.motion).call for one in self._kept))

    @property
    def _kept(self) -> list[Tested]:
        return [one for one in self._tested if one.kept]

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        """Return uniform draws from the box; or places about that where an idea is to be tried."""
        if self._clock >= self._until[1]:
            self._choose(reaches)
        if self._now is None:
            return drawn(self._box, self._rng)
        self._asked += 1
        about = np.array([self._now.idea.x, self._now.idea.y])
        return about + JITTER * (2.0 * self._rng.random((PLACES, 2)) - 1.0)

    def refused(self, place: Point) -> None:
        """Try on."""

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        """Return what is tried again; else what the robot can do, or what it composes now."""
        if self._now is not None:
            return composed(self._now.idea.motion).call
        if self._clock < self._until[0] or len(self._kept) >= self._limits.most:
            calls = self._calls
            return calls[int(self._rng.integers(len(calls)))]
        return composed(self._drawn_motion()).call

    def tell(self, record: BabblingRecord) -> None:
        """Remember what came of it, and decide on what was tried again."""
        self._clock = record.clock
        self._asked = self._given_up = 0
        self._cells.add(_cell(record.start.object_position))
        row = record.affordance
        if self._now is not None:
            alike = row is not None and _alike(self._now.idea.movement, row.expected_movement)
            self._now = self._now._replace(tries=(*self._now.tries, (record.step, alike)))
            if self._now.decided:
                self._conclude(self._now)
        elif row is not None and row.exploratory in self._calls:
            self._add(row.start.wrist_to_object, row.expected_movement)
        elif row is not None and not row.truncated and len(self._ideas) < MOST_IDEAS:
            self._ideas.append(_idea(row))

    def inventions(self) -> tuple[Invention, ...]:
        """Return what was tried again, kept or not; and what is being tried now."""
        now = () if self._now is None or not self._now.tries else (self._now,)
        return tuple(
            Invention(composed(one.idea.motion), one.idea.step, one.gain, one.tries, one.kept)
            for one in (*self._tested, *now)
        )

    def state(self) -> dict[str, Any]:
        """Return all that it remembers."""
        return {
            "version": VERSION,
            "clock": self._clock,
            "cells": sorted(map(list, self._cells)),
            "rows": sorted(map(list, self._rows)),
            "ideas": [idea.json() for idea in self._ideas],
            "tested": [one.json() for one in self._tested],
            "now": None if self._now is None else self._now.json(),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Remember what `state` gave."""
        if state["version"] != VERSION:
            raise ValueError(f"state {state['version']!r}, not {VERSION}")
        self._clock = float(state["clock"])
        self._cells = {(int(i), int(j)) for i, j in state["cells"]}
        self._rows = {(int(x), int(y), int(sector)) for x, y, sector in state["rows"]}
        self._ideas = [Idea.from_json(one) for one in state["ideas"]]
        self._tested = [Tested.from_json(one) for one in state["tested"]]
        now = state["now"]
        self._now = None if now is None else Tested.from_json(now)

    def _choose(self, reaches: Reaches) -> None:
        """Choose what is tried again now: nothing when enough is kept, or nothing brings enough."""
        if self._now is not None and self._asked >= PATIENCE:
            self._given_up += 1
            self._conclude(self._now)
        if (
            self._now is None
            and len(self._kept) < self._limits.most
            and self._given_up < MOST_GIVEN_UP
        ):
            gains = self._gains(reaches)
            worth = [gain * _weight(idea) for gain, idea in zip(gains, self._ideas, strict=True)]
            best = int(np.argmax(worth)) if worth else 0
            if worth and gains[best] >= LEAST_GAIN:
                self._now, self._asked = Tested(self._ideas.pop(best), gains[best]), 0

    def _conclude(self, tested: Tested) -> None:
        """Note what came of an idea; what it does, the robot can do now if it is kept."""
        self._tested.append(tested)
        self._now, self._asked = None, 0
        if tested.kept:
            self._add(Point(tested.idea.x, tested.idea.y), tested.idea.movement)
            motion = tested.idea.motion
            self._ideas = [idea for idea in self._ideas if idea.motion != motion]

    def _add(self, offset: Point, moved: Movement) -> None:
        """Remember a movement that the robot can bring about."""
        if len(self._rows) < MOST_ROWS:
            self._rows.add((round(offset.x), round(offset.y), _sector(moved)))

    def _gains(self, reaches: Reaches) -> list[int]:
        """Return in how many cells of place and direction each idea moves the attractor alone.

        From a place the attractor can be moved by what begins where the arm then reaches.
        """
        at = np.array(sorted(self._cells), dtype=float) + 0.5
        x, y = WIDTH * at[:, 0], DEPTH * at[:, 1]
        covered: dict[int, NDArray[np.bool_]] = {}
        for px, py, sector in sorted(self._rows):
            there = covered.setdefault(sector, np.zeros(len(at), dtype=bool))
            there |= _reached(reaches, x - px, y - py)
        gains = []
        for idea in self._ideas:
            new = _reached(reaches, x - idea.x, y - idea.y)
            sector = _sector(idea.movement)
            gains.append(int((new & ~covered[sector]).sum() if sector in covered else new.sum()))
        return gains

    def _drawn_motion(self) -> Motion:
        """Return motor schemas that follow one another: turns and straight moves alike often."""
        count = int(self._rng.integers(1, self._limits.schemas + 1))
        return tuple(self._drawn_schema() for _ in range(count))

    def _drawn_schema(self) -> Turn | Slide:
        """Return a turn by whole degrees, or a straight move in any direction (tenths of in)."""
        kind, far, way = self._rng.random(3).tolist()
        if kind < 0.5:
            degrees = round(LEAST_TURN + far * (self._limits.turn - LEAST_TURN))
            return Turn(math.copysign(degrees, way - 0.5))
        length, angle = LEAST_SLIDE + far * (self._limits.slide - LEAST_SLIDE), 2.0 * math.pi * way
        # Adding 0.0 makes the -0.0 that rounding may give a plain 0.
        dx, dy = (round(length * part, 1) + 0.0 for part in (math.cos(angle), math.sin(angle)))
        return Slide(dx, dy)


def _cell(place: Point) -> tuple[int, int]:
    """Return the cell of the table that a place lies in."""
    return math.floor(place.x / WIDTH), math.floor(place.y / DEPTH)


def _sector(moved: Movement) -> int:
    """Return the sector that a movement goes to: 0 to the right, then counter-clockwise."""
    return round(direction_degrees(moved.dx, moved.dy) / SECTOR) % round(360.0 / SECTOR)


def _weight(idea: Idea) -> float:
    """Return for how much a cell counts that an idea brings."""
    return 1.0 / (1.0 + DISCOUNT * max(0.0, idea.movement.distance - SHORT))


def _alike(expected: Movement, seen: Movement) -> bool:
    """Tell whether the attractor moved as it did before."""
    apart = math.hypot(seen.dx - expected.dx, seen.dy - expected.dy)
    return replicates(expected, seen) and apart <= ALIKE


def _idea(row: Affordance) -> Idea:
    """Return what a row of a composed behavior says."""
    motion = composed_motion(row.exploratory)
    if motion is None:
        raise ValueError(f"{row.exploratory} is not composed")
    start, moved = row.start.wrist_to_object, row.expected_movement
    return Idea(motion, start.x, start.y, moved.dx, moved.dy, row.step)


def _reached(reaches: Reaches, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which wrist positions can be taken up, the tool straight ahead."""
    return reaches(x, y, np.zeros(len(x)))


def inventing(
    exploratory: Sequence[BehaviorCall],
    box: BabblingSettings,
    rng: np.random.Generator,
    **limits: Any,
) -> Inventing:
    """Return the explorer that invents within limits."""
    return Inventing(exploratory, box, rng, Limits(**limits))


PARTS = (
    Part(
        kind="explorers",
        name="inventing",
        summary="babbles, composes turns and straight moves, keeps what moves the attractor anew",
        source="Stoytchev 2008, §7.1, §8",
        build=inventing,
        params=PARAMS,
    ),
)
