"""``affcli camera locate``: where on the table a picture shows what is colour-coded (§4)."""

from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli.cli.options import AsJson
from affcli.cli.terminal import show_either
from affcli.report.camera import places_json, places_table
from affcli.simulation.sensing import require_camera


def locate(
    image: Annotated[
        Path, typer.Argument(help="A PNG or JPEG picture.", metavar="IMAGE", readable=False)
    ],
    *,
    calibration: Annotated[
        Path,
        typer.Option(
            "--calibration", help="What calibrate --out wrote.", metavar="FILE", readable=False
        ),
    ],
    colors: Annotated[
        Path | None,
        typer.Option("--colors", help="TOML: [name], rgb, height.", metavar="FILE", readable=False),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Say where a picture shows what is colour-coded.

    Without --colors it looks for the colours of the simulated table. In a file of colours a section
    [cup] with rgb = [30, 110, 200] looks for that colour; height, 0 if not given, is how high over
    the table the middle of the thing lies (inches).

    The principal point is where the calibration found it. Both pictures must be taken alike: camera
    in its place, same zoom, crop and lens.
    """
    require_camera()
    places = lab.photographs.locate_in_picture(image, calibration, colors)
    show_either(
        as_json=as_json,
        results=lambda: places_json(places),
        tables=lambda: [places_table(places)],
    )
