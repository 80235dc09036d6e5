"""The robot's eye: picture, segmentation and calibration give the observation vector (§4, §5.2)."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import cv2
import numpy as np

from affcli.core.geometry import Point
from affcli.core.observation import Observation
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import Color
from affcli.core.workspace import Workspace
from affcli.errors import BadInputError
from affcli.perception.calibration import Calibration, calibrate
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.location import Locator
from affcli.perception.markers import Pattern, find_markers
from affcli.perception.palette import MARKER_COLOR, table_palette
from affcli.perception.rendering import Picture, Renderer
from affcli.perception.segmentation import Segmentation, Segmenter
from affcli.perception.solids import circle

# A picture is small: handing its parts to threads takes longer, and workers share the cores.
cv2.setNumThreads(1)

PATTERN_COLUMNS = PATTERN_ROWS = 6
PATTERN_SPACING = 5.0
"""§4: "A 6x6 calibration pattern ... 5 inches apart"."""
MARKER_RADIUS = 0.5
"""Of the small colour markers (in). Choice: large enough for a hundred pixels each."""
CARDBOARD = (228.0, 226.0, 220.0)
"""Colour of the cardboard on which the markers are."""
PUSHED_BEYOND = 5.0
"""A push may carry the puck's centre this far over the table's edge (in)."""


@dataclass(frozen=True)
class Eye:
    """A camera after power-up: it takes pictures, and the robot knows how it sees.

    Args:
        renderer: takes the pictures.
        calibration: what the robot found out about the camera.
        segmenter: sorts their pixels.
        locator: takes blobs back to the table.
    """

    renderer: Renderer
    calibration: Calibration
    segmenter: Segmenter
    locator: Locator

    def look(self, scene: Scene, rng: np.random.Generator) -> Segmentation:
        """Return what a picture of a scene shows; `rng` decides the noise.

        The same as `segmenter.segment(renderer.take(scene, rng))`, but for the parts of the picture
        that have no colour.
        """
        return self.segmenter.segment_detail(self.renderer.take_detail(scene, rng))


def power_up(
    settings: CameraSettings,
    workspace: Workspace,
    tools: Mapping[str, Color],
    rng: np.random.Generator,
) -> Eye:
    """Switch the camera on and calibrate it, as is done every time (§4).

    Args:
        settings: of the simulated camera. The robot knows only its image sensor.
        workspace: what stands on the table.
        tools: the colour of each tool that may be on it, by name.
        rng: decides the noise in the picture of the pattern.

    Raises:
        BadInputError: the camera does not see the whole pattern, or not the whole table, or it
            cannot be calibrated.
    """
    renderer = Renderer(settings, workspace)
    pattern = table_pattern(settings, workspace)
    picture = picture_of_pattern(renderer, pattern, rng)
    try:
        markers = find_markers(picture, pattern, MARKER_COLOR)
        calibration = calibrate(markers, pattern.places, settings.camera().sensor)
    except BadInputError as error:
        raise BadInputError(f"camera: {error}; see the section camera of the settings") from error
    _require_view(settings, workspace)
    locator = Locator(calibration.camera, workspace.puck)
    return Eye(renderer, calibration, Segmenter(table_palette(workspace, tools)), locator)


def table_pattern(settings: CameraSettings, workspace: Workspace) -> Pattern:
    """Return the pattern as it lies on the middle of the table while the camera is calibrated."""
    table = workspace.table
    return Pattern(
        PATTERN_COLUMNS,
        PATTERN_ROWS,
        PATTERN_SPACING,
        Point(
            -0.5 * PATTERN_SPACING * (PATTERN_COLUMNS - 1),
            0.5 * (table.near + table.far) - 0.5 * PATTERN_SPACING * (PATTERN_ROWS - 1),
        ),
        turn=round(-settings.turn_degrees / 90.0) * 90 % 360,
    )


def picture_of_pattern(renderer: Renderer, pattern: Pattern, rng: np.random.Generator) -> Picture:
    """Return a picture of the pattern on its cardboard, on the table."""
    low, high = pattern.places.min(axis=0), pattern.places.max(axis=0)
    (left, near), (right, far) = low - pattern.spacing / 2, high + pattern.spacing / 2
    sheet = np.array([(left, near), (right, near), (right, far), (left, far)])
    share = np.linspace(0.0, 1.0, 20, endpoint=False)[:, None]
    edges = np.concatenate(
        [(1 - share) * a + share * b for a, b in zip(sheet, np.roll(sheet, -1, 0), strict=True)]
    )
    discs = [(circle(Point(x, y), MARKER_RADIUS), MARKER_COLOR) for x, y in pattern.places.tolist()]
    return renderer.take_flat([(edges, CARDBOARD), *discs], rng)


def _require_view(settings: CameraSettings, workspace: Workspace) -> None:
    """Make sure that the camera sees the puck wherever a push may take it, and every wrist."""
    table, radius = workspace.table, workspace.puck.radius
    beyond = PUSHED_BEYOND + radius
    x, y = table.half_width + beyond, table.far + beyond
    corners = np.array([(s * x, y, 0.0) for s in (-1, 1)] + [(s * x, 0.0, 0.0) for s in (-1, 1)])
    camera = settings.camera()
    pixels = camera.project(corners)
    size = (camera.sensor.width_px, camera.sensor.height_px)
    if not ((pixels >= 0.0) & (pixels < size)).all():
        raise BadInputError(
            f"camera: it does not see the table and {PUSHED_BEYOND:g} in beyond; raise "
            "camera.height, or aim it by camera.y and camera.tilt_degrees"
        )


class CameraSensor:
    """The observation vector of §5.2 through the camera: it is given pictures and nothing else.

    o1 to o3 are where the attractor stands on the table, so o3 is 0, and o4 to o6 the same from the
    wrist; o7 to o12 are the colours as the camera sees them, in the light that falls there.

    Args:
        look: gives the scene of this moment, to take its picture.
        eye: the camera after power-up.
        rng: decides the noise in the pictures.
    """

    def __init__(self, look: Callable[[], Scene], eye: Eye, rng: np.random.Generator) -> None:
        self._look = look
        self._eye = eye
        self._rng = rng

    def observe(self) -> Observation:
        """Return the observation vector of this moment.

        Raises:
            NotSeenError: attractor, wrist or tool is not in view, or one is seen twice.
        """
        seen = self._eye.look(self._look(), self._rng)
        locator = self._eye.locator
        (x, y), color = locator.puck(seen)
        wrist = locator.wrist(seen)
        return Observation(
            *(x, y, 0.0), *(x - wrist.x, y - wrist.y, 0.0), *color, *locator.tool_color(seen)
        )

    def observe_goal(self) -> GoalRegion:
        """Return the goal region as seen; its name, which no camera sees, as it was given.

        Raises:
            LookupError: there is no goal on the table.
            NotSeenError: the goal is not in view.
        """
        scene = self._look()
        if scene.goal is None:
            raise LookupError("there is no goal region on the table")
        seen = self._eye.look(scene, self._rng)
        center, half_width = self._eye.locator.goal(seen)
        return GoalRegion(scene.goal.name, center, half_width)
