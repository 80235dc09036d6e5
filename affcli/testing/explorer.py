"""What every explorer must keep to."""

import json
from collections.abc import Callable

import numpy as np
import pytest

from affcli.core.behavior import BehaviorCall, composed_motion
from affcli.core.geometry import Point
from affcli.core.ports import Explorer
from affcli.testing import examples

MakeExplorer = Callable[[np.random.Generator], Explorer]
LARGEST_STATE = 50_000
"""Letters of a state as JSON: half of what a database takes of one value."""
Tried = list[tuple[list[list[float]], BehaviorCall]]
SEEN = examples.observation(Point(1.0, 21.0), Point(0.0, 11.0))


def play(explorer: Explorer, first: int, rounds: int) -> Tried:
    """Let an explorer choose so many behaviors; every third time its first place is refused.

    Args:
        explorer: what chooses.
        first: number of the first behavior.
        rounds: how many.
    """
    tried = []
    for step in range(first, first + rounds):
        places = explorer.places(SEEN, examples.anywhere)
        at = 0
        if step % 3 == 0 and len(places) > 1:
            explorer.refused(Point(*places[0].tolist()))
            at = 1
        place = Point(*places[at].tolist())
        call = explorer.behavior(place, examples.observation(Point(*place), Point(0.0, 0.0)))
        explorer.tell(examples.record(step, place, call, SEEN))
        tried.append((places.tolist(), call))
    return tried


class ExplorerContract:
    """An explorer chooses places and behaviors, and remembers what its state says, no more.

    A subclass gives the fixture `make_explorer`: a function that makes an explorer of the behaviors
    `examples.CALLS` from the random stream of its choices.
    """

    @pytest.fixture
    def explorer(self, make_explorer: MakeExplorer) -> Explorer:
        """An explorer that has not tried anything."""
        return make_explorer(np.random.default_rng(1))

    def test_places_are_finite_offsets_in_rows(self, explorer: Explorer) -> None:
        for step in range(1, 6):
            places = explorer.places(SEEN, examples.anywhere)
            assert places.ndim == 2
            assert places.shape[1] == 2
            assert len(places) > 0
            assert np.isfinite(places).all()
            play(explorer, step, 1)

    def test_behaviors_are_those_it_was_given_or_composed(self, explorer: Explorer) -> None:
        others = {call for _, call in play(explorer, 1, 40)} - set(examples.CALLS)
        assert all(composed_motion(call) is not None for call in others)

    def test_places_are_asked_for_again_after_the_attractor_was_put_back(
        self, explorer: Explorer
    ) -> None:
        for place in explorer.places(SEEN, examples.anywhere).tolist():
            explorer.refused(Point(*place))
        elsewhere = examples.observation(Point(-4.0, 25.0), Point(0.0, 11.0))
        assert np.isfinite(explorer.places(elsewhere, examples.anywhere)).all()
        play(explorer, 1, 1)

    def test_the_same_stream_gives_the_same_choices(self, make_explorer: MakeExplorer) -> None:
        one, other, third = (make_explorer(np.random.default_rng(7)) for _ in range(3))
        tried = play(one, 1, 20)
        assert play(other, 1, 20) == tried
        # What others were told says nothing to it.
        assert [t for step in range(1, 21) for t in play(third, step, 1)] == tried

    @pytest.mark.parametrize("rounds", [0, 1, 2, 15])
    def test_all_that_it_remembers_is_in_its_state(
        self, make_explorer: MakeExplorer, rounds: int
    ) -> None:
        stream, other_stream = np.random.default_rng(3), np.random.default_rng(4)
        explorer, resumed = make_explorer(stream), make_explorer(other_stream)
        play(explorer, 1, rounds)
        other_stream.bit_generator.state = stream.bit_generator.state
        resumed.restore(json.loads(json.dumps(explorer.state(), allow_nan=False)))
        assert resumed.state() == explorer.state()
        assert play(resumed, rounds + 1, 10) == play(explorer, rounds + 1, 10)
        assert resumed.state() == explorer.state()

    def test_its_state_does_not_outgrow_a_database(self, explorer: Explorer) -> None:
        play(explorer, 1, 400)
        assert len(json.dumps(explorer.state())) < LARGEST_STATE

    def test_a_state_of_another_version_is_refused(self, explorer: Explorer) -> None:
        play(explorer, 1, 5)
        with pytest.raises((ValueError, KeyError, TypeError)):
            explorer.restore({**explorer.state(), "version": "of another affcli"})

    def test_where_the_arm_reaches_nowhere_it_still_answers(self, explorer: Explorer) -> None:
        play(explorer, 1, 20)
        for reaches in (examples.nowhere, examples.left_half):
            places = explorer.places(SEEN, reaches)
            assert len(places) > 0
            assert np.isfinite(places).all()

    def test_a_state_of_something_else_is_refused(self, explorer: Explorer) -> None:
        with pytest.raises((ValueError, KeyError, TypeError)):
            explorer.restore({"what no explorer remembers": [None]})
