"""Random babbling: any place in the box, any behavior, with equal chances (§3.2, §6)."""

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.behaviors.moving import paper_repertoire
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Point
from affcli.exploration.random_babbling import RandomBabbling
from affcli.testing.examples import anywhere
from tests.factories import observation

CALLS = tuple(behavior.call for behavior in paper_repertoire())
BOX = BabblingSettings()
SEEN = observation()


def explorer(seed: int, box: BabblingSettings = BOX) -> RandomBabbling:
    return RandomBabbling(CALLS, box, np.random.default_rng(seed))


def calls(seed: int, number: int) -> list[BehaviorCall]:
    """Return the behaviors that are tried, a place being drawn before each."""
    babbling = explorer(seed)
    drawn = []
    for _ in range(number):
        place = Point(*babbling.places(SEEN, anywhere)[0].tolist())
        drawn.append(babbling.behavior(place, SEEN))
    return drawn


@given(st.integers(0, 2**32), st.floats(0.1, 20.0), st.floats(0.1, 20.0), st.floats(0.1, 20.0))
def test_offsets_are_drawn_from_one_box_whatever_the_tool(
    seed: int, width: float, low: float, height: float
) -> None:
    """§4, Fig. 4: the shape of the tool "is not required and used": one box serves all."""
    box = replace(BOX, offset_x_max=width, offset_y_min=low, offset_y_max=low + height)
    places = explorer(seed, box).places(SEEN, anywhere)
    assert places.shape == (box.draws, 2)
    assert (np.abs(places[:, 0]) <= width).all()
    assert (places[:, 1] >= low).all()
    assert (places[:, 1] <= low + height).all()


def test_offsets_fill_the_box_evenly() -> None:
    """Kolmogorov-Smirnov: the largest gap between the distribution drawn and a uniform one is of
    the order 1 / sqrt(n); 2.5 / sqrt(n) is exceeded in one of 100,000 honest runs."""
    n = 2048
    x, y = explorer(7, replace(BOX, draws=n)).places(SEEN, anywhere).T
    x = (x / BOX.offset_x_max + 1.0) / 2.0
    y = (y - BOX.offset_y_min) / (BOX.offset_y_max - BOX.offset_y_min)
    for shares in (np.sort(x), np.sort(y)):
        assert np.abs(shares - (np.arange(n) + 0.5) / n).max() < 2.5 / math.sqrt(n)
    assert abs(float(np.corrcoef(x, y)[0, 1])) < 5.0 / math.sqrt(n)


@pytest.mark.parametrize("seed", range(5))
def test_every_behavior_and_distance_is_chosen_about_equally_often(seed: int) -> None:
    """§3.2: babbling "picks binding and exploratory behaviors at random": four behaviors, two
    distances each. Chi-square of seven degrees of freedom exceeds 40 once in a million runs."""
    n = 4000
    drawn = Counter(calls(seed, n))
    assert set(drawn) == set(CALLS)
    assert len(CALLS) == 8
    even = n / len(CALLS)
    assert sum((times - even) ** 2 / even for times in drawn.values()) < 40.0


def test_the_behavior_chosen_does_not_depend_on_the_one_before() -> None:
    """Chi-square of 49 degrees of freedom over pairs exceeds 120 once in ten million runs."""
    drawn = calls(3, 6400)
    pairs = Counter(zip(drawn[::2], drawn[1::2], strict=True))
    even = 3200 / 64
    assert sum((pairs[a, b] - even) ** 2 / even for a in CALLS for b in CALLS) < 120.0
