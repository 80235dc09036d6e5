"""The sensor that adds noise to exact positions (§4, §5.2)."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from affcli.core.geometry import Point, Pose
from affcli.core.observation import Observation
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import PUCK_COLOR, Color
from affcli.core.workspace import ToolGeometry
from affcli.perception.noisy_sensor import NoisySensor, SensorSettings
from affcli.simulation.tools.paper import paper_tools
from tests.factories import observation, places, seeds

STICK = next(iter(paper_tools(ToolGeometry()).values()))
BROWN = Color((128.0, 100.0, 90.0))
GOAL = GoalRegion("2", Point(1.5, 28.0), 2.25)
NOISE = SensorSettings(position_noise=0.25, color_noise=3.0)
EXACT = SensorSettings(position_noise=0.0, color_noise=0.0)
LOOKS = 20_000


def scene(
    attractor: Pose = Pose(3.0, 22.0, 0.7),
    wrist: Pose = Pose(1.0, 12.0),
    attractor_color: Color = PUCK_COLOR,
    tool_color: Color = BROWN,
    goal: GoalRegion | None = GOAL,
) -> Scene:
    return Scene(attractor, attractor_color, wrist, STICK.painted(tool_color), goal)


def sensor(look: Scene | None = None, noise: SensorSettings = NOISE, seed: int = 0) -> NoisySensor:
    seen = look or scene()
    return NoisySensor(lambda: seen, noise, np.random.default_rng(seed))


def many_looks(look: Scene | None = None) -> NDArray[np.float64]:
    """Return what the sensor says time and again (LOOKS, 12)."""
    eye = sensor(look)
    return np.array([eye.observe() for _ in range(LOOKS)])


def wrist_seen(looks: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return where the sensor saw the wrist (n, 2): the object less its offset from the wrist."""
    return np.subtract(looks[:, 0:2], looks[:, 3:5])


def assert_gaussian(values: NDArray[np.float64], mean: float, deviation: float) -> None:
    """Check mean, spread and tails, each within five of its own standard deviations."""
    n = len(values)
    assert abs(values.mean() - mean) < 5.0 * deviation / math.sqrt(n)
    assert abs(values.std() / deviation - 1.0) < 5.0 / math.sqrt(2.0 * n)
    within_one = np.count_nonzero(np.abs(values - mean) < deviation) / n
    assert abs(within_one - 0.6827) < 5.0 * math.sqrt(0.6827 * 0.3173 / n)


@settings(deadline=None)
@given(places, places, seeds)
def test_without_noise_the_observation_is_the_scene(at: Point, wrist: Point, seed: int) -> None:
    """§5.2: position of the object, position relative to the wrist, its colour, the tool's."""
    look = scene(Pose(at.x, at.y, 1.0), Pose(*wrist))
    eye = sensor(look, EXACT, seed)
    assert eye.observe() == observation(at, wrist=wrist, tool_color=look.tool.color)
    assert eye.observe_goal() == GOAL


def test_positions_carry_gaussian_noise_about_the_truth() -> None:
    seen = many_looks()
    assert_gaussian(seen[:, 0], 3.0, NOISE.position_noise)
    assert_gaussian(seen[:, 1], 22.0, NOISE.position_noise)
    wrist = wrist_seen(seen)
    assert_gaussian(wrist[:, 0], 1.0, NOISE.position_noise)
    assert_gaussian(wrist[:, 1], 12.0, NOISE.position_noise)


def test_attractor_and_wrist_are_seen_independently() -> None:
    seen = many_looks()
    wrist = wrist_seen(seen)
    drawn = np.column_stack([seen[:, 0:2], wrist, seen[:, 6:12]])
    off_diagonal = np.triu(np.atleast_2d(np.corrcoef(drawn, rowvar=False)), k=1)
    assert float(np.abs(off_diagonal).max()) < 5.0 / math.sqrt(LOOKS)


def test_two_looks_at_the_same_scene_are_independent() -> None:
    x = many_looks()[:, 0]
    assert abs(float(np.corrcoef(x[:-1], x[1:])[0, 1])) < 5.0 / math.sqrt(LOOKS)


@settings(deadline=None)
@given(places, seeds)
def test_z_is_exact(at: Point, seed: int) -> None:
    """§4: "the equation of the plane in which they lie is known (e.g., Z=0 is the plane of the
    table)": o3 and o6 are 0 whatever the noise."""
    seen = sensor(scene(Pose(at.x, at.y)), seed=seed).observe()
    assert seen.object_z == seen.wrist_to_object_z == 0.0


def test_colours_carry_gaussian_noise_of_their_own() -> None:
    seen = many_looks(scene(attractor_color=Color((120.0, 130.0, 140.0))))
    for column, mean in zip(seen[:, 6:12].T, (120, 130, 140, 128, 100, 90), strict=True):
        assert_gaussian(column, float(mean), NOISE.color_noise)


@settings(deadline=None)
@given(seeds, st.floats(0.0, 500.0))
def test_colours_stay_within_0_to_255(seed: int, noise: float) -> None:
    look = scene(attractor_color=Color((0.0, 255.0, 3.0)), tool_color=Color((255.0, 0.0, 252.0)))
    eye = sensor(look, SensorSettings(position_noise=0.0, color_noise=noise), seed)
    for _ in range(5):
        assert all(0.0 <= component <= 255.0 for component in eye.observe().colors)


def test_the_goal_is_seen_with_noise_on_its_centre_and_its_size_as_painted() -> None:
    eye = sensor()
    goals = [eye.observe_goal() for _ in range(LOOKS)]
    assert {(goal.name, goal.half_width) for goal in goals} == {("2", 2.25)}
    centers = np.array([goal.center for goal in goals])
    assert_gaussian(centers[:, 0], GOAL.center.x, NOISE.position_noise)
    assert_gaussian(centers[:, 1], GOAL.center.y, NOISE.position_noise)


def test_there_is_no_goal_to_see_while_learning() -> None:
    with pytest.raises(LookupError, match="no goal region"):
        sensor(scene(goal=None)).observe_goal()


@settings(deadline=None, max_examples=30)
@given(seeds)
def test_the_same_seed_sees_the_same(seed: int) -> None:
    def looks(eye: NoisySensor) -> list[Observation | GoalRegion]:
        return [eye.observe(), eye.observe_goal(), eye.observe()]

    assert looks(sensor(seed=seed)) == looks(sensor(seed=seed))
    assert looks(sensor(seed=seed)) != looks(sensor(seed=seed ^ 1))


def test_the_angle_of_the_puck_is_not_seen() -> None:
    """A puck looks the same however it is turned (§5.2 has no component for it)."""
    one, other = (sensor(scene(Pose(3.0, 22.0, angle))).observe() for angle in (0.0, 2.0))
    assert one == other


def test_the_sensor_looks_at_the_scene_of_the_moment() -> None:
    looks = iter([scene(Pose(0.0, 20.0)), scene(Pose(5.0, 21.0))])
    eye = NoisySensor(lambda: next(looks), EXACT, np.random.default_rng(0))
    assert eye.observe().object_position == Point(0.0, 20.0)
    assert eye.observe().object_position == Point(5.0, 21.0)
