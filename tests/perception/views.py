"""Random cameras over the table, and the scenes they look at."""

import math
from functools import cache

import numpy as np
from hypothesis import strategies as st

from affcli.core.geometry import Point, Pose
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import PUCK_COLOR, ToolName
from affcli.core.workspace import Workspace
from affcli.perception.camera import Array, Camera, ImageSensor, looking
from affcli.perception.camera_sensor import Eye, power_up
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.markers import Pattern
from affcli.simulation.tools.paper import TOOL_COLORS, paper_tools

WORKSPACE = Workspace()
COLORS = {str(name): color for name, color in TOOL_COLORS.items()}
"""The colour of each tool by its name."""
SENSOR = ImageSensor()
CORNER_MM = SENSOR.pitch_mm * math.hypot(SENSOR.width_px, SENSOR.height_px) / 2.0
"""How far a corner of the picture is from the principal point."""
PATTERN = Pattern(origin=Point(-12.5, 9.2))
"""As it lies on the table at power-up, but for the side from which the camera looks."""
SQUARE = ((-12.5, 9.2), (12.5, 34.2))
"""The square of 25 in that the markers span: its lower left and upper right corner."""


def rows_of(matrix: Array) -> tuple[tuple[float, ...], ...]:
    """Return a matrix as a camera keeps it."""
    return tuple(map(tuple, matrix.tolist()))


def camera_at(
    height: float,
    tilt_degrees: float,
    turn_degrees: float,
    focal_length_mm: float = 5.29,
    corner_distortion: float = 0.0,
    aim: tuple[float, float] = (0.0, 21.7),
) -> Camera:
    """Return a camera that aims at a point of the table.

    Args:
        height, tilt_degrees, turn_degrees, focal_length_mm: as in `CameraSettings`.
        corner_distortion: how far the lens moves a corner of the picture, as a share.
        aim: where the optical axis meets the table (in).
    """
    rotation = looking(math.radians(tilt_degrees), math.radians(turn_degrees))
    distance = height / math.cos(math.radians(tilt_degrees))
    center = np.array([*aim, 0.0]) - distance * rotation[2]
    kappa = corner_distortion / CORNER_MM**2
    translation = tuple((-rotation @ center).tolist())
    return Camera(SENSOR, focal_length_mm, kappa, rows_of(rotation), translation)


cameras = st.builds(
    camera_at,
    height=st.floats(50.0, 90.0),
    tilt_degrees=st.floats(0.0, 50.0),
    turn_degrees=st.floats(0.0, 360.0),
    focal_length_mm=st.floats(4.0, 8.0),
    corner_distortion=st.floats(-0.1, 0.1),
)
on_table = st.builds(Point, st.floats(-12.5, 12.5), st.floats(9.2, 34.2))


def random_camera(rng: np.random.Generator) -> Camera:
    """Return a camera that sees the whole pattern: heights 50 to 90 in, tilts 20 to 50 degrees."""
    while True:
        camera = camera_at(
            rng.uniform(50.0, 90.0),
            rng.uniform(20.0, 50.0),
            rng.uniform(0.0, 360.0),
            rng.uniform(4.5, 7.0),
            rng.uniform(-0.1, 0.1),
            (rng.uniform(-3.0, 3.0), 21.7 + rng.uniform(-3.0, 3.0)),
        )
        pixels = flat(camera, PATTERN.places)
        size = (SENSOR.width_px - 6, SENSOR.height_px - 6)
        if np.isfinite(pixels).all() and (pixels > 5.0).all() and (pixels < size).all():
            return camera


def flat(camera: Camera, points: Array) -> Array:
    """Return the pixels of points (n, 2) on the table."""
    return camera.project(np.column_stack([points, np.zeros(len(points))]))


def scene(
    puck: tuple[float, float] = (3.0, 22.4),
    wrist: tuple[float, float] = (0.0, 12.0),
    tool: str = "t-hook",
    goal: GoalRegion | None = None,
) -> Scene:
    """Return a table with a puck and a tool on it."""
    held = paper_tools(WORKSPACE.tools)[ToolName(tool)]
    return Scene(Pose(*puck), PUCK_COLOR, Pose(*wrist), held, goal)


@cache
def default_eye() -> Eye:
    """Return the default camera after power-up."""
    return power_up(CameraSettings(), WORKSPACE, COLORS, np.random.default_rng(7))


def gap(look: Scene) -> float:
    """Return how far the puck's rim is from the tool (in)."""
    parts = [part.placed(look.wrist) for part in look.tool.outlines]
    return min(p.distance(look.attractor.point) for p in parts) - WORKSPACE.puck.radius
