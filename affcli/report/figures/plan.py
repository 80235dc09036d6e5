"""What a planner looked at in one step of a trial: the moves ahead, and the plans that came close.

Places and movements are what the robot expected; where the step truly left the attractor is drawn
beside them.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from affcli.core.choice import Move, Reason
from affcli.core.geometry import Point
from affcli.core.records import StoredStep
from affcli.report.figures.arrows import Look, draw_arrows
from affcli.report.figures.canvas import BLUE, FAINT, INK, ORANGE, SMALL, canvas
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import fit_maps, map_panels
from affcli.report.figures.things import (
    draw_goal,
    draw_grasp,
    draw_parts,
    draw_puck,
    draw_table,
    goal_label,
)
from affcli.report.film import FilmedTrial

WIDTH = 4.6
FOLLOWED, OTHER = Look(BLUE, width=1.6, broad=0.8), Look("#8a8a8a", dashes=(3.0, 2.0), level=4.0)
HEADS = 1.2, 0.9
"""Lengths of the heads of arrows (in of the table)."""
END: dict[str, Any] = {"marker": "x", "color": INK, "markersize": 5, "linestyle": "none"}


def plan_figure(trial: FilmedTrial, step: StoredStep, width: float | None = None) -> Figure:
    """Draw a step's plan over the table as the planner saw it.

    Args:
        trial: which.
        step: one of its steps, in which the planner told a plan.
        width: in; what suits it if not given.
    """
    plans = plans_of(step)
    with canvas(WIDTH if width is None else width) as figure:
        (axes,) = map_panels(figure, 1, 1)
        draw_table(axes, trial.table, fill="white", edge=FAINT)
        draw_goal(axes, trial.goal, goal_label(trial.goal.name))
        draw_parts(axes, trial.held(step).parts, step.wrist_start)
        draw_grasp(axes, step.wrist_start)
        draw_puck(axes, step.seen_start, trial.puck_radius)
        for other in plans[1:]:
            _draw_moves(axes, step.seen_start, other.moves, OTHER, HEADS[1])
        _draw_moves(axes, step.seen_start, plans[0].moves, FOLLOWED, HEADS[0])
        for number, move in enumerate(plans[0].moves, 1):
            draw_puck(axes, Point(move.x, move.y), trial.puck_radius, before=True, color=BLUE)
            over = move.x, move.y + 0.6 * trial.puck_radius  # not under the head of the arrow
            axes.annotate(str(number), over, ha="center", va="center", fontsize=SMALL, zorder=7)
        axes.plot([step.seen_end.x], [step.seen_end.y], **END, zorder=8)
        draw_key(figure, _key(plans), "outside lower left", SMALL)
        fit_maps(figure, [axes], room=0.7, aspects=(0.5, 1.0))
    return figure


def plans_of(step: StoredStep) -> list[Reason]:
    """Return the plans that were told of a step, the one that was followed first."""
    return [reason for reason in step.reasons if reason.moves]


def _draw_moves(axes: Axes, start: Point, moves: Sequence[Move], look: Look, head: float) -> None:
    """Draw moves one after the other."""
    places = [start, *(Point(move.x, move.y) for move in moves)]
    draw_arrows(axes, list(pairwise(places)), look, head)


def _key(plans: Sequence[Reason]) -> list[tuple[Any, str]]:
    """Return what stands for what."""
    puck = Circle((0.0, 0.0), facecolor=ORANGE, edgecolor=INK, linewidth=0.8)
    ghost = Circle((0.0, 0.0), facecolor="none", edgecolor=BLUE, linewidth=0.8, linestyle="--")
    entries: list[tuple[Any, str]] = [
        (puck, "attractor"),
        (FOLLOWED, "moves of the plan"),
        (ghost, "where they should leave it"),
        (Line2D([], [], **END), "where the step left it"),
    ]
    return [*entries, (OTHER, "plans that came close")] if len(plans) > 1 else entries
