"""How well pictures tell where things are: the bars, and figures for what lies outside of them."""

import sys
from dataclasses import replace

import numpy as np
import pytest

from affcli.core.affordance_table import COLOR_TOLERANCE
from affcli.core.geometry import Point, Pose
from affcli.core.scene import Scene
from affcli.errors import NotSeenError
from affcli.lab.learning_run import LearningRun
from affcli.perception.camera import Array
from affcli.perception.location import places_of
from affcli.simulation.tasks.extension_of_reach import goal_regions, start_positions
from affcli.simulation.tools.paper import TOOL_PARTS
from tests.factories import learning_spec
from tests.perception.views import SQUARE, WORKSPACE, default_eye, gap, scene

CLEAR = 1.0
"""A puck at least this far from the tool is not hidden by it (in)."""


def looked_at(look: Scene, seed: int) -> tuple[Point, Point]:
    """Return where the default camera sees puck and wrist."""
    eye = default_eye()
    seen = eye.segmenter.segment(eye.renderer.take(look, np.random.default_rng(seed)))
    return eye.locator.puck(seen)[0], eye.locator.wrist(seen)


def puck_errors(looks: list[Scene]) -> Array:
    """Return where the puck is seen less where it is (n, 2), in."""
    return np.array(
        [np.subtract(looked_at(look, k)[0], look.attractor.point) for k, look in enumerate(looks)]
    )


def said(what: str, errors: Array) -> tuple[float, float]:
    """Print and return the median and the 99 % of the distances."""
    off = np.linalg.norm(errors, axis=1)
    median, most = np.percentile(off, [50, 99]).tolist()
    x, y = errors.mean(axis=0)
    sys.stdout.write(
        f"\n{what}, n = {len(off)}: median {median:.3f} in, 99 % {most:.3f} in, max "
        f"{off.max():.3f} in; bias ({x:+.3f}, {y:+.3f}) in\n"
    )
    return median, most


def random_looks(count: int, low: tuple[float, float], high: tuple[float, float]) -> list[Scene]:
    """Return pucks anywhere in a box, with a tool that hides nothing of them."""
    rng = np.random.default_rng(44)
    found: list[Scene] = []
    while len(found) < count:
        x, y = rng.uniform(low, high).tolist()
        wrist = (rng.uniform(-8.0, 8.0), rng.uniform(6.0, 14.0))
        look = scene((x, y), wrist, list(TOOL_PARTS)[len(found) % 5])
        if gap(look) >= CLEAR:
            found.append(look)
    return found


def test_an_unoccluded_puck_in_the_calibrated_square() -> None:
    """1 % grey-level noise, half a pixel of blur, uneven light, a calibration from one picture."""
    median, most = said("in the square", puck_errors(random_looks(400, *SQUARE)))
    assert median <= 0.05
    assert most <= 0.15


def test_an_unoccluded_puck_outside_the_calibrated_square() -> None:
    """Wherever a push may take it."""
    looks = [
        look
        for look in random_looks(600, (-20.0, 6.0), (20.0, 36.0))
        if not (abs(look.attractor.x) <= 12.5 and 9.2 <= look.attractor.y <= 34.2)
    ]
    _, most = said("outside the square", puck_errors(looks))
    assert most <= 0.15


def test_a_puck_that_the_tool_hides_in_part() -> None:
    """Right after a push: the puck lies at the tool, which stands before its side."""
    looks = []
    for tool in TOOL_PARTS:
        spec = learning_spec(tool, seed=9, behaviors=150)
        run = LearningRun(spec)
        for _ in run.steps():
            look = run.setting.scene()
            if look is not None and gap(look) < 0.05:
                looks.append(look)
    _, most = said("touched by the tool", puck_errors(looks))
    assert most <= 0.15


def test_a_puck_under_the_bar_is_hidden_and_yet_found() -> None:
    """The worst case: the bar stands right in front of all of the puck's side."""
    far_edge = 10.0 + 14.6 - 0.75
    looks = [scene((x, far_edge - 1.5), (0.0, 10.0), "t-stick") for x in np.linspace(2, 5, 20)]
    eye = default_eye()
    bar = [eye.segmenter.segment(eye.renderer.take(k, np.random.default_rng(0))) for k in looks]
    visible = np.array([places_of(seen, eye.calibration.camera)["puck"][0].point for seen in bar])
    truth = np.array([look.attractor.point for look in looks])
    plain = said("behind a bar, what is visible alone", visible - truth)
    whole = said("behind a bar, its outline completed", puck_errors(looks))
    assert whole[0] <= 0.05
    assert plain[0] > 2.0 * whole[0]


def test_the_wrist() -> None:
    looks = random_looks(300, *SQUARE)
    errors = [np.subtract(looked_at(look, k)[1], look.wrist.point) for k, look in enumerate(looks)]
    _, most = said("wrist", np.array(errors))
    assert most <= 0.05


def test_puck_wrist_and_tool_wherever_the_wrist_is_turned() -> None:
    """The wrist is found by its colour, whose edge the tool below blurs: by less when straight."""
    rng, looks = np.random.default_rng(45), []
    for k, look in enumerate(random_looks(200, *SQUARE)):
        angle = float(rng.uniform(-np.pi, np.pi))
        turned = replace(look, wrist=Pose(*look.wrist.point, angle))
        if gap(turned) >= CLEAR:
            looks.append((k, turned))
    eye, puck, wrist = default_eye(), [], []
    for k, look in looks:
        seen = eye.segmenter.segment(eye.renderer.take(look, np.random.default_rng(k)))
        puck.append(np.subtract(eye.locator.puck(seen)[0], look.attractor.point))
        wrist.append(np.subtract(eye.locator.wrist(seen), look.wrist.point))
        color = eye.locator.tool_color(seen)
        assert np.linalg.norm(np.subtract(color, look.tool.color)) < COLOR_TOLERANCE
    assert len(looks) > 150
    assert said("turned: puck", np.array(puck))[1] <= 0.021
    assert said("turned: wrist", np.array(wrist))[1] <= 0.05


def test_the_goal_with_the_tool_across_it() -> None:
    """As each trial begins: every tool, goal and start."""
    eye, errors = default_eye(), []
    home = WORKSPACE.wrist_start
    goals, starts = goal_regions(WORKSPACE.layout), start_positions(WORKSPACE.layout)
    for tool in TOOL_PARTS:
        for goal in goals.values():
            for seed, start in enumerate(starts.values(), start=1):
                look = scene(start, home, tool, goal)
                seen = eye.segmenter.segment(eye.renderer.take(look, np.random.default_rng(seed)))
                center, half = eye.locator.goal(seen)
                errors.append(np.subtract(center, goal.center))
                assert half == pytest.approx(WORKSPACE.layout.goal_half_width, abs=0.05)
    _, most = said("goal", np.array(errors))
    assert most <= 0.1


@pytest.mark.parametrize(("tool", "wrist"), [("t-hook", (0.0, 14.9)), ("t-stick", (0.0, 14.3))])
def test_a_goal_hidden_along_a_whole_edge_keeps_its_size(
    tool: str, wrist: tuple[float, float]
) -> None:
    """The bar lies over the goal's far edge, so half an inch of it cannot be seen."""
    eye, goal = default_eye(), goal_regions(WORKSPACE.layout)["2"]
    look = scene((9.0, 18.0), wrist, tool, goal)
    seen = eye.segmenter.segment(eye.renderer.take(look, np.random.default_rng(0)))
    center, half = eye.locator.goal(seen)
    assert center == pytest.approx(goal.center, abs=0.06)
    assert half == pytest.approx(goal.half_width, abs=0.05)


def test_what_is_not_there_is_not_seen() -> None:
    eye = default_eye()
    bare = eye.segmenter.segment(eye.renderer.take_flat([], np.random.default_rng(0)))
    for find, what in (
        (eye.locator.puck, "puck"),
        (eye.locator.wrist, "wrist"),
        (eye.locator.goal, "goal"),
        (eye.locator.tool_color, "tool"),
    ):
        with pytest.raises(NotSeenError, match=f"the camera sees no {what}") as told:
            find(bare)
        assert told.value.exit_code == 4
