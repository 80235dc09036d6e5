"""A principal point that is not the middle of the picture: found, or in the stated error.

The views have the form of those that Tsai published with his method: 10 by 10 coplanar points 20 mm
apart (lengths are in mm here), a lens of 257 mm, a principal point 26 pixels off the middle.
"""

import math

import numpy as np
import pytest

from affcli.errors import BadInputError
from affcli.perception.calibration import LEAST_ERROR, OFF_CENTER, Calibration, calibrate
from affcli.perception.camera import Array, Camera, ImageSensor, looking
from tests.perception.views import PATTERN, SENSOR, camera_at, flat, random_camera, rows_of

FOCAL_LENGTH = 257.0
PITCH = 0.023
"""The side of a pixel (mm)."""
SIDES = (580, 480)
PLACES = 20.0 * np.array([(x + 0.5, y + 0.5) for y in range(10) for x in range(10)])


def published(off: tuple[float, float], tilt: float = 20.0, turn: float = 70.0) -> Camera:
    """Return a camera whose principal point is so far off the middle of its picture (px)."""
    width, height = SIDES
    x, y = (width - 1) / 2.0 + off[0], (height - 1) / 2.0 + off[1]
    rotation = looking(math.radians(tilt), math.radians(turn))
    center = np.array([100.0, 100.0, 0.0]) - 6600.0 * rotation[2]
    sensor = ImageSensor(width, height, width * PITCH, (x, y))
    return Camera(sensor, FOCAL_LENGTH, -5e-4, rows_of(rotation), tuple(-rotation @ center))


def calibrated(camera: Camera, noise: Array) -> Calibration:
    """Return what is found without knowing where the principal point is."""
    width, height = SIDES
    sensor = ImageSensor(width, height, width * PITCH)
    return calibrate(flat(camera, PLACES) + noise, PLACES, sensor, OFF_CENTER * width)


@pytest.mark.parametrize("off", [(-26.0, 0.0), (0.0, 26.0), (18.4, -18.4), (0.0, 0.0)])
def test_the_stated_error_covers_the_focal_length(off: tuple[float, float]) -> None:
    rng = np.random.default_rng(1987)
    camera = published(off)
    for _ in range(8):
        found = calibrated(camera, rng.normal(0.0, LEAST_ERROR, PLACES.shape))
        error = found.camera.focal_length_mm / FOCAL_LENGTH - 1.0
        assert abs(error) <= 3.0 * found.focal_length_deviation
        assert found.focal_length_deviation < 0.25
        back = found.camera.back_project(flat(camera, PLACES))
        assert np.abs(back - PLACES).max() < 0.3


def test_the_principal_point_is_found_where_the_markers_tell() -> None:
    """Taken for the middle, the focal length is off by several times its stated error."""
    camera = published((0.0, 26.0))
    noise = np.random.default_rng(5).normal(0.0, 0.02, PLACES.shape)
    found = calibrated(camera, noise)
    assert found.principal_deviation_px is not None
    for axis in (0, 1):
        error = found.camera.sensor.center_px[axis] - camera.sensor.center_px[axis]
        assert abs(error) < min(10.0, 3.0 * found.principal_deviation_px[axis])
    sensor = ImageSensor(*SIDES, SIDES[0] * PITCH)
    middle = calibrate(flat(camera, PLACES) + noise, PLACES, sensor)
    error = abs(middle.camera.focal_length_mm / FOCAL_LENGTH - 1.0)
    assert error > 3.0 * middle.focal_length_deviation
    assert middle.rms_px > 1.5 * found.rms_px


@pytest.mark.torture
def test_over_many_cameras_the_errors_are_what_their_deviations_promise(torture: bool) -> None:
    rng = np.random.default_rng(4)
    shares = []
    for _ in range(60 if torture else 15):
        camera = random_camera(rng)
        off = rng.normal(0.0, OFF_CENTER * SENSOR.width_px, 2)
        pixels = flat(camera, PATTERN.places) + off
        pixels += rng.normal(0.0, 0.3, pixels.shape)
        found = calibrate(pixels, PATTERN.places, SENSOR, OFF_CENTER * SENSOR.width_px)
        error = found.camera.focal_length_mm / camera.focal_length_mm - 1.0
        shares.append(error / found.focal_length_deviation)
    assert 0.75 <= float(np.std(shares)) <= 1.3


@pytest.mark.parametrize("noise", [0.0, 0.3, 1.0])
def test_a_view_from_straight_above_is_still_recognised(noise: float) -> None:
    pixels = flat(camera_at(60.0, 1.0, 180.0), PATTERN.places)
    pixels += np.random.default_rng(3).normal(0.0, noise or 1e-9, pixels.shape)
    with pytest.raises(BadInputError, match="too nearly from straight above"):
        calibrate(pixels, PATTERN.places, SENSOR, OFF_CENTER * SENSOR.width_px)


def test_a_known_principal_point_is_not_spoken_of() -> None:
    """Calibrations of the simulated camera stay what they are."""
    camera = camera_at(60.0, 30.0, 200.0)
    pixels = flat(camera, PATTERN.places)
    known = calibrate(pixels, PATTERN.places, SENSOR).as_json()
    assert not any("principal" in name for name in known)
    assert Camera.from_json(known).sensor == SENSOR


def test_the_principal_point_is_kept_in_json() -> None:
    found = calibrated(published((-26.0, 0.0)), np.zeros(PLACES.shape))
    values = found.as_json()
    assert Camera.from_json(values) == found.camera
    assert len(values["principal_point_deviation_px"]) == 2
    for wrong in ([1.0], [1.0, math.nan], "x", [1e9, 0.0]):
        with pytest.raises(ValueError, match=r"unpack|within|convert") as raised:
            Camera.from_json({**values, "principal_point_px": wrong})
        assert raised.type is ValueError
