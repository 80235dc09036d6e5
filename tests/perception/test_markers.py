"""The markers: found by colour, ordered into the grid from any view."""

import math
import re

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.core.geometry import Point
from affcli.core.tool import Color
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError
from affcli.perception.camera import Array, Camera
from affcli.perception.camera_sensor import MARKER_RADIUS, picture_of_pattern, table_pattern
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.grid_search import grid_among
from affcli.perception.markers import Pattern, find_markers, ordered
from affcli.perception.palette import MARKER_COLOR
from affcli.perception.rendering import Picture, Renderer
from affcli.perception.solids import circle
from tests.perception.views import PATTERN, SENSOR, camera_at, cameras, flat

CAMERA = CameraSettings()
TABLE_PATTERN = table_pattern(CAMERA, Workspace())


def picture(settings: CameraSettings = CAMERA, pattern: Pattern = TABLE_PATTERN) -> Picture:
    renderer = Renderer(settings, Workspace())
    return picture_of_pattern(renderer, pattern, np.random.default_rng(4))


def painted(center: Array, color: tuple[int, int, int], radius: int = 9) -> Picture:
    """Return the picture of the pattern with one more disc on it (blue green red)."""
    changed = picture().copy()
    x, y = np.rint(center).astype(int).tolist()
    cv2.circle(changed, (x, y), radius, color, -1)
    return changed


@settings(deadline=None)
@given(cameras, st.randoms(use_true_random=False))
def test_any_view_of_all_markers_gives_the_grid(camera: Camera, random: object) -> None:
    """Up to the quarter turn that equal markers leave open: x runs to the picture's right."""
    places = PATTERN.places
    pixels = flat(camera, places)
    if not np.isfinite(pixels).all():
        return
    shuffled = np.random.default_rng(abs(hash(random)) % 2**32).permutation(pixels)
    found = ordered(shuffled, PATTERN).reshape(6, 6, 2)
    grid = pixels.reshape(6, 6, 2)
    turned = [np.rot90(grid, k) for k in range(4)]
    assert any(np.array_equal(found, one) for one in turned)
    along_x = (found[:, -1] - found[:, 0]).mean(axis=0)
    assert along_x[0] >= abs(along_x[1]) - 1e-6


@pytest.mark.parametrize("turn", [0, 90, 180, 270])
def test_a_turn_says_how_the_pattern_lies(turn: int) -> None:
    """The camera turned by as much the other way sees the same order."""
    settings = CameraSettings(x=0.0, y=21.7, tilt_degrees=0.0, turn_degrees=(-turn) % 360.0)
    pixels = flat(settings.camera(), PATTERN.places)
    pattern = Pattern(origin=PATTERN.origin, turn=turn)
    assert np.allclose(ordered(pixels[::-1].copy(), pattern), pixels)


@pytest.mark.parametrize(("columns", "rows"), [(8, 5), (3, 3), (4, 7)])
def test_a_pattern_need_not_be_square(columns: int, rows: int) -> None:
    pattern = Pattern(columns, rows, 3.0, Point(-8.0, 12.0))
    settings = CameraSettings(y=0.0, height=50.0, turn_degrees=0.0)
    pixels = flat(settings.camera(), pattern.places)
    assert np.allclose(ordered(pixels[::-1].copy(), pattern), pixels)


def test_points_that_form_no_grid_are_refused() -> None:
    rng = np.random.default_rng(0)
    with pytest.raises(BadInputError, match="no grid of 6x6"):
        ordered(rng.uniform(0.0, 400.0, (36, 2)), PATTERN)
    line = np.column_stack([np.arange(36.0), np.arange(36.0)])
    with pytest.raises(BadInputError, match="lie on a line"):
        ordered(line, PATTERN)


def test_hundreds_of_points_of_which_none_is_a_corner_are_refused_at_once() -> None:
    """Not tried four by four: there are a thousand million ways to take four of them."""
    angles = np.arange(400) * 2.0 * np.pi / 400
    ring = 200.0 + 150.0 * np.column_stack([np.cos(angles), np.sin(angles)])
    with pytest.raises(BadInputError, match="no grid of 20x20"):
        ordered(ring, Pattern(20, 20))


@pytest.mark.parametrize("color", [None, MARKER_COLOR])
def test_the_markers_are_found_to_a_tenth_of_a_pixel(color: Color | None) -> None:
    found = find_markers(picture(), TABLE_PATTERN, color)
    truth = flat(CAMERA.camera(), TABLE_PATTERN.places)
    off = np.linalg.norm(found - truth, axis=1)
    assert off.max() < 0.2
    assert np.sqrt(np.mean(off**2)) < 0.1


def test_their_colour_is_found_among_others() -> None:
    """A few large things of other colours lie about; the markers are the many alike."""
    changed = picture().copy()
    cv2.rectangle(changed, (5, 5), (60, 90), (200, 60, 20), -1)
    cv2.circle(changed, (600, 40), 25, (30, 160, 60), -1)
    found = find_markers(changed, TABLE_PATTERN)
    assert np.allclose(found, find_markers(picture(), TABLE_PATTERN, MARKER_COLOR), atol=0.02)


RED = (40, 40, 200)
"""The colour of the markers, blue green red."""
REFERENCE = find_markers(picture(), TABLE_PATTERN, MARKER_COLOR)


def test_a_missing_marker_is_counted() -> None:
    truth = flat(CAMERA.camera(), TABLE_PATTERN.places)
    with pytest.raises(BadInputError, match="35 markers found instead of 36"):
        find_markers(painted(truth[7], (215, 220, 222), 11), TABLE_PATTERN)


OUTLIERS: dict[str, list[tuple[float, float]]] = {
    "at the edge": [(637.0, 329.0)],
    "at a corner": [(2.0, 2.0), (637.0, 477.0)],
    "between two markers": [(0.5, 0)],
    "between four": [(2.5, 3.5)],
    "beside the grid": [(6.0, 2.0)],
    "before and behind it": [(-1.0, 3.0), (3.0, 6.0)],
    "beyond a corner": [(5.7, 5.7), (-0.8, -0.7)],
    "many": [(0.5, 0.5), (2.5, 1.5), (4.5, 3.5), (1.5, 4.5), (5.5, 2.4), (-0.6, 5.0)],
}
"""Where, in pixels or else in spacings from the first marker, there are more red things."""


def pixel(place: tuple[float, float]) -> Array:
    if max(place) > 100.0 or place == (2.0, 2.0):
        return np.array(place)
    spaced = np.array([TABLE_PATTERN.origin]) + TABLE_PATTERN.spacing * np.array([place])
    found: Array = flat(CAMERA.camera(), spaced)[0]
    return found


@pytest.mark.parametrize("color", [None, MARKER_COLOR])
@pytest.mark.parametrize("places", OUTLIERS.values(), ids=OUTLIERS.keys())
def test_the_grid_is_found_among_other_things_of_its_colour(
    places: list[tuple[float, float]], color: Color | None
) -> None:
    changed = picture().copy()
    for place in places:
        x, y = (round(float(value)) for value in pixel(place))
        cv2.circle(changed, (x, y), 6, RED, -1)
    assert np.allclose(find_markers(changed, TABLE_PATTERN, color), REFERENCE, atol=0.02)


def test_a_thing_at_the_edge_is_not_called_a_marker() -> None:
    """One marker is covered, and something of their colour lies at the picture's edge."""
    truth = flat(CAMERA.camera(), TABLE_PATTERN.places)
    changed = painted(truth[7], (215, 220, 222), 11)
    cv2.circle(changed, (637, 329), 6, RED, -1)
    with pytest.raises(BadInputError) as raised:
        find_markers(changed, TABLE_PATTERN)
    says = (
        r"35 markers found instead of 36, and something of their colour at \(63\d, 329\) px is cut"
    )
    assert re.match(says, str(raised.value))


def test_a_covered_marker_is_missed_among_other_things() -> None:
    truth = flat(CAMERA.camera(), TABLE_PATTERN.places)
    changed = painted(truth[7], (215, 220, 222), 11)
    for place in OUTLIERS["many"]:
        x, y = (round(float(value)) for value in pixel(place))
        cv2.circle(changed, (x, y), 6, RED, -1)
    with pytest.raises(BadInputError, match="41 things of one colour found, and no grid of 6x6"):
        find_markers(changed, TABLE_PATTERN)


def test_a_larger_pattern_is_not_cut_to_size() -> None:
    """Which 5 of its 6 rows would be meant?"""
    with pytest.raises(BadInputError, match="36 things of one colour found, and no grid of 6x5"):
        find_markers(picture(), Pattern(6, 5, 5.0, TABLE_PATTERN.origin))


@settings(deadline=None, max_examples=60)
@given(cameras, st.integers(0, 2**32 - 1))
def test_any_view_of_all_markers_is_found_among_things_anywhere(camera: Camera, seed: int) -> None:
    """Of up to ten none is taken for a marker, and two leave no doubt.

    More may line up beside the grid so that half a row of it seems to be there.
    """
    pixels = flat(camera, PATTERN.places)
    if not np.isfinite(pixels).all():
        return
    rng = np.random.default_rng(seed)
    low, high = pixels.min(axis=0) - 60.0, pixels.max(axis=0) + 60.0
    things = rng.uniform(low, high, (int(rng.integers(11)), 2))
    gaps = np.linalg.norm(things[:, None] - pixels[None], axis=2).min(axis=1, initial=math.inf)
    spacing = np.linalg.norm(pixels[1:6] - pixels[0:5], axis=1).max()
    things = things[gaps > 0.4 * spacing]
    found = grid_among(rng.permutation(np.concatenate([pixels, things])), 6, 6)
    if found is None:
        assert len(things) > 2
    else:
        assert np.array_equal(np.unique(found, axis=0), np.unique(pixels, axis=0))


def test_what_lies_on_a_markers_place_beside_it_is_a_doubt() -> None:
    pixels = flat(camera_at(60.0, 30.0, 200.0), PATTERN.places)
    doubled = np.concatenate([pixels, pixels[14:15] + 4.0])
    assert grid_among(doubled, 6, 6) is None


def test_without_a_grid_there_is_an_answer_soon() -> None:
    things = np.random.default_rng(8).uniform(0.0, 500.0, (144, 2))
    assert grid_among(things, 6, 6) is None


def test_a_marker_cut_off_by_the_edge_is_named() -> None:
    truth = flat(CAMERA.camera(), TABLE_PATTERN.places)
    column = round(float(truth[:, 0].max()))
    cut = np.ascontiguousarray(picture()[:, :column])
    says = r"\d+ markers found instead of 36, and something of their colour at .* is cut off by"
    with pytest.raises(BadInputError, match=says):
        find_markers(cut, TABLE_PATTERN)


@pytest.mark.parametrize("grey", [0, 90, 255])
def test_without_markers_there_is_nothing_to_find(grey: int) -> None:
    blank = np.full((SENSOR.height_px, SENSOR.width_px, 3), grey, np.uint8)
    why = "over-exposed" if grey == 255 else "paint them in one strong colour"
    with pytest.raises(BadInputError, match=f"no markers found: .*{why}"):
        find_markers(blank, TABLE_PATTERN)


def test_a_marker_is_small() -> None:
    """§4: "small color markers ... 5 inches apart"."""
    assert 0.1 * TABLE_PATTERN.spacing >= MARKER_RADIUS
    assert (TABLE_PATTERN.columns, TABLE_PATTERN.rows, TABLE_PATTERN.spacing) == (6, 6, 5.0)


@pytest.mark.parametrize("color", [None, Color((220.0, 40.0, 40.0))])
def test_markers_on_a_brown_table_in_a_compressed_photograph(color: Color | None) -> None:
    """The table is saturated too, its hue 30 degrees from theirs, and JPEG blurs the colours."""
    camera = camera_at(55.0, 25.0, 40.0)
    x = np.mgrid[0:480, 0:640][1]
    wood = np.array([60.0, 90.0, 120.0]) * (1.15 - 0.4 * ((x / 640 - 0.3) ** 2))[:, :, None]
    photograph = (wood * (1.0 + 0.08 * np.sin(x / 37.0))[:, :, None]).astype(np.uint8)
    for place in PATTERN.places:
        disc = flat(camera, circle(Point(*place), 0.5))
        corners = np.rint(disc * 64.0).astype(np.int32)
        cv2.fillPoly(photograph, [corners], (40, 40, 220), cv2.LINE_AA, 6)
    noise = np.random.default_rng(0).normal(0.0, 3.0, photograph.shape)
    noisy = np.clip(cv2.GaussianBlur(photograph, (0, 0), 0.7) + noise, 0, 255).astype(np.uint8)
    _, data = cv2.imencode(".jpg", noisy, [cv2.IMWRITE_JPEG_QUALITY, 75])
    found = find_markers(np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), np.uint8), PATTERN, color)
    truth = flat(camera, PATTERN.places)
    nearest = np.linalg.norm(found[:, None] - truth[None], axis=2).min(axis=1)
    assert nearest.max() < 0.8
