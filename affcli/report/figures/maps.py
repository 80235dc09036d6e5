"""Panels that show one part of a plane at one scale, and a page of the height that they need."""

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox

from affcli.report.figures.canvas import lay_out

LAYOUTS = 2
"""Times that a figure is laid out until its height is right."""


def columns_for(count: int, most: int) -> int:
    """Return how many of `count` panels stand in a row, so that all rows are about as full."""
    return math.ceil(count / math.ceil(count / most))


def map_panels(
    figure: FigureBase, count: int, columns: int, labels: tuple[str, str] = ("x (in)", "y (in)")
) -> list[Axes]:
    """Add `count` panels in rows of `columns`, labelled once below and once on the left."""
    if isinstance(figure, Figure):
        # In a page of its own: a key below the figure would lie over the label otherwise.
        figure = figure.add_subfigure(figure.add_gridspec(1, 1)[0])
    if any(labels):
        figure.supxlabel(labels[0])
        figure.supylabel(labels[1])
    grid = figure.subplots(math.ceil(count / columns), columns, squeeze=False)
    panels, spare = grid.flat[:count], grid.flat[count:]
    for axes in spare:
        axes.remove()
    for number, axes in enumerate(panels):
        left, last = number % columns == 0, number + columns >= count
        axes.tick_params(labelleft=left, labelbottom=last)
    return list(panels)


def fit_maps(
    figure: Figure,
    panels: Sequence[Axes],
    *,
    room: float,
    aspects: tuple[float, float],
    pages: int = 1,
) -> None:
    """Let all panels show the same part of the plane, and give the figure the height they need.

    Args:
        figure: of which the panels take the width.
        panels: with all that is drawn in them.
        room: around what is drawn (in of the table).
        aspects: height over width of a panel, at least and at most.
        pages: grids of panels, of as many rows each, that stand over one another.
    """
    drawn = [axes.dataLim for axes in panels if axes.has_data()]
    box = Bbox.union(drawn).padded(room)
    half_width = max(box.width, box.height / aspects[1]) / 2
    half_height = max(box.height, box.width * aspects[0]) / 2
    x, y = (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2
    for axes in panels:
        axes.set_xlim(x - half_width, x + half_width)
        axes.set_ylim(y - half_height, y + half_height)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    one, aspect = panels[0], half_height / half_width
    rows, columns = _grid_of(one)
    rows *= pages
    # Room for the panels at the full width, and more than enough for words. Until the height is
    # right the panels fill their cells: what stands beside a smaller one would take no room.
    figure.set_figheight(rows * (aspect * figure.get_figwidth() / columns + 0.5) + 2.0)
    for _ in range(LAYOUTS):
        lay_out(figure)
        cell = one.get_position(original=True).transformed(one.figure.transSubfigure)
        surplus = rows * (cell.height - aspect * cell.width) / figure.dpi
        figure.set_figheight(figure.get_figheight() - surplus)
    for axes in panels:
        axes.set_aspect("equal")


def _grid_of(axes: Axes) -> tuple[int, int]:
    """Return of how many rows and columns the grid is that axes are part of."""
    grid = axes.get_gridspec()
    if grid is None:
        raise ValueError("a panel that stands in no grid")
    return grid.nrows, grid.ncols
