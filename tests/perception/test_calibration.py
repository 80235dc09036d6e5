"""Tsai's coplanar method: exact without noise, as good as OpenCV's with it, honest where blind."""

import math
import sys

import cv2
import numpy as np
import pytest

from affcli.errors import BadInputError
from affcli.perception.calibration import Calibration, calibrate
from affcli.perception.camera import Array, Camera
from tests.perception.views import PATTERN, SENSOR, camera_at, flat, random_camera

VIEWS, FEW = 200, 40
"""Views in `make torture`, and else: the first of them."""
REFUSALS = r"did not converge|no view of a plane|straight above"
MARKER_NOISE = 1.0
"""Standard deviation of each coordinate of a marker's centroid (px)."""


def grid() -> Array:
    """Return points all over the calibrated square (n, 2), in."""
    x, y = np.meshgrid(np.linspace(-12.5, 12.5, 11), np.linspace(9.2, 34.2, 11))
    return np.column_stack([x.ravel(), y.ravel()])


def table_errors(camera: Camera, found: Calibration) -> Array:
    """Return how far from where they are a calibration puts the points of a grid (n,), in."""
    errors: Array = np.linalg.norm(found.camera.back_project(flat(camera, grid())) - grid(), axis=1)
    return errors


def test_without_noise_the_camera_is_found_exactly() -> None:
    rng = np.random.default_rng(11)
    for _ in range(12):
        camera = random_camera(rng)
        found = calibrate(flat(camera, PATTERN.places), PATTERN.places, SENSOR)
        assert found.rms_px < 1e-6
        assert found.rms_in < 1e-6
        assert found.camera.focal_length_mm == pytest.approx(camera.focal_length_mm, rel=1e-6)
        assert found.camera.distortion_per_mm2 == pytest.approx(camera.distortion_per_mm2, abs=1e-8)
        assert found.camera.position == pytest.approx(camera.position, abs=1e-4)
        assert np.allclose(found.camera.rotation, camera.rotation, atol=1e-6)
        assert table_errors(camera, found).max() < 1e-6


@pytest.mark.torture
def test_two_hundred_views_with_a_pixel_of_noise(torture: bool) -> None:
    """Heights 50 to 90 in, tilts 20 to 50 degrees, distortion up to 10 % at the corner."""
    rng = np.random.default_rng(2008)
    views = VIEWS if torture else FEW
    squares, errors, refused, deviations = [], [], 0, []
    for _ in range(views):
        camera = random_camera(rng)
        noise = rng.normal(0.0, MARKER_NOISE, PATTERN.places.shape)
        try:
            found = calibrate(flat(camera, PATTERN.places) + noise, PATTERN.places, SENSOR)
        except BadInputError:
            refused += 1
            continue
        squares.append(found.rms_px**2)
        errors.append(table_errors(camera, found))
        off = found.camera.focal_length_mm / camera.focal_length_mm - 1.0
        deviations.append(off / found.focal_length_deviation)
    rms = math.sqrt(float(np.mean(squares)))
    median, most = np.percentile(np.concatenate(errors), [50, 95])
    sys.stdout.write(
        f"\n{views} views, {MARKER_NOISE} px of noise: {refused} refused; RMS per coordinate "
        f"{rms:.3f} px; on the table median {median:.3f} in, 95 % {most:.3f} in\n"
    )
    assert refused <= 0.01 * views
    assert rms <= 1.1
    assert most <= 0.15
    # What it says of its focal length is so: the errors are what their deviations promise.
    assert 0.85 <= float(np.std(deviations)) <= 1.2


def opencv(pixels: Array, focal_length_mm: float) -> tuple[float, Array, Array, Array, Array]:
    """Return what cv2.calibrateCamera finds with the same parameters fixed: rms, K, k, r, t."""
    points = np.column_stack([PATTERN.places, np.zeros(len(PATTERN.places))]).astype(np.float32)
    f = focal_length_mm / SENSOR.pitch_mm
    x, y = SENSOR.center_px
    guess = np.array([[f, 0.0, x], [0.0, f, y], [0.0, 0.0, 1.0]])
    flags = (
        cv2.CALIB_USE_INTRINSIC_GUESS
        | cv2.CALIB_FIX_PRINCIPAL_POINT
        | cv2.CALIB_FIX_ASPECT_RATIO
        | cv2.CALIB_ZERO_TANGENT_DIST
        | cv2.CALIB_FIX_K2
        | cv2.CALIB_FIX_K3
    )
    size = (SENSOR.width_px, SENSOR.height_px)
    rms, seen_matrix, seen_lens, turns, shifts = cv2.calibrateCamera(
        [points], [pixels.astype(np.float32)], size, guess, np.zeros(5), flags=flags
    )
    matrix, lens, turn, shift = (
        np.asarray(found, np.float64) for found in (seen_matrix, seen_lens, turns[0], shifts[0])
    )
    return rms, matrix, lens, turn, shift


def test_it_is_as_good_as_opencvs_on_the_same_points() -> None:
    """OpenCV's lens has k1 the other way round: alike to first order, so up to 3 % here."""
    rng = np.random.default_rng(5)
    ratios, apart, focal = [], [], []
    for _ in range(10):
        camera = camera_at(
            *(rng.uniform(50.0, 80.0), rng.uniform(25.0, 45.0), rng.uniform(0.0, 360.0)),
            corner_distortion=rng.uniform(-0.03, 0.03),
        )
        noise = rng.normal(0.0, 0.3, PATTERN.places.shape)
        pixels = flat(camera, PATTERN.places) + noise
        found = calibrate(pixels, PATTERN.places, SENSOR)
        rms, matrix, lens, turn, shift = opencv(pixels, found.camera.focal_length_mm)
        ratios.append(found.rms_px * math.sqrt(2.0) / rms)
        points = np.column_stack([grid(), np.zeros(len(grid()))])
        theirs, _ = cv2.projectPoints(points, turn, shift, matrix, lens)
        seen = found.camera.back_project(theirs[:, 0].astype(np.float64))
        apart.append(float(np.linalg.norm(seen - grid(), axis=1).max()))
        focal.append(abs(matrix[0, 0] * SENSOR.pitch_mm / found.camera.focal_length_mm - 1.0))
    sys.stdout.write(
        f"\nbeside cv2.calibrateCamera: error {np.median(ratios):.4f}x (at most "
        f"{max(ratios):.4f}x), focal length within {max(focal):.4f}, on the table within "
        f"{max(apart):.4f} in\n"
    )
    assert max(ratios) <= 1.01
    assert max(focal) <= 0.01
    assert max(apart) <= 0.02


@pytest.mark.parametrize(
    ("tilt", "noise"), [(0.0, 0.0), (0.0, 0.3), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (4.0, 1.0)]
)
def test_a_view_from_straight_above_is_recognised(tilt: float, noise: float) -> None:
    """There the method cannot tell focal length from distance."""
    camera = camera_at(60.0, tilt, 180.0)
    pixels = flat(camera, PATTERN.places)
    pixels += np.random.default_rng(3).normal(0.0, noise or 1e-9, pixels.shape)
    with pytest.raises(BadInputError, match="too nearly from straight above"):
        calibrate(pixels, PATTERN.places, SENSOR)


@pytest.mark.torture
def test_points_that_are_no_view_of_the_pattern_do_not_converge(torture: bool) -> None:
    """Points anywhere are given up only after as many evaluations as there may be."""
    rng = np.random.default_rng(1)
    anywhere = rng.uniform((50.0, 50.0), (600.0, 430.0), PATTERN.places.shape)
    shuffled = rng.permutation(flat(camera_at(60.0, 30.0, 0.0), PATTERN.places))
    for pixels in (shuffled, anywhere) if torture else (shuffled,):
        with pytest.raises(BadInputError, match=REFUSALS):
            calibrate(pixels, PATTERN.places, SENSOR)


def test_the_residuals_are_told_per_marker() -> None:
    camera = camera_at(60.0, 30.0, 200.0)
    pixels = flat(camera, PATTERN.places)
    pixels[14] += (3.0, -2.0)
    found = calibrate(pixels, PATTERN.places, SENSOR)
    values = found.as_json()
    sizes = [math.hypot(m["residual_x_px"], m["residual_y_px"]) for m in values["markers"]]
    assert len(sizes) == 36
    assert int(np.argmax(sizes)) == 14
    mean_square = sum(size**2 for size in sizes) / (2 * len(sizes))
    assert values["rms_px"] == pytest.approx(math.sqrt(mean_square))
    assert "markers" not in found.as_json(markers=False)
