"""What every goal must keep to."""

import math

import numpy as np

from affcli.core.geometry import Point
from affcli.core.goal import Goal
from affcli.testing.examples import observation

WRIST = Point(0.0, 10.0)


class GoalContract:
    """A goal says when it is reached, and how far from it a place is.

    A subclass gives the fixture `goal`.
    """

    def test_it_has_a_name_and_a_place(self, goal: Goal) -> None:
        assert goal.name
        assert all(map(math.isfinite, goal.center))

    def test_it_is_reached_at_its_centre_and_not_far_away(self, goal: Goal) -> None:
        center = goal.center
        assert goal.reached(observation(center, WRIST))
        assert not goal.reached(observation(Point(center.x + 500.0, center.y), WRIST))

    def test_its_outline_holds_its_centre(self, goal: Goal) -> None:
        assert goal.outline().area > 0.0
        assert goal.outline().distance(goal.center) == 0.0

    def test_distances_are_taken_to_its_centre(self, goal: Goal) -> None:
        rng = np.random.default_rng(0)
        for x, y in rng.uniform(-30.0, 30.0, (10, 2)).tolist():
            dx, dy = rng.uniform(-9.0, 9.0, (2, 25))
            given = dx.copy(), dy.copy()
            squared = goal.squared_distance(Point(x, y), dx, dy)
            expected = (x + dx - goal.center.x) ** 2 + (y + dy - goal.center.y) ** 2
            assert squared.shape == (25,)
            assert np.allclose(squared, expected)
            assert np.array_equal(given, (dx, dy)), "what is asked about must stay as it is"
        none = goal.squared_distance(Point(0.0, 0.0), np.empty(0), np.empty(0))
        assert none.shape == (0,)
