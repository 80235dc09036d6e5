"""``affcli camera``: calibrate it, find things with it, look at what it sees (§4)."""

import json
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from affcli.cli.db import help_without_command
from affcli.cli.files import require_new, save
from affcli.cli.options import (
    DEFAULT_DATABASE,
    AsJson,
    Config,
    Database,
    Seed,
    checked_seed,
)
from affcli.cli.terminal import say, show, show_json
from affcli.core.geometry import Point
from affcli.core.tool import Color
from affcli.errors import BadInputError, UsageError, one_line

if TYPE_CHECKING:
    from affcli.store import StepScene

app = typer.Typer(help="The camera: calibrate it, find things with it.", rich_markup_mode=None)

TURNS = (0, 90, 180, 270)
LARGEST_GRID = 40
FEWEST = 3
"""Markers along a side of the pattern."""

Picture = Annotated[
    Path, typer.Argument(help="A PNG or JPEG picture.", metavar="IMAGE", readable=False)
]
Force = Annotated[bool, typer.Option("--force", help="Write over existing files.")]


@app.callback(invoke_without_command=True)
def root(context: typer.Context) -> None:
    """The camera: calibrate it, find things with it, look at what it sees."""
    help_without_command(context)


@app.command("calibrate")
def calibrate(
    *,
    image: Annotated[
        Path | None,
        typer.Argument(
            help="A PNG or JPEG picture of the pattern; the simulated camera if not given.",
            metavar="IMAGE",
            readable=False,
        ),
    ] = None,
    markers: Annotated[
        str, typer.Option("--markers", help="Columns by rows.", metavar="CxR")
    ] = "6x6",
    spacing: Annotated[
        float, typer.Option("--spacing", help="Inches between markers.", metavar="IN")
    ] = 5.0,
    marker_color: Annotated[
        str | None,
        typer.Option("--marker-color", help="#rrggbb or R,G,B; found if not given.", metavar="C"),
    ] = None,
    turn: Annotated[
        int,
        typer.Option("--turn", help="How the pattern lies: 0, 90, 180 or 270.", metavar="DEG"),
    ] = 0,
    origin: Annotated[
        str, typer.Option("--origin", help="The first marker on the table, inches.", metavar="X,Y")
    ] = "0,0",
    sensor_width: Annotated[
        float, typer.Option("--sensor-width", help="Of the camera's chip, mm.", metavar="MM")
    ] = 4.8,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Write the calibration as JSON.", metavar="FILE"),
    ] = None,
    seed: Seed = 0,
    config: Config = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Calibrate a camera from a picture of markers.

    By Tsai's method, from one picture of coplanar markers that form a grid.

    With --turn 0 the first marker is the lower left one in the picture and x runs to the right;
    each 90 turns that counter-clockwise. Equal markers cannot tell.
    """
    checked_seed(seed)
    columns, rows = _grid(markers)
    color = None if marker_color is None else _color(marker_color)
    if turn not in TURNS:
        raise BadInputError(f"--turn {turn}: must be one of {', '.join(map(str, TURNS))}")
    _positive("--spacing", spacing)
    _positive("--sensor-width", sensor_width)
    first = Point(*_numbers("--origin", origin, 2))
    if out is not None:
        require_new(out, force=force)

    from affcli.config import load_settings
    from affcli.lab.photographs import calibrate_picture, pattern_of
    from affcli.lab.sensing import eye_of, require_camera
    from affcli.report.camera import calibration_tables

    require_camera()
    if image is None:
        found = eye_of(load_settings(config), seed, 0).calibration
    else:
        pattern = pattern_of(columns, rows, spacing, first, turn)
        found = calibrate_picture(image, pattern, color, sensor_width)
    values = found.as_json()
    if out is not None:
        save(out, (json.dumps(values, indent=2) + "\n").encode())
        say(f"the calibration is in {one_line(out)}")
    if as_json:
        show_json(values)
    else:
        camera = found.camera
        show(*calibration_tables(values, camera.position, camera.tilt_degrees))


@app.command("locate")
def locate(
    image: Picture,
    *,
    calibration: Annotated[
        Path,
        typer.Option(
            "--calibration", help="What calibrate --out wrote.", metavar="FILE", readable=False
        ),
    ],
    colors: Annotated[
        Path | None,
        typer.Option("--colors", help="A TOML file of colours.", metavar="FILE", readable=False),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say where a picture shows what is colour-coded.

    Without --colors the colours of the simulated table are looked for.
    """
    from affcli.lab.photographs import locate_in_picture
    from affcli.report.camera import places_json, places_table

    places = locate_in_picture(image, calibration, colors)
    if as_json:
        show_json(places_json(places))
    else:
        show(places_table(places))


@app.command("view")
def view(
    *,
    out: Annotated[
        Path | None, typer.Option("--out", help="The picture, *.png.", metavar="FILE")
    ] = None,
    video: Annotated[
        Path | None, typer.Option("--video", help="15 frames/s, *.mp4 or *.avi.", metavar="FILE")
    ] = None,
    trial: Annotated[
        int | None, typer.Option("--trial", help="A trial's id in the database.", metavar="ID")
    ] = None,
    run: Annotated[
        int | None, typer.Option("--run", help="A learning run's id, instead.", metavar="ID")
    ] = None,
    step: Annotated[
        int, typer.Option("--step", help="Step of the trial, or behavior of the run.", metavar="N")
    ] = 1,
    after: Annotated[
        bool, typer.Option("--after", help="After the behavior, not before it.")
    ] = False,
    pattern: Annotated[
        bool, typer.Option("--pattern", help="The calibration pattern alone.")
    ] = False,
    frame: Annotated[bool, typer.Option("--frame", help="The camera's frame alone.")] = False,
    seed: Seed = 0,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    force: Force = False,
) -> None:
    """Show what the camera sees and how it is segmented.

    The frame, and beside it the segmentation with the centroids, as in Figs. 3 and 4.

    Of a step of a trial or a behavior of a learning run, whatever sensor it was seen through; or of
    the table as a trial begins.
    """
    checked_seed(seed)
    if out is None and video is None:
        raise UsageError("where to? give --out FILE.png, or --video FILE.mp4")
    if [trial is not None, run is not None, pattern].count(True) > 1:
        raise UsageError("give one of --trial, --run and --pattern")
    stored = trial is not None or run is not None
    if video is not None and not stored:
        raise UsageError("a video of what? give --trial ID or --run ID, and --step N")
    if not stored and (after or step != 1):
        raise UsageError("--step and --after go with --trial or --run")
    for path in filter(None, (out, video)):
        require_new(path, force=force)
    if out is not None and out.suffix.lower() != ".png":
        raise BadInputError(f"{one_line(out)}: name a picture *.png")

    from affcli.config import load_settings
    from affcli.lab.sensing import require_camera
    from affcli.lab.viewing import film_of_step, view_of_pattern, view_of_step, view_of_table

    require_camera()
    settings = load_settings(config)
    scene = _stored_scene(database, trial, run, step)
    if scene is not None:
        shown = view_of_step(scene, after=after)
        if video is not None:
            film_of_step(scene, video, frame_alone=frame)
            say(f"{scene.title}, {scene.call}: {one_line(video)}")
    else:
        shown = view_of_pattern(settings, seed) if pattern else view_of_table(settings, seed)
    if out is not None:
        save(out, shown.png(frame_alone=frame))
        say(f"{shown.title}: {one_line(out)}")


def _stored_scene(
    database: Path, trial: int | None, run: int | None, step: int
) -> "StepScene | None":
    """Return a step of a trial or a behavior of a run from the database; None for neither."""
    from affcli.store import open_store

    if trial is not None:
        with open_store(database, create=False, write=False) as store:
            return store.step_scene(trial, step)
    if run is not None:
        with open_store(database, create=False, write=False) as store:
            return store.behavior_scene(run, step)
    return None


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
    parts = _numbers("--marker-color", text, 3)
    if not all(0.0 <= part <= 255.0 for part in parts):
        raise BadInputError(f"--marker-color {one_line(text, 40)}: each must lie in 0 to 255")
    return Color(parts)


def _numbers(option: str, text: str, count: int) -> list[float]:
    """Return so many finite numbers from a text with commas."""
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(math.isfinite(v) and abs(v) <= 1e6 for v in values):
        raise BadInputError(
            f"{option} {one_line(text, 40)}: must be {count} numbers with commas between them"
        )
    return values


def _positive(option: str, value: float) -> None:
    """Make sure that a length is more than 0 and finite."""
    if not (math.isfinite(value) and 0.0 < value <= 1e6):
        raise BadInputError(f"{option} {value}: must be more than 0")
