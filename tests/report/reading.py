"""Reading figures back: arrows, parts of tools, pucks and words."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Circle, Polygon
from matplotlib.text import Text

from affcli.core.geometry import Point
from affcli.report.figures.arrows import Arrow

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def arrows_in(axes: "Axes") -> list[Arrow]:
    """Return the arrows of a panel: from the beginning of each line to the tip of its head."""
    return [
        (Point(*map(float, line[0])), Point(*map(float, head[0])))
        for lines, heads in kinds_in(axes)
        for line, head in zip(lines.get_segments(), corners(heads), strict=True)
    ]


def kinds_in(axes: "Axes") -> list[tuple[LineCollection, PolyCollection]]:
    """Return the lines and the heads of each kind of arrows of a panel."""
    lines = [c for c in axes.collections if isinstance(c, LineCollection)]
    heads = [c for c in axes.collections if isinstance(c, PolyCollection)]
    return list(zip(lines, heads, strict=True))


def corners(heads: PolyCollection) -> list[list[tuple[float, float]]]:
    """Return the tip and the other two corners of each head."""
    vertices = [np.asarray(path.vertices, dtype=float) for path in heads.get_paths()]
    return [[(float(x), float(y)) for x, y in some[:3]] for some in vertices]


def texts(figure: "Figure") -> list[str]:
    """Return all that is written in a figure, empty texts left out."""
    return [text.get_text() for text in written(figure) if text.get_text()]


def written(figure: "Figure") -> Iterator[Text]:
    """Yield the texts of a figure."""
    found: list[Any] = figure.findobj(Text)
    yield from found


def outlines(axes: "Axes", *, dashed: bool) -> int:
    """Return how many parts of tools a panel has, whole or missing ones."""
    polygons = [patch for patch in axes.patches if isinstance(patch, Polygon)]
    return sum((polygon.get_linestyle() not in {"-", "solid"}) == dashed for polygon in polygons)


def right_edge(axes: "Axes") -> float:
    """Return how far right the parts of tools reach that a panel has (in)."""
    polygons = [patch for patch in axes.patches if isinstance(patch, Polygon)]
    return max(float(x) for polygon in polygons for x, _ in np.asarray(polygon.get_xy()))


def lower_edge(axes: "Axes") -> float:
    """Return how far down the parts of tools reach that a panel has (in)."""
    polygons = [patch for patch in axes.patches if isinstance(patch, Polygon)]
    return min(float(y) for polygon in polygons for _, y in np.asarray(polygon.get_xy()))


def circles(axes: "Axes") -> list[Circle]:
    return [patch for patch in axes.patches if isinstance(patch, Circle)]


def laid_out(figure: "Figure") -> Iterator[Text]:
    """Yield the texts of a figure but the numbers at its axes, some of which are not drawn."""
    yield from figure.texts
    for key in figure.legends:
        yield from key.get_texts()
    for axes in figure.axes:
        yield from axes.texts
        if axes.axison:
            yield from (axes.title, axes.xaxis.label, axes.yaxis.label)
