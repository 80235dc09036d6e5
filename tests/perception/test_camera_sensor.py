"""The sensor that sees: all twelve components from a picture and nothing else (§4, §5.2)."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from affcli.core.affordance_table import COLOR_TOLERANCE
from affcli.core.geometry import Point
from affcli.errors import BadInputError, NotSeenError
from affcli.perception.camera_sensor import CameraSensor, power_up
from affcli.perception.camera_settings import CameraSettings
from affcli.simulation.tasks.extension_of_reach import goal_regions
from affcli.simulation.tools.paper import TOOL_COLORS, TOOL_PARTS
from tests.perception.views import COLORS, WORKSPACE, default_eye, scene


def sensor(look: object, seed: int = 0) -> CameraSensor:
    return CameraSensor(lambda: look, default_eye(), np.random.default_rng(seed))  # type: ignore[arg-type, return-value]


@pytest.mark.parametrize("tool", TOOL_PARTS)
def test_the_observation_vector_is_what_is_there(tool: str) -> None:
    """§5.2: the object, the object from the wrist, its colour, the tool's."""
    look = scene((4.0, 20.0), (-1.0, 9.5), tool)
    seen = sensor(look).observe()
    assert seen.object_position == pytest.approx((4.0, 20.0), abs=0.05)
    assert seen.wrist_to_object == pytest.approx((5.0, 10.5), abs=0.08)
    assert (seen.object_z, seen.wrist_to_object_z) == (0.0, 0.0)
    assert seen.colors[:3] == pytest.approx(look.attractor_color, abs=25.0)
    assert seen.colors[3:] == pytest.approx(look.tool.color, abs=25.0)


def test_the_noise_is_the_seeds() -> None:
    look = scene()
    eye = sensor(look, 1)
    first, second = eye.observe(), eye.observe()
    assert first != second
    again = sensor(look, 1)
    assert (again.observe(), again.observe()) == (first, second)


def test_the_goal_is_seen_and_its_name_is_that_of_the_task() -> None:
    goal = goal_regions(WORKSPACE.layout)["4"]
    seen = sensor(scene(goal=goal)).observe_goal()
    assert seen.name == "4"
    assert seen.center == pytest.approx(goal.center, abs=0.05)
    assert seen.half_width == pytest.approx(goal.half_width, abs=0.05)


def test_without_a_goal_on_the_table_there_is_none_to_see() -> None:
    with pytest.raises(LookupError, match="no goal region on the table"):
        sensor(scene()).observe_goal()


def test_an_attractor_out_of_view_is_not_made_up() -> None:
    with pytest.raises(NotSeenError, match="sees no puck"):
        sensor(scene((60.0, 80.0))).observe()


def test_measured_colours_are_consistent_all_over_the_table_and_tools_are_not_confused() -> None:
    """The tolerance of search 1 lies between what light does to a colour and other colours."""
    table = WORKSPACE.table
    spots = [(x, y) for x in (-15.0, 0.0, 15.0) for y in (table.near + 1.5, 22.0, table.far)]
    for tool in TOOL_PARTS:
        wrists = [(-14.0, 3.0), (14.0, 3.0), (0.0, 18.0), (0.0, 6.0), (-12.0, 12.0)]
        seen = [
            sensor(scene(spot, wrist, tool)).observe().colors
            for spot in spots
            for wrist in wrists
            if abs(spot[0] - wrist[0]) > 9.0
        ]
        for part in (slice(0, 3), slice(3, 6)):
            colors = np.array([one[part] for one in seen])
            spread = max(np.linalg.norm(colors - one, axis=1).max() for one in colors)
            assert spread < COLOR_TOLERANCE
    nearest = min(
        np.linalg.norm(np.subtract(a, b)) for a, b in combinations(TOOL_COLORS.values(), 2)
    )
    assert nearest > 2.0 * COLOR_TOLERANCE


def test_power_up_calibrates_the_camera_from_one_picture() -> None:
    """§4: 36 markers, 5 in apart; the robot is not told where the camera stands."""
    truth = CameraSettings().camera()
    found = default_eye().calibration
    assert len(found.markers) == 36
    assert found.rms_px < 0.15
    assert found.camera.position == pytest.approx(truth.position, abs=0.2)
    assert found.camera.focal_length_mm == pytest.approx(truth.focal_length_mm, rel=0.01)
    assert found.camera != truth


@pytest.mark.parametrize("turn", [0.0, 90.0, 180.0, 270.0])
def test_the_camera_may_stand_on_any_side(turn: float) -> None:
    x, y = {0.0: (0, -20), 90.0: (42, 22), 180.0: (0, 64), 270.0: (-42, 22)}[turn]
    settings = CameraSettings(x=float(x), y=float(y), height=90.0, turn_degrees=turn)
    eye = power_up(settings, WORKSPACE, COLORS, np.random.default_rng(0))
    look = scene((6.0, 18.0), (-2.0, 9.0))
    eyes = CameraSensor(lambda: look, eye, np.random.default_rng(0))
    assert eyes.observe().object_position == pytest.approx((6.0, 18.0), abs=0.15)
    assert eyes.observe().wrist_to_object == pytest.approx((8.0, 9.0), abs=0.2)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"y": 200.0}, "no markers found"),
        ({"y": 60.0}, "cut off by the edge|markers found instead"),
        ({"tilt_degrees": 0.0, "y": 21.7, "height": 60.0}, "straight above"),
        ({"height": 46.0, "y": 42.0}, "does not see the table"),
    ],
)
def test_a_camera_that_cannot_serve_is_refused_at_power_up(
    change: dict[str, float], why: str
) -> None:
    settings = replace(CameraSettings(), **change)
    with pytest.raises(BadInputError, match=f"camera: .*({why})"):
        power_up(settings, WORKSPACE, COLORS, np.random.default_rng(0))


def test_the_wrist_is_seen_where_the_encoders_have_it() -> None:
    for x, y in ((-15.0, 2.0), (0.0, 7.0), (12.0, 12.0)):
        look = scene((0.0, 27.0), (x, y), "stick")
        seen = sensor(look).observe()
        wrist = Point(
            seen.object_x - seen.wrist_to_object_x, seen.object_y - seen.wrist_to_object_y
        )
        assert wrist == pytest.approx((x, y), abs=0.06)
