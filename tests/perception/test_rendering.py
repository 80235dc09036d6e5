"""The pictures: perspective, what hides what, light, blur and noise, all deterministic."""

import numpy as np
import pytest
import shapely

from affcli.core.geometry import Point, Pose
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import PUCK_COLOR, ToolName
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.palette import GOAL_COLOR
from affcli.perception.rendering import Picture, Renderer
from affcli.perception.solids import circle
from affcli.simulation.tools.paper import paper_tools
from tests.perception.views import WORKSPACE, flat, scene

PLAIN = CameraSettings(grey_noise=0.0, blur_px=0.0, uneven_light=0.0)
"""Even light, no blur, no noise: every pixel of a surface has its colour."""
ORANGE = tuple(reversed(PUCK_COLOR))


def take(settings: CameraSettings, look: Scene, seed: int = 0) -> Picture:
    return Renderer(settings, WORKSPACE).take(look, np.random.default_rng(seed))


def pixels_of(picture: Picture, color: tuple[float, ...]) -> int:
    """Return how many pixels have just this colour (blue green red)."""
    return int(np.count_nonzero((picture == np.rint(color)).all(axis=2)))


def test_the_same_seed_gives_the_same_picture() -> None:
    look = scene(goal=GoalRegion("2", Point(0.0, 26.8), 2.25))
    first = take(CameraSettings(), look, 3)
    assert first.shape == (480, 640, 3)
    assert first.dtype == np.uint8
    assert np.array_equal(first, take(CameraSettings(), look, 3))
    assert not np.array_equal(first, take(CameraSettings(), look, 4))


def test_one_renderer_takes_any_number_of_pictures_alike() -> None:
    """What it keeps of one scene must not show in the next."""
    renderer = Renderer(CameraSettings(), WORKSPACE)
    looks = [scene(), scene((-8.0, 25.0), goal=GoalRegion("1", Point(0.0, 15.3), 2.25)), scene()]
    taken = [renderer.take(look, np.random.default_rng(5)) for look in looks]
    assert np.array_equal(taken[0], taken[2])
    assert np.array_equal(taken[1], take(CameraSettings(), looks[1], 5))


def test_the_noise_is_one_percent_and_differs_from_picture_to_picture() -> None:
    renderer = Renderer(CameraSettings(), WORKSPACE)
    rng = np.random.default_rng(0)
    clean = take(CameraSettings(grey_noise=0.0), scene()).astype(float)
    first, second = (renderer.take(scene(), rng).astype(float) - clean for _ in range(2))
    bright = (clean > 20.0) & (clean < 235.0)
    assert first[bright].std() == pytest.approx(2.55, rel=0.03)
    assert abs(first[bright].mean()) < 0.05
    assert abs(np.corrcoef(first[bright], second[bright])[0, 1]) < 0.01
    # White: one pixel says nothing of the next.
    assert abs(np.corrcoef(first[:, 1:].ravel(), first[:, :-1].ravel())[0, 1]) < 0.01


def test_the_light_is_uneven_as_asked() -> None:
    even = take(PLAIN, scene()).astype(float)
    lit = take(CameraSettings(grey_noise=0.0, blur_px=0.0, uneven_light=0.1), scene())
    ratio = lit.astype(float)[even > 60.0] / even[even > 60.0]
    assert 0.89 < ratio.min() < 0.92
    assert 1.03 < ratio.max() < 1.11
    assert ratio.mean() == pytest.approx(1.0, abs=0.02)


def test_a_square_goal_covers_the_pixels_that_perspective_gives_it() -> None:
    goal = GoalRegion("3", Point(-12.4, 22.4), 2.25)
    picture = take(PLAIN, scene(goal=goal))
    half = goal.half_width
    corners = [
        (goal.center.x + sx * half, goal.center.y + sy * half)
        for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    area = shapely.Polygon(flat(PLAIN.camera(), np.array(corners))).area
    assert pixels_of(picture, tuple(reversed(GOAL_COLOR))) == pytest.approx(area, rel=0.06)


def test_edges_are_anti_aliased() -> None:
    """The coverage of all pixels together is the area, far more exactly than whole pixels say."""
    settings = PLAIN
    disc = circle(Point(-10.0, 28.0), 1.0)
    renderer = Renderer(settings, WORKSPACE)
    rng = np.random.default_rng(0)
    bare = renderer.take_flat([], rng).astype(float)
    drawn = renderer.take_flat([(disc, (0.0, 0.0, 0.0))], rng).astype(float)
    share = ((bare - drawn) / bare).mean(axis=2)
    area = shapely.Polygon(flat(settings.camera(), disc)).area
    assert share.sum() == pytest.approx(area, rel=0.03)
    partial = (share > 0.05) & (share < 0.95)
    assert 0.5 * np.sqrt(area) < np.count_nonzero(partial) < 8.0 * np.sqrt(area)


@pytest.mark.parametrize("hidden", [True, False], ids=["the bar in front", "the bar behind"])
def test_what_is_nearer_to_the_camera_hides_what_is_behind(*, hidden: bool) -> None:
    """The camera looks from beyond the far edge; the puck is higher than the tool."""
    tool = paper_tools(WORKSPACE.tools)[ToolName("t-stick")]
    far_edge = 9.0 + WORKSPACE.tools.handle_length
    puck = Pose(3.0, far_edge - WORKSPACE.tools.part_width - 1.5 if hidden else far_edge + 1.5)
    look = Scene(puck, PUCK_COLOR, Pose(0.0, 9.0), tool, None)
    alone = Scene(puck, PUCK_COLOR, Pose(-15.0, 2.0), tool, None)
    side = tuple(0.7 * c for c in ORANGE)
    with_tool, without = (pixels_of(take(PLAIN, one), side) for one in (look, alone))
    assert (with_tool < 0.8 * without) == hidden
    # The tool never hides the puck's top.
    tops = [pixels_of(take(PLAIN, one), ORANGE) for one in (look, alone)]
    assert tops[0] == pytest.approx(tops[1], rel=0.01)


def test_a_lifted_tool_is_drawn_over_the_puck_and_elsewhere_in_the_picture() -> None:
    tool = paper_tools(WORKSPACE.tools)[ToolName("stick")]
    over = Scene(Pose(0.0, 22.0), PUCK_COLOR, Pose(0.0, 12.0), tool, None, lift=1.6)
    away = Scene(Pose(0.0, 22.0), PUCK_COLOR, Pose(9.0, 12.0), tool, None, lift=1.6)
    tops = [pixels_of(take(PLAIN, one), ORANGE) for one in (over, away)]
    assert tops[0] < 0.85 * tops[1]
    down = Scene(Pose(0.0, 22.0), PUCK_COLOR, Pose(9.0, 12.0), tool, None)
    assert not np.array_equal(take(PLAIN, away), take(PLAIN, down))


def test_what_is_out_of_view_is_simply_not_there() -> None:
    far = Scene(Pose(400.0, 300.0), PUCK_COLOR, Pose(0.0, 12.0), scene().tool, None)
    assert pixels_of(take(PLAIN, far), ORANGE) == 0
