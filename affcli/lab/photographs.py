"""A person's own pictures: calibrate the camera that took them, and find what is on the table."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

from affcli import registry
from affcli.config import Settings, load_colors
from affcli.core.geometry import Point
from affcli.core.tool import Color
from affcli.errors import BadInputError, one_line
from affcli.simulation.sensing import eye_of, require_camera

if TYPE_CHECKING:
    from affcli.perception.calibration import Calibration
    from affcli.perception.camera_sensor import Eye
    from affcli.perception.location import Place
    from affcli.perception.markers import Pattern

SHOWN = "t-hook"
"""The tool in a picture that is of no run."""
LARGEST_FILE = 1_000_000
"""Bytes of a file of a calibration; one of 36 markers takes some 6,000."""


def eye_at(settings: Settings, seed: int) -> "Eye":
    """Return a camera of these settings, and of robot 0, which may see the tool that is shown."""
    tool = registry.tool(SHOWN, settings.workspace.tools)
    return eye_of(settings.camera, settings.workspace, tool, seed, 0)


def pattern_of(columns: int, rows: int, spacing: float, origin: Point, turn: int) -> "Pattern":
    """Return a pattern of markers (see `perception.markers.Pattern`)."""
    require_camera()
    from affcli.perception.markers import Pattern

    return Pattern(columns, rows, spacing, origin, turn)


def calibrate_picture(
    path: Path, pattern: "Pattern", color: Color | None, sensor_width: float
) -> "Calibration":
    """Calibrate the camera that took a picture of a pattern of markers.

    Args:
        path: of the picture.
        pattern: the markers and how they lie.
        color: of the markers; None to find it.
        sensor_width: of the image sensor (mm); it sets the scale of the focal length alone.

    Raises:
        BadInputError: the picture cannot be read, shows no such pattern, or gives no calibration.
    """
    require_camera()
    from affcli.perception.calibration import calibrate
    from affcli.perception.camera import ImageSensor
    from affcli.perception.images import read_picture, shrunk, unshrunk
    from affcli.perception.markers import find_markers

    picture = read_picture(path)
    height, width = picture.shape[:2]
    try:
        small, side = shrunk(picture)
        markers = unshrunk(find_markers(small, pattern, color), side)
        return calibrate(markers, pattern.places, ImageSensor(width, height, sensor_width))
    except BadInputError as error:
        raise BadInputError(f"{one_line(path)}: {error}") from error


def locate_in_picture(
    path: Path, calibration: Path, colors: Path | None
) -> dict[str, list["Place"]]:
    """Return where on the table a picture shows each colour; an empty list where it is not seen.

    Args:
        path: of the picture.
        calibration: what `affcli camera calibrate --out` wrote of the same camera in its place.
        colors: a TOML file of colour classes; None for those of the simulated table.

    Raises:
        BadInputError: a file cannot be read, the picture is of another size than the calibration's,
            or no colour is seen at all.
    """
    require_camera()
    from affcli.perception.camera import Camera
    from affcli.perception.images import read_picture, shrunk
    from affcli.perception.location import places_of
    from affcli.perception.segmentation import Segmenter

    classes = load_colors(colors)
    try:
        camera = Camera.from_json(_json(calibration))
    except KeyError as error:
        raise BadInputError(
            f"{one_line(calibration)}: not a calibration (no {one_line(error)} in it); make one "
            "with `affcli camera calibrate PICTURE --out FILE`"
        ) from error
    except (TypeError, ValueError, OverflowError) as error:
        raise BadInputError(
            f"{one_line(calibration)}: not a calibration ({one_line(error)}); make one with "
            "`affcli camera calibrate PICTURE --out FILE`"
        ) from error
    above = [one.name for one in classes if one.height >= camera.position[2]]
    if colors is not None and above:
        raise BadInputError(
            f"colors: {one_line(above[0], 40)}.height lies above the camera, which is "
            f"{camera.position[2]:.1f} in over the table; give inches over the table"
        )
    picture = read_picture(path)
    height, width = picture.shape[:2]
    size = (camera.sensor.width_px, camera.sensor.height_px)
    if (width, height) != size:
        raise BadInputError(
            f"{one_line(path)}: {width}x{height} pixels, but the camera was calibrated at "
            f"{size[0]}x{size[1]}; take both pictures alike"
        )
    small, side = shrunk(picture)
    places = places_of(Segmenter(classes).segment(small), camera, side)
    if not any(places.values()):
        names = ", ".join(one_line(name, 40) for name in places)
        raise BadInputError(
            f"{one_line(path)}: none of the colours is seen ({names}); uncover it, or give "
            "its colour as it looks in the picture (--colors)"
        )
    return places


def _json(path: Path) -> dict[str, object]:
    """Return the object in a JSON file.

    Raises:
        BadInputError: it cannot be read.
        ValueError: it is no JSON object.
    """
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise BadInputError(
            f"{one_line(path)}: {error.strerror}; give a file that `affcli camera calibrate` wrote"
        ) from error
    if len(text) > LARGEST_FILE:
        raise ValueError(f"more than {LARGEST_FILE} bytes")
    try:
        value = json.loads(text)
    except RecursionError as error:
        raise ValueError("nested too deeply") from error
    if not isinstance(value, dict):
        raise TypeError("no JSON object")
    return value
