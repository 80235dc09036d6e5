"""``affcli camera calibrate``: Tsai's calibration from a picture of markers (§4)."""

import json
import re
from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.files import require_new, save
from affcli.cli.options import (
    AsJson,
    Changes,
    Config,
    Force,
    Seed,
    checked_length,
    checked_numbers,
)
from affcli.cli.terminal import say, show_either
from affcli.config import load_settings
from affcli.core.geometry import Point
from affcli.core.tool import Color
from affcli.errors import BadInputError, UsageError, one_line
from affcli.report.camera import calibration_tables
from affcli.simulation.sensing import require_camera

TURNS = (0, 90, 180, 270)
LARGEST_GRID = 40
FEWEST = 3
"""Markers along a side of the pattern."""

MARKERS, SPACING, ORIGIN, SENSOR_WIDTH = "6x6", 5.0, "0,0", 4.8
"""§4: a 6x6 pattern, 5 in apart; the sensor of a 1/3-inch chip."""

Image = Annotated[
    Path | None,
    typer.Argument(
        help="A PNG or JPEG picture of the pattern; the simulated camera if not given.",
        metavar="IMAGE",
        readable=False,
    ),
]
Markers = Annotated[str, typer.Option("--markers", help="Columns by rows.", metavar="CxR")]
Spacing = Annotated[float, typer.Option("--spacing", help="Inches between them.", metavar="IN")]
MarkerColor = Annotated[
    str | None,
    typer.Option("--marker-color", help="#rrggbb or R,G,B; found if not given.", metavar="C"),
]
Turn = Annotated[
    int, typer.Option("--turn", help="How the pattern lies: 0, 90, 180 or 270.", metavar="DEG")
]
Origin = Annotated[
    str, typer.Option("--origin", help="The first marker on the table, inches.", metavar="X,Y")
]
SensorWidth = Annotated[
    float, typer.Option("--sensor-width", help="Of the camera's chip, mm.", metavar="MM")
]
Out = Annotated[
    Path | None, typer.Option("--out", help="Write the calibration as JSON.", metavar="FILE")
]


def calibrate(
    *,
    image: Image = None,
    markers: Markers = MARKERS,
    spacing: Spacing = SPACING,
    marker_color: MarkerColor = None,
    turn: Turn = 0,
    origin: Origin = ORIGIN,
    sensor_width: SensorWidth = SENSOR_WIDTH,
    out: Out = None,
    seed: Seed = 0,
    config: Config = None,
    changes: Changes = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Calibrate a camera from a picture of markers.

    By Tsai's method, from one picture of coplanar markers that form a grid.

    With --turn 0 the first marker is the lower left one in the picture and x runs to the right;
    each 90 turns that counter-clockwise. Equal markers cannot tell.

    Pixels are taken for square, and the principal point of a camera of yours for near the middle of
    the picture: 4 % of its width is one standard deviation. It is moved where the markers show that
    it is elsewhere; what they leave open is in the stated error of the focal length. Positions on
    the table hardly depend on it.
    """
    columns, rows = _grid(markers)
    color = None if marker_color is None else _color(marker_color)
    if turn not in TURNS:
        raise BadInputError(f"--turn {turn}: must be one of {', '.join(map(str, TURNS))}")
    checked_length("--spacing", spacing)
    checked_length("--sensor-width", sensor_width)
    first = Point(*checked_numbers("--origin", origin, 2))
    own = (markers, spacing, turn, origin, sensor_width) != (
        *(MARKERS, SPACING, 0, ORIGIN, SENSOR_WIDTH),
    )
    if image is None and (own or color is not None):
        raise UsageError("what describes the pattern goes with an IMAGE of it; give one")
    if image is not None and (seed != 0 or config is not None or changes):
        raise UsageError(
            "--seed, --config and --set are the simulated camera's; leave out IMAGE or them"
        )
    if out is not None:
        require_new(out, force=force)

    require_camera()
    if image is None:
        found = lab.photographs.eye_at(load_settings(config, changes or ()), seed).calibration
        values = found.as_json()
    else:
        pattern = lab.photographs.pattern_of(columns, rows, spacing, first, turn)
        found, capture = lab.photographs.calibrate_picture(image, pattern, color, sensor_width)
        values = {**found.as_json(), "capture": capture}
    if out is not None:
        save(out, (json.dumps(values, indent=2) + "\n").encode())
        say(f"the calibration is in {one_line(out)}")
    show_either(
        as_json=as_json,
        results=lambda: [values],
        tables=lambda: calibration_tables(values, found.camera.position, found.camera.tilt_degrees),
    )


def _grid(text: str) -> tuple[int, int]:
    """Return columns and rows of a pattern from ``6x6``."""
    found = re.fullmatch(r"(\d{1,3})x(\d{1,3})", text)
    columns, rows = (int(n) for n in found.groups()) if found else (0, 0)
    if not (FEWEST <= columns <= LARGEST_GRID and FEWEST <= rows <= LARGEST_GRID):
        raise BadInputError(
            f"--markers {one_line(text, 40)}: must be columns x rows, each {FEWEST} to "
            f"{LARGEST_GRID}, as in 6x6"
        )
    return columns, rows


def _color(text: str) -> Color:
    """Return a colour from ``#c82828`` or ``200,40,40``."""
    if re.fullmatch(r"#[0-9a-fA-F]{6}", text):
        return Color(float(int(text[i : i + 2], 16)) for i in (1, 3, 5))
    parts = checked_numbers("--marker-color", text, 3)
    if not all(0.0 <= part <= 255.0 for part in parts):
        raise BadInputError(f"--marker-color {one_line(text, 40)}: each must lie in 0 to 255")
    return Color(parts)
