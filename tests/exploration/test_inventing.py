"""Inventing: what is composed, what is tried again, and what is kept (§7.1, §8)."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from affcli.core.affordance import Affordance
from affcli.core.babbling_box import BabblingSettings
from affcli.core.behavior import BehaviorCall, Execution, ExecutionStatus, composed_motion
from affcli.core.geometry import Point, Pose
from affcli.core.invention import Invention, kept_of
from affcli.core.motion import Slide, Turn
from affcli.core.trial import BabblingRecord
from affcli.exploration import inventing
from affcli.exploration.inventing import Inventing, Limits
from affcli.testing import examples

MOST = 3
LIMITS = Limits(babbling=1.0, composing=2.0, turn=45.0, slide=5.0, schemas=1, most=MOST)
BOX = BabblingSettings(draws=8)
SECONDS = 4.0
"""Of one behavior."""
Moved = tuple[float, float]
Moves = Callable[[BehaviorCall], Moved]


def tell(explorer: Inventing, step: int, place: Point, call: BehaviorCall, moved: Moved) -> None:
    """Tell an explorer that a behavior moved the attractor so, from anywhere on the table."""
    at = Point(-12.0 + 4.0 * (step % 7), 14.0 + 3.0 * (step % 5))
    wrist = Pose(at.x - place.x, at.y - place.y)
    start = examples.observation(at, wrist.point)
    end = examples.observation(Point(at.x + moved[0], at.y + moved[1]), wrist.point)
    execution = Execution(call, ExecutionStatus.DONE, wrist, wrist, 2.0)
    row = None
    if math.hypot(*moved) > 0.5:
        row = Affordance(step, examples.BINDING, call, start, end)
    explorer.tell(BabblingRecord(step, SECONDS * step, 0, 0, execution, execution, start, end, row))


def live(explorer: Inventing, moves: dict[str, Moves], steps: int = 90) -> list[str]:
    """Let an explorer try behaviors; return the kinds it tried.

    Args:
        explorer: what chooses.
        moves: how a behavior moves the attractor, by its name; else it does not.
        steps: how many it tries.
    """
    tried: list[str] = []
    for step in range(1, steps + 1):
        seen = examples.observation(Point(0.0, 22.0), Point(0.0, 11.0))
        place = Point(*explorer.places(seen, examples.anywhere)[0].tolist())
        call = explorer.behavior(place, seen)
        moved = moves[call.name](call) if call.name in moves else (0.0, 0.0)
        tell(explorer, step, place, call, moved)
        tried.append(call.name)
    return tried


def inventor(limits: Limits = LIMITS) -> Inventing:
    return Inventing(examples.CALLS, BOX, np.random.default_rng(5), limits)


def pull(call: BehaviorCall) -> Moved:
    """Move the attractor toward the robot."""
    return 0.0, -3.0


def aside(call: BehaviorCall) -> Moved:
    """Move the attractor to where a turn's angle says."""
    return 4.0 * math.cos(0.1 * call["angle"]), 4.0 * math.sin(0.1 * call["angle"])


def test_it_babbles_then_composes_then_tries_again_what_brings_most() -> None:
    explorer = inventor()
    tried = live(explorer, {"turn": pull})
    known = {call.name for call in examples.CALLS}
    assert set(tried[:15]) <= known
    assert set(tried[15:45]) == {"turn", "slide"}
    first, *others = explorer.inventions()
    assert first.kept
    assert not others, "what the first does, the others do not bring anew"
    assert first.behavior.call.name == "turn"
    assert first.gain == 35, "all places in which the attractor was seen"
    assert first.tries == ((46, True), (47, True))
    assert 15 < first.step <= 45


def test_what_the_repertoire_does_already_is_no_invention() -> None:
    explorer = inventor()
    live(explorer, {"turn": pull, "contract arm": pull})
    assert explorer.inventions() == ()


@pytest.mark.parametrize(
    ("again", "kept"),
    [
        ((0.0, -3.0), True),
        ((0.0, -4.4), True),
        ((0.0, -4.6), False),
        ((2.9, -2.9), False),
        ((0.0, -0.4), False),
    ],
)
def test_what_does_not_give_the_same_again_is_not_kept(again: Moved, kept: bool) -> None:
    """Within 40 degrees, and within 1.5 in of where it ended; no movement is no success (§5.2)."""
    explorer = inventor()
    live(explorer, {"turn": pull}, 45)
    live_on = live_again(explorer, again)
    assert live_on[0].kept is kept
    assert [alike for _, alike in live_on[0].tries] == [kept] * 2


def live_again(explorer: Inventing, moved: Moved) -> tuple[Invention, ...]:
    """Let it try what it composed again until that is decided."""
    seen = examples.observation(Point(0.0, 22.0), Point(0.0, 11.0))
    for step in (46, 47):
        place = Point(*explorer.places(seen, examples.anywhere)[0].tolist())
        tell(explorer, step, place, explorer.behavior(place, seen), moved)
    return explorer.inventions()


def test_two_tries_of_three_decide() -> None:
    explorer = inventor()
    live(explorer, {"turn": pull}, 45)
    seen = examples.observation(Point(0.0, 22.0), Point(0.0, 11.0))
    for step, moved in ((46, (0.0, -3.0)), (47, (0.0, 0.0)), (48, (0.0, -3.0))):
        place = Point(*explorer.places(seen, examples.anywhere)[0].tolist())
        tell(explorer, step, place, explorer.behavior(place, seen), moved)
    (one,) = explorer.inventions()
    assert (one.kept, one.speak_for, one.speak_against) == (True, 2, 1)


def test_it_tries_again_near_where_it_was_found() -> None:
    explorer = inventor()
    live(explorer, {"turn": pull}, 45)
    seen = examples.observation(Point(0.0, 22.0), Point(0.0, 11.0))
    places = explorer.places(seen, examples.anywhere)
    assert len(np.unique(places, axis=0)) == inventing.PLACES
    assert np.ptp(places, axis=0).max() <= 2.0 * inventing.JITTER


def test_of_what_brings_as_much_it_prefers_what_moves_the_attractor_less_far() -> None:
    """A long sweep may push it off the table."""
    explorer = inventor()
    live(explorer, {"turn": lambda call: (0.0, -9.0), "slide": pull})
    assert explorer.inventions()[0].behavior.call.name == "slide"


def test_no_more_is_kept_than_asked_for_and_what_is_kept_is_used() -> None:
    explorer = inventor()
    tried = live(explorer, {"turn": aside}, 400)
    kept = kept_of(explorer.inventions())
    assert len(kept) == MOST
    assert len({one.call for one in kept}) == MOST
    assert "turn" in tried[-50:]
    assert "slide" not in tried[-50:], "enough is kept"
    assert {call.name for call in examples.CALLS} & set(tried[-50:])


def test_what_cannot_be_set_up_again_is_given_up() -> None:
    """The attractor is put back again and again; after so often it goes on with something else."""
    explorer = inventor()
    live(explorer, {"turn": pull}, 45)
    seen = examples.observation(Point(0.0, 22.0), Point(0.0, 11.0))
    for _ in range(inventing.PATIENCE):
        assert len(explorer.places(seen, examples.anywhere)) == inventing.PLACES
    explorer.places(seen, examples.anywhere)
    assert [(one.kept, one.tries) for one in explorer.inventions()] == [(False, ())]


@pytest.mark.parametrize("schemas", [1, 3])
def test_what_it_composes_lies_within_limits(schemas: int) -> None:
    limits = Limits(0.1, 600.0, turn=20.0, slide=3.0, schemas=schemas, most=6)
    explorer = inventor(limits)
    seen = examples.observation(Point(0.0, 22.0), Point(0.0, 11.0))
    lengths = set()
    for step in range(1, 200):
        place = Point(*explorer.places(seen, examples.anywhere)[0].tolist())
        call = explorer.behavior(place, seen)
        tell(explorer, step, place, call, (0.0, 0.0))
        if call in examples.CALLS:
            continue
        motion = composed_motion(call)
        assert motion is not None
        lengths.add(len(motion))
        for one in motion:
            if isinstance(one, Turn):
                assert 5.0 <= abs(one.degrees) <= 20.0
                assert one.degrees.is_integer()
            else:
                assert isinstance(one, Slide)
                assert 0.9 <= math.hypot(one.dx, one.dy) <= 3.1
    assert lengths == set(range(1, schemas + 1))
