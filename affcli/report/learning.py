"""Tables of what was learned (§6.1)."""

from collections.abc import Iterable, Sequence
from typing import Protocol

from rich.table import Table

from affcli.core.geometry import direction_degrees


class BehaviorGroup(Protocol):
    """One moving behavior with one value of its parameter, in one learning run."""

    @property
    def name(self) -> str:
        """The behavior with its parameter, as ``extend arm 5``."""

    @property
    def tried(self) -> int:
        """How often it was executed."""

    @property
    def rows(self) -> int:
        """How many rows of the affordance table it made."""

    @property
    def mean_movement(self) -> float | None:
        """Mean length of the rows' movements (in); None without rows."""

    @property
    def mean_dx(self) -> float | None:
        """Mean movement along x (in); None without rows."""

    @property
    def mean_dy(self) -> float | None:
        """Mean movement along y (in); None without rows."""


class LearnedTool(Protocol):
    """One learning run."""

    @property
    def id(self) -> int:
        """Its number in the database."""

    @property
    def tool(self) -> str:
        """The tool's name."""

    @property
    def seed(self) -> int:
        """Its seed."""

    @property
    def status(self) -> str:
        """``done`` or ``running``."""

    @property
    def behaviors(self) -> int:
        """Behaviors executed so far."""

    @property
    def rows(self) -> int:
        """Rows made so far."""

    @property
    def resets(self) -> int:
        """How often the attractor was put back by hand."""

    @property
    def robot_seconds(self) -> float:
        """Robot time so far (s)."""


def groups_table(tool: str, groups: Iterable[BehaviorGroup]) -> Table:
    """Return the eight behavior-distance groups: tried, rows, mean movement and direction."""
    table = Table(
        title=f"What the {tool} affords, by behavior",
        caption="direction: 0 right, 90 away from the robot, 180 left, 270 toward it",
        title_justify="left",
        caption_justify="left",
    )
    table.add_column("behavior")
    for column in ("tried", "rows", "mean movement", "mean direction"):
        table.add_column(column, justify="right")
    for group in groups:
        table.add_row(
            group.name,
            str(group.tried),
            str(group.rows),
            "-" if group.mean_movement is None else f"{group.mean_movement:.1f} in",
            _direction(group),
        )
    return table


def _direction(group: BehaviorGroup) -> str:
    """Return the direction of the mean movement in degrees, - without rows."""
    if group.mean_dx is None or group.mean_dy is None:
        return "-"
    return f"{direction_degrees(group.mean_dx, group.mean_dy) % 360:.0f} deg"


def learned_table(tools: Sequence[LearnedTool]) -> Table:
    """Return the learning runs: tool, seed, robot time, behaviors, rows, resets."""
    table = Table(title="Tools learned", title_justify="left")
    for column, justify in (
        ("run", "right"),
        ("tool", "left"),
        ("seed", "right"),
        ("robot time", "right"),
        ("behaviors", "right"),
        ("rows", "right"),
        ("resets", "right"),
    ):
        table.add_column(column, justify="left" if justify == "left" else "right")
    for run in tools:
        unfinished = "" if run.status == "done" else " (unfinished)"
        table.add_row(
            str(run.id),
            f"{run.tool}{unfinished}",
            str(run.seed),
            clock(run.robot_seconds),
            str(run.behaviors),
            str(run.rows),
            str(run.resets),
        )
    return table


def clock(seconds: float) -> str:
    """Return robot time as hours and minutes, or minutes and seconds below an hour."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {rest:02} s"
