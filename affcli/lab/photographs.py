"""A person's own pictures: calibrate the camera that took them, and find what is on the table."""

from pathlib import Path

from affcli import registry
from affcli.bounded import file_bytes, json_value
from affcli.config import Settings, load_colors
from affcli.core.geometry import Point
from affcli.core.tool import Color
from affcli.errors import BadInputError, one_line
from affcli.perception.calibration import OFF_CENTER, Calibration, calibrate
from affcli.perception.camera import Camera, ImageSensor
from affcli.perception.camera_sensor import Eye
from affcli.perception.capture import Capture, checked_capture, orientation_for
from affcli.perception.images import read_photograph, shrunk, unshrunk
from affcli.perception.location import Place, places_of
from affcli.perception.markers import Pattern, find_markers
from affcli.perception.segmentation import Segmenter
from affcli.simulation.sensing import eye_of

SHOWN = "t-hook"
"""The tool in a picture that is of no run."""
REMEDY = "give a file that `affcli camera calibrate PICTURE --out FILE` wrote"


def eye_at(settings: Settings, seed: int) -> Eye:
    """Return a camera of these settings, and of robot 0, which may see the tool that is shown."""
    tool = registry.tool(SHOWN, settings.workspace.tools)
    return eye_of(settings.camera, settings.workspace, tool, seed, 0)


def pattern_of(columns: int, rows: int, spacing: float, origin: Point, turn: int) -> Pattern:
    """Return a pattern of markers (see `perception.markers.Pattern`)."""
    return Pattern(columns, rows, spacing, origin, turn)


def calibrate_picture(
    path: Path, pattern: Pattern, color: Color | None, sensor_width: float
) -> tuple[Calibration, Capture]:
    """Calibrate the camera that took a picture of a pattern of markers.

    Args:
        path: of the picture.
        pattern: the markers and how they lie.
        color: of the markers; None to find it.
        sensor_width: of the image sensor (mm); it sets the scale of the focal length alone.

    Returns:
        The calibration of the picture turned upright, and how it was taken.

    Raises:
        BadInputError: the picture cannot be read, shows no such pattern, or gives no calibration.
    """
    photograph = read_photograph(path)
    picture = photograph.upright
    height, width = picture.shape[:2]
    try:
        small, side = shrunk(picture)
        markers = unshrunk(find_markers(small, pattern, color), side)
        sensor = ImageSensor(width, height, sensor_width)
        found = calibrate(markers, pattern.places, sensor, OFF_CENTER * width)
    except BadInputError as error:
        raise BadInputError(f"{one_line(path)}: {error}") from error
    return found, photograph.capture


def locate_in_picture(path: Path, calibration: Path, colors: Path | None) -> dict[str, list[Place]]:
    """Return where on the table a picture shows each colour; an empty list where it is not seen.

    Args:
        path: of the picture.
        calibration: what `affcli camera calibrate --out` wrote of the same camera in its place.
        colors: a TOML file of colour classes; None for those of the simulated table.

    Raises:
        BadInputError: a file cannot be read, the picture was not taken as the calibration's, or no
            colour is seen at all.
    """
    classes = load_colors(colors)
    camera, kept = _stored_camera(calibration)
    above = [one.name for one in classes if one.height >= camera.position[2]]
    if colors is not None and above:
        raise BadInputError(
            f"colors: {one_line(above[0], 40)}.height lies above the camera, which is "
            f"{camera.position[2]:.1f} in over the table; give inches over the table"
        )
    photograph = read_photograph(path)
    picture = photograph.turned(orientation_for(photograph.capture, kept, one_line(path)))
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


def _stored_camera(path: Path) -> tuple[Camera, Capture | None]:
    """Return the camera in a file of a calibration, and how its picture was taken.

    Raises:
        BadInputError: it cannot be read, or is none.
    """
    data = file_bytes(path, one_line(path), REMEDY)
    try:
        values = json_value(data)
        if not isinstance(values, dict):
            raise TypeError("no JSON object")  # noqa: TRY301  # as all else that is none
        return Camera.from_json(values), checked_capture(values.get("capture"))
    except UnicodeDecodeError:
        what, remedy = "it is not UTF-8", "save it as UTF-8"
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        missing = isinstance(error, KeyError)
        what, remedy = f"no {one_line(error)} in it" if missing else one_line(error), REMEDY
    raise BadInputError(f"{one_line(path)}: not a calibration ({what}); {remedy}")
