"""Where hook, block and hand are: what holds whatever the numbers, without KinDER."""

import math

import numpy as np
import pytest
from kinder_hook.shapes import (
    ARM,
    BASE_X,
    BASE_Y,
    UP,
    At,
    Block,
    HookSize,
    around,
    base_for,
    hand_for,
    past_the_hook,
    placed,
    reached_upright,
    shortest,
    turns_of,
    within,
    wrapped,
)

HOOK = HookSize(0.107, 1.4, 0.583)
IN_HAND = At(0.23, 0.01, -0.02)
RNG = np.random.default_rng(17)
POSES = [At(*RNG.uniform((0.3, 0.3, -3.0), (3.2, 3.2, 3.0))) for _ in range(30)]


def near(a: At, b: At) -> bool:
    return math.dist(a[:2], b[:2]) < 1e-9 and abs(wrapped(a.angle - b.angle)) < 1e-9


@pytest.mark.parametrize("at", POSES)
def test_frames_are_left_as_they_are_entered(at: At) -> None:
    other = POSES[3]
    assert near(at.seen_from(other).of(other), at)
    assert near(HOOK.wrist(HOOK.corner(at)), at)
    assert near(IN_HAND.of(hand_for(at, IN_HAND)), at)


@pytest.mark.parametrize("at", POSES)
def test_the_wrist_lies_on_the_middle_line_of_the_handle(at: At) -> None:
    end, wrist = HOOK.free_end(at), HOOK.wrist(at)
    assert math.dist(end[:2], wrist[:2]) == pytest.approx(0.1)
    assert placed(HOOK.outline(), wrist).area == pytest.approx(
        HOOK.width * (HOOK.handle + HOOK.bar - HOOK.width)
    )


@pytest.mark.parametrize("at", POSES)
def test_a_base_that_is_given_brings_the_hand_there(at: At) -> None:
    base = base_for(at)
    if base is not None:
        x, y, arm = base
        hand = At(arm, 0.0, 0.0).of(At(x, y, at.angle))
        assert near(hand, at)
        assert (within(x, BASE_X), within(y, BASE_Y), within(arm, ARM)) == (True, True, True)


def test_where_it_says_that_it_reaches_there_is_a_base() -> None:
    x, y = RNG.uniform(0.0, 3.5, 500), RNG.uniform(0.0, 3.5, 500)
    reached = reached_upright(x, y, IN_HAND)
    assert 0 < reached.sum() < 500
    for i in np.flatnonzero(reached):
        assert base_for(hand_for(At(x[i], y[i], UP), IN_HAND)) is not None


def test_a_way_around_the_block_keeps_clear_of_it() -> None:
    block = Block(At(1.75, 2.4, 0.3), 0.4).outline
    start, end = At(0.9, 0.95, UP), At(1.45, 1.5, UP)
    path = around(HOOK.outline(), block, start, end, IN_HAND)
    assert path is not None
    assert min(placed(HOOK.outline(), at).distance(block) for at in path) > 0.0
    assert math.dist(path[-1][:2], end[:2]) < 0.17


def test_there_is_no_way_onto_the_block() -> None:
    block = Block(At(1.45, 2.6, 0.0), 0.48).outline
    assert around(HOOK.outline(), block, At(0.9, 0.95, UP), At(1.45, 1.5, UP), IN_HAND) is None


def test_the_bare_robot_goes_around_the_hook() -> None:
    hook = placed(HOOK.outline(), At(1.2, 1.0, 0.0))
    way = past_the_hook(hook, At(0.3, 0.3, 0.0), At(0.6, 1.0, 0.0))
    assert way
    assert all(BASE_X[0] <= x <= BASE_X[1] and BASE_Y[0] <= y <= BASE_Y[1] for x, y in way)


def test_how_far_a_block_reaches_below_its_middle() -> None:
    assert Block(At(0, 0, 0.0), 0.4).below == pytest.approx(0.2)
    assert Block(At(0, 0, math.pi / 4), 0.4).below == pytest.approx(0.2 * math.sqrt(2.0))
    at = Block(At(1.0, 2.0, 0.7), 0.3)
    assert at.outline.bounds[1] == pytest.approx(2.0 - at.below)


def test_a_path_is_of_fewest_nodes_or_none() -> None:
    grid = {(i, j) for i in range(4) for j in range(4)} - {(1, 0), (1, 1), (1, 2)}

    def beside(node: tuple[int, int]) -> list[tuple[int, int]]:
        i, j = node
        return [near for near in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)) if near in grid]

    path = shortest((0, 0), (2, 0), beside)
    assert path is not None
    assert len(path) == 9
    assert turns_of(path) == [(0, 0), (0, 3), (2, 3), (2, 0)]
    assert shortest((0, 0), (9, 9), beside) is None
