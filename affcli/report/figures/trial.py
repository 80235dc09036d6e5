"""A film strip of a testing trial: what was expected and what was seen, step by step.

In the manner of the paper's Figs. 10 and 11.
"""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from affcli.core.geometry import Point
from affcli.report.figures.canvas import FAINT, INK, VERMILION, canvas
from affcli.report.figures.things import draw_goal, draw_grasp, draw_parts, draw_puck
from affcli.report.figures.trial_legend import (
    AFTER,
    BEFORE,
    EXPECTED,
    PATH,
    SEEN,
    SMALL,
    draw_legend,
    legend_entries,
)
from affcli.report.figures.trial_page import MARGIN, Box, Page, boxes_in, free_corner, page_for
from affcli.report.film import FilmedStep, FilmedTrial, Shown, take_title, take_verdict

OFF_TABLE = "#f3f3f3"


def trial_figure(trial: FilmedTrial, shown: Shown) -> Figure:
    """Draw a trial as a film strip.

    Things stand where they truly were. Both arrows begin there: what the row expected, and what the
    robot saw; a movement that the change detection function T does not detect has no arrow.

    Args:
        trial: which.
        shown: what of it gets a panel.
    """
    entries = legend_entries(trial, shown)
    page = page_for(trial, shown, len(entries))
    with canvas(page.width, page.height) as figure:
        figure.set_layout_engine("none")
        left = MARGIN / page.width
        _draw_head(figure, page, trial)
        _draw_panels(figure, page, trial, shown)
        if shown.note:
            under = (MARGIN + page.below - 0.05) / page.height
            figure.text(left, under, shown.note, va="top", fontsize=SMALL)
        if page.beside:
            edge, _, _, top = page.place(shown.panels)
            draw_legend(figure, entries, "upper left", (edge, top))
        else:
            corner = (left, MARGIN / page.height)
            draw_legend(figure, entries, "lower left", corner, page.across)
    return figure


def _draw_panels(figure: Figure, page: Page, trial: FilmedTrial, shown: Shown) -> None:
    """Draw the start, the steps, and how it ended."""
    if shown.start:
        axes = _panel(figure, page, 0, trial)
        draw_silhouette(axes, trial, trial.wrist)
        draw_grasp(axes, trial.wrist)
        draw_puck(axes, trial.puck, trial.puck_radius)
        _over(axes, "start", "")
    for number, take in enumerate(shown.takes, start=int(shown.start)):
        axes = _panel(figure, page, number, trial)
        _draw_step(axes, trial, take[-1], page.point)
        _over(axes, take_title(take), take_verdict(take))
        if take[-1].lost:
            _mark_as_lost(axes)
    if trial.ending is not None and shown.last == len(trial.steps):
        last = shown.takes[-1][-1] if shown.takes else None
        _draw_ending(figure.axes[-1], page, trial.ending, boxes_in(trial, last))


def _panel(figure: Figure, page: Page, number: int, trial: FilmedTrial) -> Axes:
    """Add a panel: a map without ticks, with the table and the goal region."""
    left, bottom, right, top = page.place(number)
    axes = figure.add_axes((left, bottom, right - left, top - bottom))
    axes.set_xlim(page.section.left, page.section.right)
    axes.set_ylim(page.section.bottom, page.section.top)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_facecolor(OFF_TABLE)
    for spine in axes.spines.values():
        spine.set(visible=True, color=FAINT)
    x, y, x_end, y_end = trial.table
    axes.add_patch(
        Rectangle(
            (x, y),
            x_end - x,
            y_end - y,
            facecolor="white",
            edgecolor=FAINT,
            linewidth=0.5,
            zorder=0,
        )
    )
    draw_goal(axes, trial.goal)
    return axes


def draw_silhouette(axes: Axes, trial: FilmedTrial, wrist: Point) -> None:
    """Draw the tool as it was held, filled, and what it lacks as dashed outlines."""
    draw_parts(axes, trial.missing, wrist, edge=AFTER, missing=True)
    # Outlines first, then the parts over them: no seams where two parts meet.
    draw_parts(axes, trial.parts, wrist, edge=AFTER)
    draw_parts(axes, trial.parts, wrist, edge="none")


def _draw_step(axes: Axes, trial: FilmedTrial, step: FilmedStep, point: float) -> None:
    """Draw one step.

    Args:
        axes: its panel.
        trial: what it is part of.
        step: which.
        point: how long a typographic point is on the table (in).
    """
    if step.blocked:
        # The tool is held over the table, where it could not be lowered: nothing of it is filled.
        draw_parts(axes, trial.missing, step.wrist_end, edge=AFTER, missing=True)
        draw_parts(axes, trial.parts, step.wrist_end, fill="none", edge=AFTER)
    else:
        draw_parts(axes, trial.missing, step.wrist_start, edge=BEFORE, missing=True)
        draw_parts(axes, trial.parts, step.wrist_start, fill="none", edge=BEFORE)
        draw_silhouette(axes, trial, step.wrist_end)
    draw_grasp(axes, step.wrist_end)
    draw_puck(axes, step.puck_end, trial.puck_radius)
    if step.moved:
        draw_puck(axes, step.puck_start, trial.puck_radius, before=True, color=INK)
    so_far = [s for s in trial.steps if s.number <= step.number]
    path = [trial.puck, *(p for s in so_far for p in (s.puck_start, s.puck_end))]
    axes.plot(*zip(*path, strict=True), color=PATH, linewidth=0.6, zorder=4)
    axes.add_patch(EXPECTED.drawn(step.puck_start, step.expected, point))
    if step.moved:
        axes.add_patch(SEEN.drawn(step.puck_start, step.seen, point))


def _over(axes: Axes, first: str, second: str, *, right: str = "") -> None:
    """Write two lines over a panel, and a word at the right of the second."""
    lines = (
        (first, 0.0, 12.0, INK, "bold"),
        (second, 0.0, 3.0, INK, "normal"),
        (right, 1.0, 3.0, VERMILION, "bold"),
    )
    for text, x, up, color, weight in (line for line in lines if line[0]):
        axes.annotate(
            text, (x, 1.0), (0.0, up),
            xycoords="axes fraction", textcoords="offset points",
            ha="right" if x else "left", color=color, fontweight=weight, fontsize=SMALL,
            parse_math=False,
        )  # fmt: skip


def _mark_as_lost(axes: Axes) -> None:
    """Mark a panel whose row the broken tool cannot do."""
    _over(axes, "", "", right="lost")
    for spine in axes.spines.values():
        spine.set(color=VERMILION, linewidth=1.5)


def _draw_head(figure: Figure, page: Page, trial: FilmedTrial) -> None:
    """Write which trial it is and how it ended; draw how long 5 in are at the right."""
    left, right = MARGIN / page.width, 1 - MARGIN / page.width
    top, second = 1 - MARGIN / page.height, 1 - (MARGIN + 0.23) / page.height
    figure.text(
        left, top, trial.title, va="top", fontsize=7.5, fontweight="bold", parse_math=False
    )  # fmt: skip
    figure.text(left, second, trial.course, va="baseline", fontsize=7.0)
    long = 5.0 / page.point / 72.0 / page.width
    bar = Line2D([right - long, right], [second, second], color=INK, linewidth=1.2)
    bar.set_solid_capstyle("butt")
    figure.add_artist(bar)
    figure.text(right - long - 0.04 / page.width, second, "5 in", ha="right", fontsize=SMALL)


def _draw_ending(axes: Axes, page: Page, ending: str, boxes: Sequence[Box]) -> None:
    """Write how the trial ended into its last panel, in a corner where it hides nothing."""
    width, height = (4.0 * len(ending) + 7.0) * page.point, 11.0 * page.point
    x, y = free_corner(page.section, boxes, width, height)
    axes.add_patch(
        Rectangle((x, y), width, height, facecolor="white", edgecolor=INK, linewidth=0.6, zorder=8)
    )
    axes.text(
        x + width / 2, y + 0.46 * height, ending,
        ha="center", va="center", fontsize=SMALL, fontweight="bold", zorder=9,
    )  # fmt: skip
