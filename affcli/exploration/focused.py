"""Focused exploration: of many tries that could be made next, the most interesting one (§8).

§8: "Different strategies that become less random and more focused as information is structured by
the robot during the exploration could be used to speed up the learning process." All of them draw
tries in one way and remember the same; each is a function that says how interesting a try is.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall
from affcli.core.choice import Reaches
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.core.trial import BabblingRecord
from affcli.exploration.memory import Memory
from affcli.exploration.random_babbling import drawn
from affcli.exploration.tries import Numbers, Tries

Interest = Callable[[Tries, Memory, np.random.Generator], Numbers]
"""How interesting tries are (n,), not below 0; it may draw from the robot's choices."""

PARAMS: Mapping[str, Setting] = {
    "contact": Setting(
        0.03, "", "Probability of contact in a cell of which nothing is known.", 0.001, 0.5
    ),
    "cell": Setting(0.5, "in", "Width of the cells.", 0.1, 5.0),
    "near": Setting(
        1.0, "in", "A row makes a try of its behavior less new that begins this near.", 0.1, 10.0
    ),
    "places": Setting(
        *(1.0, ""),
        "How much a try loses with each that began about where it would leave the attractor.",
        *(0.0, 100.0),
    ),
    "place": Setting(2.0, "in", "Width of the cells of the table in which that counts.", 1.0, 20.0),
}
"""Of all focused explorers. The defaults were chosen on seeds 100 to 149."""

VERSION = 2
"""Of the focused explorers: since 2 they know that a turn moves the tool, too."""
MOST_TRIES = 4096
"""Weighed at once, however many places babbling draws."""


class Focused:
    """An `Explorer` that makes the most interesting of the tries that it draws.

    Args:
        interest: how interesting tries are.
        exploratory: the calls to draw from.
        box: where the attractor may stand to the wrist.
        rng: the robot's choices.
        places: how much a try loses with each that began about where it would leave the attractor.
        remembering: the others of `PARAMS`, which `Memory` takes.
    """

    def __init__(
        self,
        interest: Interest,
        exploratory: Sequence[BehaviorCall],
        box: BabblingSettings,
        rng: np.random.Generator,
        *,
        places: float,
        **remembering: float,
    ) -> None:
        self._interest, self._exploratory, self._rng = interest, exploratory, rng
        self._box = replace(box, draws=min(box.draws, MOST_TRIES))
        self._memory = Memory(len(exploratory), box, **remembering)
        self._dislike = places
        self._places, self._calls = np.empty((0, 2)), np.empty(0, dtype=np.intp)

    def places(self, seen: Observation, reaches: Reaches) -> Numbers:
        """Return drawn places, that of the most interesting try first.

        Tries of a behavior whose way is not known come before all others; those whose beginning is
        likely to be blocked come last.
        """
        memory, places = self._memory, drawn(self._box, self._rng)
        calls = self._rng.integers(len(self._exploratory), size=len(places))
        tries = Tries.of(calls, places, memory, seen, reaches)
        end = np.array(seen.object_position) + tries.movement(memory.contacts.contact)
        score = self._interest(tries, memory, self._rng)
        score = score / (1.0 + self._dislike * memory.visits(end))
        score[memory.contacts.occupied[tries.cells][:, 0]] = -math.inf
        score[memory.looks[calls] > 0] = math.inf
        order = np.argsort(-score, kind="stable")
        self._places, self._calls = places[order], calls[order]
        return self._places.copy()

    def refused(self, place: Point) -> None:
        """Remember that the tool cannot be lowered there."""
        self._memory.contacts.blocked(place)

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        """Return the behavior that was drawn with the place."""
        number = int(np.flatnonzero((self._places == place).all(axis=1))[0])
        return self._exploratory[int(self._calls[number])]

    def tell(self, record: BabblingRecord) -> None:
        """Remember what came of it."""
        self._memory.learn(self._exploratory.index(record.execution.call), record)

    def state(self) -> dict[str, Any]:
        """Return what it remembers."""
        return self._memory.state()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Remember what `state` gave."""
        self._memory.restore(state)


def focused(name: str, summary: str, source: str, interest: Interest) -> Part:
    """Return the explorer that makes the tries of most interest."""
    return Part("explorers", name, summary, source, partial(Focused, interest), PARAMS, VERSION)
