"""The motor schemas, written by hand: take the hook, carry it around the block, slide it.

They ask KinDER for nothing but steps, and go by its observations alone. What to do with them is
what affcli learns.
"""

import math
from enum import Enum

from kinder_hook.episode import Episode
from kinder_hook.shapes import (
    BASE,
    BASE_X,
    BASE_Y,
    TOUCHING,
    UP,
    At,
    around,
    base_for,
    hand_for,
    past_the_hook,
    placed,
    upright_limits,
)

DRAWN_IN = 0.245
"""The arm's length that serves to go past things."""
OPEN = 0.31
"""The gap of an open hand."""
TRIES = 6
FINGER = 0.2
ROOM_TO_COME_IN = BASE_X[0] + BASE + 0.30
"""A hook whose free end is nearer to the left wall cannot be taken there: it is pushed first."""


class Placing(Enum):
    """How carrying the hook somewhere ended."""

    DONE = 0
    BLOCKED = 1
    OUT_OF_REACH = 2


def take_hook(episode: Episode) -> bool:
    """Take the hook by the free end of its handle and hold it upright, low in the room."""
    for _ in range(TRIES):
        if episode.held or episode.over:
            break
        _open(episode)
        missing = ROOM_TO_COME_IN - episode.hook_size.free_end(episode.hook).x
        if missing > 0.0:
            _push_hook_right(episode, missing + 0.06)
        _close_about_handle(episode)
    if not episode.held:
        return False
    episode.grasped = episode.in_hand
    for x in (episode["x"], min(max(episode["x"], 0.9), 2.6)):
        episode.servo(x, BASE_Y[0], episode["angle"], DRAWN_IN, near=0.02)
    upright = UP - episode.in_hand.angle
    return episode.servo(episode["x"], BASE_Y[0], upright, DRAWN_IN, near=0.02, most=60)


def carry(episode: Episode, x: float, y: float) -> Placing:
    """Carry the hook around the block until it stands upright with its wrist at a place."""
    end = At(x, y, UP)
    if base_for(hand_for(end, episode.in_hand)) is None:
        return Placing.OUT_OF_REACH
    hook, block = episode.hook_size.outline(), episode.block.outline
    if placed(hook, end).distance(block) < TOUCHING:
        return Placing.BLOCKED
    path = around(hook, block, episode.wrist, end, episode.in_hand)
    if path is None:
        return Placing.BLOCKED
    for at in path:
        _bring_wrist(episode, at, near=0.02)
    for _ in range(2):  # once more by what is seen then
        _bring_wrist(episode, end)
        if math.dist(episode.wrist[:2], end[:2]) < 0.01:
            break
    episode.act()
    return Placing.DONE


def slide(episode: Episode, dx: float, dy: float) -> bool:
    """Slide the upright hook; False when the edge of the reach stops it sooner."""
    wrist = episode.wrist
    left, right, low, high = upright_limits(episode.in_hand)
    x = min(max(wrist.x + dx, left), right)
    y = min(max(wrist.y + dy, low), high)
    _bring_wrist(episode, At(x, y, UP))
    episode.act()
    return abs(x - wrist.x - dx) + abs(y - wrist.y - dy) <= 0.01


def _bring_wrist(episode: Episode, at: At, near: float = 0.004) -> None:
    """Bring the wrist to a pose, as far as the room lets it."""
    hand = hand_for(at, episode.in_hand)
    base = base_for(hand)
    if base is not None:
        episode.servo(base[0], base[1], hand.angle, base[2], near=near)


def _open(episode: Episode) -> None:
    while episode["gap"] < OPEN and not episode.over:
        episode.act(gap=0.02)


def _close_about_handle(episode: Episode) -> None:
    """Go before the free end of the handle, put the open hand about it, and close it."""
    arm = DRAWN_IN

    def before_end(back: float) -> tuple[float, float, float]:
        end = episode.hook_size.free_end(episode.hook)
        x = end.x - back * math.cos(end.angle)
        return max(BASE_X[0] - 0.005, x), end.y - back * math.sin(end.angle), end.angle

    x, y, angle = before_end(arm + FINGER + 0.05)
    lying = placed(episode.hook_size.outline(), episode.wrist)
    episode.servo(episode["x"], episode["y"], episode["angle"], arm)
    for place in past_the_hook(lying, episode.base, At(x, y, angle)):
        episode.servo(*place, episode["angle"], arm, near=0.03)
    # Turned where there is room, then straight in.
    episode.servo(episode["x"], episode["y"], angle, arm)
    episode.servo(x, y, angle, arm)
    x, y, angle = before_end(arm + 0.035)
    episode.servo(x, y, angle, arm, most=25)
    for _ in range(14):
        episode.act(gap=-0.02)
        if episode.held or episode.over:
            episode.act()
            return
    _open(episode)
    back = 0.3
    x = max(BASE_X[0] - 0.005, episode["x"] - back * math.cos(angle))
    episode.servo(x, episode["y"] - back * math.sin(angle), angle, arm, most=12)


def _push_hook_right(episode: Episode, way: float) -> None:
    """Push the inner side of the bar to the right, from under the handle, with the open hand."""
    hook, size = episode.hook, episode.hook_size
    angle, arm = hook.angle, DRAWN_IN
    back = arm + FINGER + 0.12
    begin = At(-size.width - back, -size.width - BASE - 0.10, 0.0).of(hook)
    x, y = max(BASE_X[0], begin.x), max(BASE_Y[0], begin.y)
    episode.servo(episode["x"], episode["y"], 0.0, arm)
    for at in ((episode["x"], BASE_Y[0]), (x, BASE_Y[0]), (x, y)):
        episode.servo(*at, angle, arm)
    cos, sin = math.cos(angle), math.sin(angle)
    far = 0.12 + way
    most = int((way + 0.16) / 0.05) + 6
    episode.servo(episode["x"] + far * cos, episode["y"] + far * sin, angle, arm, most=most)
    episode.servo(episode["x"] - 0.12 * cos, episode["y"] - 0.12 * sin, angle, arm, most=6)
    episode.servo(episode["x"], BASE_Y[0], angle, arm, most=20)
