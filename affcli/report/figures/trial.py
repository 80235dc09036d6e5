"""A film strip of a testing trial: what was expected and what was seen, step by step.

In the manner of the paper's Figs. 10 and 11.
"""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch

from affcli.core.geometry import Point, Pose
from affcli.core.observation import Movement
from affcli.core.records import StoredStep
from affcli.report.figures.arrows import Arrow, Look, draw_arrows
from affcli.report.figures.canvas import (
    BLUE,
    FAINT,
    INK,
    ONE_COLUMN,
    ORANGE,
    PALE,
    SMALL,
    TWO_COLUMNS,
    VERMILION,
    WOOD,
    canvas,
    wrapped,
)
from affcli.report.figures.key import draw_key
from affcli.report.figures.maps import fit_maps, map_panels
from affcli.report.figures.things import draw_goal, draw_grasp, draw_parts, draw_puck, draw_table
from affcli.report.film import COLUMNS, FilmedTrial, Held, Shown, take_title, take_verdict

BEFORE, AFTER = "#b4b4b4", "#6e6e6e"
"""Outlines of the tool before and after a behavior."""
PATH: dict[str, Any] = {"color": "#5a5a5a", "linewidth": 0.6}
EXPECTED, SEEN = Look(BLUE, width=2.4, broad=1.1), Look(INK, width=0.9, level=6.0)
"""Of two widths: one is seen beside the other where both are the same."""
HEADS = 1.8, 1.0
"""Lengths of their heads (in of the table)."""
SEEN_HEAD = 0.35
"""What is seen has a head of at most this share of the arrow: what lies below stays visible."""
OFF_TABLE = "#f3f3f3"
NARROWEST = 1.05
"""Width of a panel with what stands around it (in)."""
BOLD = 1.12
"""How much wider bold letters are."""


def trial_figure(trial: FilmedTrial, shown: Shown, width: float | None = None) -> Figure:
    """Draw a trial as a film strip.

    Things stand where they truly were. Both arrows begin there: what the row expected, and what the
    robot saw; a movement that the change detection function T does not detect has no arrow.

    Args:
        trial: which.
        shown: what of it gets a panel.
        width: in; what suits it if not given.
    """
    columns = min(COLUMNS, shown.panels)
    if width is None:
        width = ONE_COLUMN if columns <= 2 else TWO_COLUMNS
    columns = min(columns, int(width / NARROWEST))
    with canvas(width) as figure:
        panels = map_panels(figure, shown.panels, columns)
        for axes in panels:
            _draw_table(axes, trial)
        if shown.start:
            _draw_start(panels[0], trial)
        for axes, take in zip(panels[shown.start :], shown.takes, strict=True):
            _draw_step(axes, trial, take[-1])
            _write_over(axes, take, (width - 0.4) / columns - 0.06)
        if trial.ending is not None and shown.last == len(trial.steps):
            _write_ending(panels[-1], trial.ending)
        draw_key(figure, _key(trial, shown), "outside lower left", SMALL)
        fit_maps(figure, panels, room=0.7, aspects=(0.62, 1.0))
    return figure


def _draw_table(axes: Axes, trial: FilmedTrial) -> None:
    """Draw what all panels have: the table and the goal region."""
    axes.set_facecolor(OFF_TABLE)
    axes.spines[:].set(visible=True, color=FAINT)
    draw_table(axes, trial.table, fill="white", edge=FAINT)
    draw_goal(axes, trial.goal)


def _draw_start(axes: Axes, trial: FilmedTrial) -> None:
    """Draw the table as the trial begins."""
    _draw_tool(axes, trial.held(), trial.wrist)
    draw_puck(axes, trial.puck, trial.puck_radius)
    axes.set_title("start", loc="left", fontsize=SMALL, fontweight="bold")


def _draw_tool(axes: Axes, held: Held, wrist: Pose) -> None:
    """Draw the tool as it was held, filled, and what it lacks as dashed outlines."""
    draw_parts(axes, held.missing, wrist, edge=AFTER, missing=True)
    # Outlines first, then the parts over them: no seams where two parts meet.
    draw_parts(axes, held.parts, wrist, edge=AFTER)
    draw_parts(axes, held.parts, wrist, edge="none")
    draw_grasp(axes, wrist)


def _draw_step(axes: Axes, trial: FilmedTrial, step: StoredStep) -> None:
    """Draw one step."""
    outline = AFTER if step.blocked else BEFORE
    # A tool that could not be lowered is held over the table: nothing of it is filled.
    wrist = step.wrist_end if step.blocked else step.wrist_start
    held = trial.held(step)
    draw_parts(axes, held.missing, wrist, edge=outline, missing=True)
    draw_parts(axes, held.parts, wrist, edge=outline, fill="none")
    if step.blocked:
        draw_grasp(axes, wrist)
    else:
        _draw_tool(axes, held, step.wrist_end)
    if step.moved:
        draw_puck(axes, step.attractor_start, trial.puck_radius, before=True, color=INK)
    draw_puck(axes, step.attractor_end, trial.puck_radius)
    # The path leads through the steps that have no panel, too.
    so_far = [s for s in trial.steps if s.number <= step.number]
    path = [trial.puck, *(p for s in so_far for p in (s.attractor_start, s.attractor_end))]
    axes.plot(*zip(*path, strict=True), **PATH, zorder=4)
    draw_arrows(axes, [_arrow(step.attractor_start, step.expected)], EXPECTED, HEADS[0])
    if step.moved:
        length = min(HEADS[1], SEEN_HEAD * step.seen.distance)
        draw_arrows(axes, [_arrow(step.attractor_start, step.seen)], SEEN, length)


def _arrow(start: Point, movement: Movement) -> Arrow:
    """Return a movement as an arrow."""
    return start, Point(start.x + movement.dx, start.y + movement.dy)


def _write_over(axes: Axes, take: Sequence[StoredStep], room: float) -> None:
    """Write over a panel which steps it shows and what came of them; mark a row that is lost."""
    lost = take[-1].lost
    verdict = wrapped(take_verdict(take) + (", lost" if lost else ""), SMALL, room)
    title = wrapped(take_title(take), BOLD * SMALL, room)
    # The empty lines leave room for the other title.
    below = "\n" * (verdict.count("\n") + 1)
    axes.set_title(title + below, loc="left", fontsize=SMALL, fontweight="bold")
    axes.set_title(verdict, x=0.0, ha="left", fontsize=SMALL)
    if lost:
        axes.spines[:].set(color=VERMILION, linewidth=1.5)


def _write_ending(axes: Axes, ending: str) -> None:
    """Write how the trial ended into a panel, where that hides least."""
    axes.legend(
        [Line2D([], [], linestyle="none")],
        [ending],
        loc="best",
        frameon=True,
        edgecolor=INK,
        framealpha=1.0,
        fancybox=False,
        handlelength=0.0,
        handletextpad=0.0,
        prop={"size": SMALL, "weight": "bold"},
    )


def _key(trial: FilmedTrial, shown: Shown) -> list[tuple[Any, str]]:
    """Return what stands for what, of all that the panels show."""
    last = [take[-1] for take in shown.takes]
    puck = Circle((0.0, 0.0), facecolor=ORANGE, edgecolor=INK, linewidth=0.8)
    entries: list[tuple[Any, str]] = [(puck, "attractor")]
    if last:
        before = Circle((0.0, 0.0), facecolor="none", edgecolor=INK, linewidth=0.8, linestyle="--")
        tools = (_box("none", BEFORE), _box(WOOD, AFTER))
        entries = [
            (EXPECTED, "movement the row expects"),
            (SEEN, "movement seen"),
            ((before, puck), "attractor before and after"),
            (Line2D([], [], **PATH), "its path so far"),
            (tools, "tool before and after"),
        ]
    if trial.missing:
        entries.append((_box("none", AFTER, linestyle=(0, (3, 2))), "part that is missing"))
    if any(step.blocked for step in last):
        entries.append((_box("none", AFTER), "blocked: held over the table"))
    if any(step.lost for step in last):
        entries.append((_box("none", VERMILION, linewidth=1.5), "row the broken tool has lost"))
    return [*entries, (_box(PALE, INK), "goal region")]


def _box(fill: str, edge: str, **style: Any) -> Patch:
    """Return a box for the key."""
    return Patch(facecolor=fill, edgecolor=edge, **{"linewidth": 0.7, **style})
