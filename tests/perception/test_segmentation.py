"""Colour segmentation: robust to light and noise; what is missing or doubled has a name."""

import colorsys
from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from affcli.core.geometry import Pose
from affcli.core.scene import Scene
from affcli.core.tool import Color
from affcli.core.workspace import TaskLayout
from affcli.errors import BadInputError, NotSeenError
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.location import only_blob
from affcli.perception.palette import (
    CLOSEST_HUES,
    ColorClass,
    Role,
    class_of_hue,
    hue_distance,
    palette,
    table_palette,
)
from affcli.perception.rendering import Picture, Renderer
from affcli.perception.segmentation import NO_CLASS, Segmentation, Segmenter
from affcli.simulation.tasks.extension_of_reach import goal_regions
from affcli.simulation.tools.paper import TOOL_PARTS
from tests.perception.views import COLORS, WORKSPACE, scene

CLASSES = table_palette(WORKSPACE, COLORS)
SEGMENTER = Segmenter(CLASSES)
PUCK = next(c for c in CLASSES if c.role is Role.OBJECT)
components = st.floats(0.0, 255.0)
GOALS = goal_regions(TaskLayout())
NOTHING = scene((400.0, 300.0), (400.0, 300.0))
LOOKS = {
    "no goal": scene(),
    "goal beside the tool": scene(goal=GOALS["1"]),
    "goal under the tool": scene((0.0, 24.0), (-2.0, 12.0), "l-hook", GOALS["2"]),
    "lifted": replace(scene(tool="stick"), lift=1.6),
    "turned": replace(scene(tool="l-stick"), wrist=Pose(2.0, 14.0, 0.7)),
    "at the edge of the picture": scene((-21.0, 36.0), (0.0, 12.0)),
    "puck out of view": scene((400.0, 300.0)),
    "all out of view": NOTHING,
    "all but the goal out of view": scene((400.0, 300.0), (400.0, 300.0), goal=GOALS["3"]),
}


def blank() -> Picture:
    return np.full((480, 640, 3), (182, 197, 206), np.uint8)


def blue_green_red(color: Color) -> tuple[float, ...]:
    return tuple(reversed(color))


def blobs(seen: Segmentation, name: str) -> list[int]:
    """Return the areas of a class's blobs."""
    return [
        b.area
        for one, found in zip(seen.classes, seen.blobs, strict=True)
        if one.name == name
        for b in found
    ]


@pytest.mark.parametrize("light", [0.5, 0.75, 1.0, 1.05])
@pytest.mark.parametrize("one", CLASSES, ids=lambda one: one.name)
def test_a_colour_is_told_in_any_light(one: ColorClass, light: float) -> None:
    picture = blank()
    lit = tuple(min(255.0, light * c) for c in blue_green_red(one.color))
    cv2.circle(picture, (320, 240), 20, lit, -1)
    rng = np.random.default_rng(0)
    noisy = np.clip(np.rint(picture + rng.normal(0.0, 2.55, picture.shape)), 0, 255).astype(
        np.uint8
    )
    seen = SEGMENTER.segment(noisy)
    k = CLASSES.index(one)
    assert [len(found) for found in seen.blobs] == [int(j == k) for j in range(len(CLASSES))]
    blob = seen.blobs[k][0]
    assert (blob.x, blob.y) == pytest.approx((320.0, 240.0), abs=0.05)
    assert blob.area == pytest.approx(np.pi * 20.0**2, rel=0.01)
    assert seen.color(k, blob) == pytest.approx(tuple(reversed(lit)), abs=1.0)


@pytest.mark.parametrize("uneven", [0.0, 0.1, 0.3])
@pytest.mark.parametrize("tool", TOOL_PARTS)
def test_each_thing_on_the_table_is_one_blob(tool: str, uneven: float) -> None:
    settings = CameraSettings(uneven_light=uneven)
    look = scene((3.5, 20.0), (0.0, 10.0), tool, goal_regions(TaskLayout())["3"])
    seen = SEGMENTER.segment(Renderer(settings, WORKSPACE).take(look, np.random.default_rng(1)))
    for one in CLASSES:
        expected = int(one.role is not Role.TOOL or one.name == tool)
        assert len(blobs(seen, one.name)) == expected, one.name


def test_nothing_is_seen_on_a_bare_table() -> None:
    picture = Renderer(CameraSettings(), WORKSPACE).take_flat([], np.random.default_rng(1))
    seen = SEGMENTER.segment(picture)
    assert not any(seen.blobs)
    assert (seen.labels == NO_CLASS).all()


def test_blobs_are_listed_largest_first_and_specks_left_out() -> None:
    picture = blank()
    color = blue_green_red(PUCK.color)
    for x, radius in ((100, 10), (300, 20), (500, 2)):
        cv2.circle(picture, (x, 200), radius, color, -1)
    found = SEGMENTER.segment(picture).blobs[CLASSES.index(PUCK)]
    assert [round(b.x) for b in found] == [300, 100]
    assert (found[0].left, found[0].top, found[0].width) == (280, 180, 41)


@pytest.mark.parametrize(
    ("radii", "why"),
    [((), "sees no puck"), ((20, 15), "sees puck twice"), ((20, 20), "sees puck twice")],
)
def test_what_is_missing_or_doubled_is_a_named_condition(radii: tuple[int, ...], why: str) -> None:
    picture = blank()
    for k, radius in enumerate(radii):
        cv2.circle(picture, (100 + 200 * k, 200), radius, blue_green_red(PUCK.color), -1)
    seen = SEGMENTER.segment(picture)
    with pytest.raises(NotSeenError, match=why):
        only_blob(PUCK, seen.blobs[CLASSES.index(PUCK)])


def test_a_much_smaller_second_blob_is_no_second_puck() -> None:
    picture = blank()
    for x, radius in ((100, 20), (300, 7)):
        cv2.circle(picture, (x, 200), radius, blue_green_red(PUCK.color), -1)
    seen = SEGMENTER.segment(picture)
    assert round(only_blob(PUCK, seen.blobs[CLASSES.index(PUCK)]).x) == 100


@settings(deadline=None)
@given(st.lists(st.tuples(components, components, components), min_size=1, max_size=6))
def test_a_palette_tells_its_own_colours_apart_or_is_refused(
    colors: list[tuple[float, float, float]],
) -> None:
    asked = [ColorClass(str(k), Color(c), Role.OBJECT) for k, c in enumerate(colors)]
    refusal = ""
    try:
        classes = palette(asked)
    except BadInputError as error:
        classes, refusal = (), str(error)
    assert bool(classes) != refusal.startswith("colors: ")
    assert refusal.isprintable()
    for k, one in enumerate(classes):
        assert class_of_hue(classes, one.hue) == k
        others = [hue_distance(one.hue, other.hue) for other in classes if other is not one]
        assert min(others, default=180.0) >= CLOSEST_HUES


@given(st.floats(0.0, 360.0), st.floats(0.0, 360.0), st.floats(0.0, 360.0))
def test_hues_lie_on_a_circle(a: float, b: float, turn: float) -> None:
    distance = hue_distance(a, b)
    assert 0.0 <= distance <= 180.0
    assert distance == pytest.approx(hue_distance(b, a), abs=1e-9)
    assert distance == pytest.approx(hue_distance(a + turn, b + turn), abs=1e-6)


@given(st.tuples(components, components, components), st.floats(0.3, 1.0))
def test_light_does_not_change_the_hue(color: tuple[float, float, float], light: float) -> None:
    assume(max(color) - min(color) > 20.0)
    one = ColorClass("", Color(color), Role.OBJECT)
    dim = ColorClass("", Color(light * c for c in color), Role.OBJECT)
    assert hue_distance(one.hue, dim.hue) < 1e-6
    assert one.hue == pytest.approx(360.0 * colorsys.rgb_to_hsv(*(c / 255 for c in color))[0])


@pytest.mark.parametrize(
    ("noise", "blur", "least", "most"),
    [(2.55, 0.5, 0.0, 0.5), (0.0, 0.0, 0.0, 0.5), (2.55, 20.0, 0.0, 1.0), (20.0, 0.5, 1.0, 1.0)],
    ids=["as usual", "clear", "blurred", "so noisy that the bare table may have a colour"],
)
@pytest.mark.parametrize("look", LOOKS.values(), ids=LOOKS)
def test_a_detail_shows_what_the_whole_picture_shows(
    look: Scene, noise: float, blur: float, least: float, most: float
) -> None:
    """It leaves out nothing but pixels without a class; a detail too small would lose some."""
    renderer = Renderer(CameraSettings(grey_noise=noise, blur_px=blur), WORKSPACE)
    picture = renderer.take(look, np.random.default_rng(3))
    detail = renderer.take_detail(look, np.random.default_rng(3))
    height, width = detail.picture.shape[:2]
    rows = slice(detail.top, detail.top + height)
    columns = slice(detail.left, detail.left + width)
    assert np.array_equal(detail.picture, picture[rows, columns])
    assert least <= height * width / (480 * 640) <= (1.0 if look is NOTHING else most)
    whole, part = SEGMENTER.segment(picture), SEGMENTER.segment_detail(detail)
    assert np.array_equal(whole.labels, part.labels)
    assert whole.blobs == part.blobs
    for k, found in enumerate(whole.blobs):
        assert [whole.color(k, blob) for blob in found] == [part.color(k, blob) for blob in found]
