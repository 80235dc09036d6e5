"""The camera model: Tsai's pinhole with radial distortion (§4)."""

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.geometry import Point
from affcli.perception.camera import Camera, distorted
from affcli.perception.camera_settings import CameraSettings
from tests.perception.views import CORNER_MM, SENSOR, camera_at, cameras, flat, on_table

heights = st.floats(0.0, 2.0)


@settings(deadline=None)
@given(cameras, st.lists(on_table, min_size=1, max_size=8), heights)
def test_what_is_projected_is_found_again_on_its_plane(
    camera: Camera, points: list[Point], height: float
) -> None:
    """On the plane Z = 0, on the puck's top, Z = 1, and between."""
    places = np.array(points)
    pixels = camera.project(np.column_stack([places, np.full(len(places), height)]))
    seen = np.isfinite(pixels).all(axis=1)
    assert np.allclose(camera.back_project(pixels[seen], height), places[seen], atol=1e-9)
    each = np.full(seen.sum(), height)
    assert np.array_equal(
        camera.back_project(pixels[seen], each), camera.back_project(pixels[seen], height)
    )


@settings(deadline=None)
@given(cameras, st.floats(0.0, 639.0), st.floats(0.0, 479.0))
def test_every_pixel_that_shows_the_table_shows_the_point_it_is_taken_back_to(
    camera: Camera, x: float, y: float
) -> None:
    pixel = np.array([[x, y]])
    point = camera.back_project(pixel)
    if np.isfinite(point).all() and np.hypot(*point[0]) < 1000.0:
        assert np.allclose(flat(camera, point), pixel, atol=1e-6)


@given(st.floats(-0.15, 0.15), st.floats(0.0, 1.0))
def test_distortion_is_the_inverse_of_tsais_formula(share: float, radius: float) -> None:
    """Tsai: the ideal position is the distorted one times 1 + kappa r^2."""
    kappa = share / CORNER_MM**2
    r = radius * CORNER_MM
    ideal = np.array([[r * (1.0 + kappa * r * r), 0.0]])
    assert distorted(ideal, kappa)[0, 0] == pytest.approx(r, abs=1e-9)


def test_a_pincushion_ends_where_its_formula_turns_back() -> None:
    kappa = -0.02
    turn = 1.0 / math.sqrt(3.0 * 0.02)
    largest = turn * (1.0 + kappa * turn**2)
    ideal = np.array([[0.999 * largest, 0.0], [1.001 * largest, 0.0]])
    near, beyond = distorted(ideal, kappa)
    assert 0.9 * turn < near[0] < turn
    assert np.isnan(beyond).all()


def test_the_horizontal_view_is_that_of_the_papers_camera() -> None:
    """48.8 degrees, without the distortion."""
    width = CameraSettings().camera().sensor.width_mm
    view = 2.0 * math.degrees(math.atan(0.5 * width / CameraSettings().focal_length_mm))
    assert view == pytest.approx(48.8, abs=0.1)


@given(cameras)
def test_the_optical_axis_meets_the_table_at_the_middle_of_the_picture(camera: Camera) -> None:
    center = np.array([SENSOR.center_px])
    assert np.allclose(camera.back_project(center), [[0.0, 21.7]], atol=1e-9)


def test_a_camera_that_looks_at_the_robot_has_its_right_on_the_left_of_the_picture() -> None:
    camera = CameraSettings().camera()
    assert camera.position == pytest.approx((0.0, 45.0, 52.0))
    assert camera.tilt_degrees == pytest.approx(25.0)
    right, left, near, far = flat(camera, np.array([(5, 22), (-5, 22), (0, 12), (0, 30)], float))
    assert right[0] < left[0]
    assert near[1] < far[1]


def test_what_is_behind_the_camera_has_no_pixel() -> None:
    camera = camera_at(50.0, 45.0, 180.0)
    x, y, z = camera.position
    behind = np.array([[x, y + 10.0, z], [x, y, z + 1.0]])
    assert np.isnan(camera.project(behind)).all()


def test_a_line_of_sight_over_the_horizon_meets_no_table() -> None:
    camera = camera_at(50.0, 85.0, 180.0)
    assert np.isnan(camera.back_project(np.array([[320.0, 0.0]]))).all()


@given(cameras)
def test_json_and_back(camera: Camera) -> None:
    assert Camera.from_json(json.loads(json.dumps(camera.as_json()))) == camera


@pytest.mark.parametrize(
    "change",
    [
        {"width_px": 0},
        {"height_px": 480.5},
        {"focal_length_mm": -1.0},
        {"focal_length_mm": math.nan},
        {"focal_length_mm": "five"},
        {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 2]]},
        {"rotation": [1, 2, 3]},
        {"translation_in": [1.0, math.inf, 0.0]},
        {"translation_in": None},
    ],
)
def test_a_camera_that_cannot_be_is_refused(change: dict[str, Any]) -> None:
    values = CameraSettings().camera().as_json() | change
    with pytest.raises((ValueError, TypeError)):
        Camera.from_json(values)
    with pytest.raises(KeyError):
        Camera.from_json({})
