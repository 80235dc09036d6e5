"""The mask of a tool, from a picture of it on the table (§4).

A tool stands up from the table, and the camera looks at it from one side: what has its colour in a
picture is its top and the sides that are turned to the camera. A place is under the tool if its
colour is seen both where the place is on the table and where it is at the height of the tool's top.
"""

import numpy as np

from affcli.core.geometry import Point
from affcli.core.mask import SCALE, Grid, Mask
from affcli.errors import NotSeenError
from affcli.perception.camera import Array, Camera
from affcli.perception.palette import Role
from affcli.perception.segmentation import Segmentation

MARGIN = 1.0
"""About what has the tool's colour it is looked for the tool (in)."""


def tool_mask(seen: Segmentation, camera: Camera, wrist: Point, name: str) -> Mask:
    """Return the mask of a tool, the wrist's angle 0.

    What the wrist hides is not in it.

    Args:
        seen: the picture.
        camera: as calibrated.
        wrist: where the wrist is seen (in, table frame).
        name: of the tool's colour class.

    Raises:
        NotSeenError: nothing of the tool is in view, or not all of it.
    """
    position = next(
        k for k, one in enumerate(seen.classes) if one.role is Role.TOOL and one.name == name
    )
    blobs, top = seen.blobs[position], seen.classes[position].height
    if not blobs:
        raise NotSeenError(f"the camera sees no {name}; bring it into view")
    height, width = seen.labels.shape
    boxes = [(b.left, b.top, b.left + b.width, b.top + b.height) for b in blobs]
    if any(x <= 0 or y <= 0 or right >= width or low >= height for x, y, right, low in boxes):
        raise NotSeenError(
            f"the camera does not see all of the {name}; see the section camera of the settings"
        )
    corners = np.array([(x, y) for box in boxes for x in box[::2] for y in box[1::2]], dtype=float)
    on_table = np.concatenate([camera.back_project(corners, h) for h in (0.0, top)]) - wrist
    column, row = (int(n) for n in np.floor((on_table.min(axis=0) - MARGIN) / SCALE))
    last_column, last_row = (int(n) for n in np.ceil((on_table.max(axis=0) + MARGIN) / SCALE))
    x = SCALE * (np.arange(column, last_column) + 0.5) + wrist.x
    y = SCALE * (np.arange(row, last_row) + 0.5) + wrist.y
    places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    shape = len(x), len(y)
    covered = [_shows(seen, position, camera, places, h).reshape(shape) for h in (0.0, top)]
    red, green, blue = seen.color(position, blobs[0])
    return Mask.of(covered[0] & covered[1], column, row, (red, green, blue))


def _shows(seen: Segmentation, position: int, camera: Camera, places: Array, height: float) -> Grid:
    """Tell at which places (n, 2) of one height (in) a colour is seen."""
    at = np.column_stack([places, np.full(len(places), height)])
    x, y = np.rint(camera.project(at)).astype(int).T
    rows, columns = seen.labels.shape
    inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
    found = np.zeros(len(places), dtype=bool)
    found[inside] = seen.labels[y[inside], x[inside]] == position
    return found
