"""Random behavioral babbling: the paper's way of exploring (§3.2, §6)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall
from affcli.core.choice import Reaches
from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.part import Part
from affcli.core.trial import BabblingRecord


def drawn(box: BabblingSettings, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return uniform draws of where the attractor may stand to the wrist (n, 2) (in)."""
    places = rng.random((box.draws, 2))
    # In place: of so few numbers each array that is made takes longer than what is done with it.
    x, y = places.T
    x *= 2.0
    x -= 1.0
    x *= box.offset_x_max
    y *= box.offset_y_max - box.offset_y_min
    y += box.offset_y_min
    return places


@dataclass(frozen=True, slots=True)
class RandomBabbling:
    """Tries random behaviors at random wrist positions; an `Explorer` that remembers nothing.

    §3.2: "picks binding and exploratory behaviors at random".

    Args:
        exploratory: the calls to draw from, with equal chances.
        box: where the attractor may stand to the wrist.
        rng: the robot's choices.
    """

    exploratory: Sequence[BehaviorCall]
    box: BabblingSettings
    rng: np.random.Generator

    def places(self, seen: Observation, reaches: Reaches) -> NDArray[np.float64]:
        """Return uniform draws from the box."""
        return drawn(self.box, self.rng)

    def refused(self, place: Point) -> None:
        """Draw on."""

    def behavior(self, place: Point, start: Observation) -> BehaviorCall:
        """Return a random behavior with a random value of its parameter."""
        return self.exploratory[int(self.rng.integers(len(self.exploratory)))]

    def tell(self, record: BabblingRecord) -> None:
        """Forget it."""

    def state(self) -> dict[str, Any]:
        """Return nothing: all is in the random stream."""
        return {}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Refuse any other state than none."""
        if state:
            raise ValueError("random babbling remembers nothing")


PARTS = (
    Part(
        kind="explorers",
        name="random",
        summary="the paper's: random behaviors at random wrist positions",
        source="Stoytchev 2008, §3.2, §6",
        build=RandomBabbling,
    ),
)
