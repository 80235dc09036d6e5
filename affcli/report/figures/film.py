"""A replay as pictures: the table from above, drawn quickly, one picture a frame (§4: 15 Hz)."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.patches import Circle
from numpy.typing import NDArray

from affcli.core.geometry import Point
from affcli.core.replay import Replay, ReplayedStep
from affcli.core.scene import Scene
from affcli.core.task import GoalRegion
from affcli.core.tool import Color
from affcli.core.workspace import Workspace
from affcli.report.figures.canvas import FAINT, INK, ORANGE, canvas
from affcli.report.figures.things import draw_goal, draw_table, goal_label
from affcli.report.replaying import step_title
from affcli.report.words import call_words

Picture = NDArray[np.uint8]
"""Rows x columns x red, green, blue."""

SIZE = (4.8, 4.6)
"""Inches at 100 dots an inch."""
LIFTED = 0.45
"""How opaque a lifted tool is."""


class Film:
    """Draws scenes of one table; what never moves is drawn once.

    Args:
        workspace: the table's sizes.
        goal: on the table in all scenes; None while learning.
    """

    def __init__(self, workspace: Workspace, goal: GoalRegion | None) -> None:
        table, radius = workspace.table, workspace.puck.radius
        with canvas(*SIZE) as figure:
            axes = figure.add_axes((0.02, 0.02, 0.96, 0.86))
            axes.set_aspect("equal")
            axes.set_xlim(-table.half_width - 1.0, table.half_width + 1.0)
            axes.set_ylim(min(table.near, 4.0) - 1.0, table.far + 0.5)
            axes.axis("off")
            draw_table(axes, table, fill="#f7f5f0", edge=FAINT)
            if goal is not None:
                draw_goal(axes, goal, goal_label(goal.name))
            (self._path,) = axes.plot([], [], color=ORANGE, linewidth=0.9, zorder=2)
            self._tool = PolyCollection([], edgecolor=INK, linewidth=0.6, zorder=4)
            axes.add_collection(self._tool)
            self._puck = Circle((0.0, 0.0), radius, facecolor=ORANGE, edgecolor=INK, zorder=3)
            axes.add_patch(self._puck)
            (self._mark,) = axes.plot([], [], color=INK, linewidth=0.8, zorder=3)
            (self._wrist,) = axes.plot([], [], "+", color=INK, markersize=7, zorder=5)
            self._title = figure.text(0.03, 0.955, "", weight="bold")
            self._line = figure.text(0.03, 0.91, "")
            self._words = (self._title, self._line)
            self._moving = (self._path, self._tool, self._puck, self._mark, self._wrist)
            for artist in (*self._moving, *self._words):
                artist.set_animated(True)
            figure.set_layout_engine("none")
            self._canvas = FigureCanvasAgg(figure)
            self._canvas.draw()
            self._whole = figure.bbox
            self._still = self._kept = self._canvas.copy_from_bbox(self._whole)
            self._written = ("", "")
        self._radius = radius

    def picture(self, scene: Scene, path: Sequence[Point], title: str, line: str) -> Picture:
        """Return one frame.

        Args:
            scene: what is on the table.
            path: where the attractor has been (in, table frame).
            title, line: written above.
        """
        wrist, puck, color = scene.wrist, scene.attractor, scene.tool.color
        self._path.set_data([p.x for p in path], [p.y for p in path])
        self._tool.set_verts([part.placed(wrist).vertices for part in scene.tool.outlines])
        self._tool.set_facecolor(_color(color))
        self._tool.set_alpha(LIFTED if scene.lift > 0.0 else 1.0)
        self._puck.set_center(puck.point)
        # A line from the middle to the rim shows how the puck turns.
        rim = (self._radius * np.cos(puck.angle), self._radius * np.sin(puck.angle))
        self._mark.set_data([puck.x, puck.x + rim[0]], [puck.y, puck.y + rim[1]])
        self._wrist.set_data([wrist.x], [wrist.y])
        if (title, line) != self._written:
            self._write(title, line)
        self._canvas.restore_region(self._kept)
        for artist in self._moving:
            artist.draw(self._canvas.get_renderer())
        return np.asarray(self._canvas.buffer_rgba())[:, :, :3].copy()

    def _write(self, title: str, line: str) -> None:
        """Write the two lines on what never moves: letters take most of the time of a frame."""
        self._written = title, line
        self._canvas.restore_region(self._still)
        for artist, text in zip(self._words, self._written, strict=True):
            artist.set_text(text)
            artist.draw(self._canvas.get_renderer())
        self._kept = self._canvas.copy_from_bbox(self._whole)


def colors_of(replay: Replay) -> Picture:
    """Return a picture in which all colours of a trial's film are: the tool lifted, and not."""
    film = Film(replay.workspace, replay.opening.goal)
    title = step_title(replay, 1)
    return np.concatenate(
        [film.picture(replace(replay.opening, lift=lift), (), title, title) for lift in (0.0, 1.0)]
    )


def pictures_of(replay: Replay, numbers: Iterable[int], every: int = 1) -> Iterator[Picture]:
    """Yield the frames of some steps of a trial, in order.

    Args:
        replay: the trial.
        numbers: of the steps, counting from 1.
        every: only each n-th frame is drawn, counted from the last one; and the first.
    """
    film = Film(replay.workspace, replay.opening.goal)
    path: list[Point] = []
    wanted = set(numbers)
    left = all_frames = sum(len(replay.steps[number - 1].scenes) for number in wanted)
    for one in replay.steps:
        number = one.step.record.number
        for frame, scene in enumerate(one.scenes):
            place = scene.attractor.point
            if path[-1:] != [place]:
                path.append(place)
            if number not in wanted:
                continue
            left -= 1
            if left % every == 0 or left + 1 == all_frames:
                line = _line(one, frame)
                yield film.picture(scene, path, step_title(replay, number), line)


def _line(one: ReplayedStep, frame: int) -> str:
    """Return in words what a frame of a step shows; the last one, what came of the step."""
    record = one.step.record
    what = "position wrist" if frame < one.placed else call_words(record.row.exploratory)
    if frame + 1 == len(one.scenes):
        what = "replicated" if record.replicated else "not replicated"
        what += ", row excluded" if record.died else ""
        what += " (truly lost)" if one.step.lost else ""
    return f"row {one.considered[0].id}: {what}"


def _color(color: Color) -> tuple[float, float, float]:
    """Return a colour as matplotlib has it, a little paler so that lines on it show."""
    red, green, blue = (0.75 * part / 255.0 + 0.25 for part in color)
    return red, green, blue
