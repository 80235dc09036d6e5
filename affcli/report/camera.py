"""Tables of what a camera's calibration gave, and of what a picture shows."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rich.console import RenderableType

from affcli.errors import one_line
from affcli.report.sheet import Sheet

if TYPE_CHECKING:
    from affcli.perception.location import Place


def calibration_tables(
    found: Mapping[str, Any], position: Sequence[float], tilt: float
) -> tuple[RenderableType, ...]:
    """Return what a calibration found, and what is left at each marker.

    Args:
        found: what `Calibration.as_json` gives.
        position: where the camera stands (in, table frame).
        tilt: of its optical axis against straight down (degrees).
    """
    principal = "the middle of the picture, which is known"
    if "principal_point_px" in found:
        at, known = found["principal_point_px"], found["principal_point_deviation_px"]
        principal = f"{at[0]:.1f}, {at[1]:.1f} px (known to {known[0]:.1f}, {known[1]:.1f} px)"
    facts = {
        "focal length": f"{found['focal_length_mm']:.3f} mm"
        f" (known to {100.0 * found['focal_length_deviation']:.2g} %)",
        "principal point": principal,
        "radial distortion": f"{found['distortion_per_mm2']:.5f} per mm^2",
        "camera at x, y, z": ", ".join(f"{value:.2f}" for value in position) + " in",
        "tilt": f"{tilt:.1f} degrees from straight down",
        "error, per coordinate": f"{found['rms_px']:.3f} px, {found['rms_in']:.4f} in",
    }
    summary = Sheet(tuple(facts), records=True)
    summary.add(*facts.values())
    markers = found["markers"]
    columns = sum(marker["y_in"] == markers[0]["y_in"] for marker in markers)
    left = Sheet(
        ("y (in)", *(f"x {marker['x_in']:g}" for marker in markers[:columns])),
        title="What is left at each marker (px)",
        caption="by their place on the table",
    )
    rows = [markers[i : i + columns] for i in range(0, len(markers), columns)]
    for row in reversed(rows):
        sizes = (math.hypot(m["residual_x_px"], m["residual_y_px"]) for m in row)
        left.add(f"{row[0]['y_in']:g}", *(f"{size:.2f}" for size in sizes))
    return summary, left


def places_table(places: "Mapping[str, Sequence[Place]]") -> Sheet:
    """Return where on the table each colour is seen."""
    names = ("what", "seen", "x (in)", "y (in)", "at pixel", "pixels", "colour")
    table = Sheet(names, left=("what", "seen"), caption="colour: red, green, blue as seen")
    for name, found in places.items():
        if not found:
            table.add(one_line(name, 40), condition(found), *[""] * 5)
        for place in found:
            table.add(
                one_line(name, 40),
                condition(found),
                *(f"{round(v, 2) + 0.0:.2f}" if math.isfinite(v) else "-" for v in place.point),
                f"{place.blob.x:.1f}, {place.blob.y:.1f}",
                str(place.blob.area),
                ", ".join(f"{value:.0f}" for value in place.color),
            )
    return table


def places_json(places: "Mapping[str, Sequence[Place]]") -> list[dict[str, Any]]:
    """Return where on the table each colour is seen, as JSON types."""
    return [
        {
            "name": name,
            "condition": condition(found),
            "places": [
                {
                    "x_in": place.point.x,
                    "y_in": place.point.y,
                    "x_px": place.blob.x,
                    "y_px": place.blob.y,
                    "area_px": place.blob.area,
                    "color": list(place.color),
                }
                for place in found
            ],
        }
        for name, found in places.items()
    ]


def condition(found: "Sequence[Place]") -> str:
    """Return in words how often something is seen: that there is one of it is not a given."""
    return ("no", "once")[len(found)] if len(found) < 2 else f"{len(found)} times"
