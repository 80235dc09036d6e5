"""Tables of what was learned (§6.1)."""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import direction_degrees
from affcli.core.trial import LearningSpec
from affcli.report.sheet import Sheet


class BehaviorGroup(Protocol):
    """One moving behavior with one value of its parameter, in one learning run."""

    @property
    def call(self) -> BehaviorCall:
        """The behavior with its parameter."""

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
    def spec(self) -> LearningSpec:
        """What it is a function of."""

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


def groups_table(run: LearnedTool, groups: Iterable[BehaviorGroup]) -> Sheet:
    """Return the behavior-distance groups: tried, rows, mean movement and direction."""
    table = Sheet(
        ("behavior", "tried", "rows", "inches", "degrees"),
        title=f"Run {run.id}: what the {run.spec.tool} affords, by behavior",
        caption="mean movement of the rows; degrees: 0 right, 90 away from the robot, 180 left",
        left=("behavior",),
    )
    for group in groups:
        table.add(
            str(group.call),
            str(group.tried),
            str(group.rows),
            "-" if group.mean_movement is None else f"{group.mean_movement:.1f}",
            _direction(group),
        )
    return table


def _direction(group: BehaviorGroup) -> str:
    """Return the direction of the mean movement in degrees, - without rows."""
    if group.mean_dx is None or group.mean_dy is None:
        return "-"
    return str(whole_degrees(direction_degrees(group.mean_dx, group.mean_dy)))


def learned_table(tools: Sequence[tuple[LearnedTool, str]]) -> Sheet:
    """Return the learning runs, each with how its settings differ from the defaults."""
    table = Sheet(
        ("run", "tool", "seed", "robot time", "behaviors", "rows", "resets", "settings"),
        title="Tools learned",
        caption="resets: the attractor put back by hand",
        left=("tool", "settings"),
    )
    for run, settings in tools:
        unfinished = "" if run.status == "done" else " (unfinished)"
        table.add(
            str(run.id),
            f"{run.spec.tool}{unfinished}",
            str(run.spec.seed),
            clock(run.robot_seconds),
            str(run.behaviors),
            str(run.rows),
            str(run.resets),
            settings,
        )
    return table


def clock(seconds: float) -> str:
    """Return robot time as hours and minutes, or minutes and seconds below an hour."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {rest:02} s"


def whole_degrees(direction: float) -> int:
    """Return a direction as whole degrees from 0 to 359."""
    return round(direction) % 360


def summary(run: LearnedTool) -> str:
    """Return in words what a learning run gave, robot time first."""
    counts = ((run.behaviors, "behavior"), (run.rows, "row"), (run.resets, "reset"))
    words = (f"{count} {noun}{'s' if count != 1 else ''}" for count, noun in counts)
    return ", ".join([clock(run.robot_seconds), *words])


def groups_json(groups: Iterable[BehaviorGroup]) -> list[dict[str, Any]]:
    """Return the behavior-distance groups as JSON types."""
    return [
        {
            "behavior": group.call.name,
            "params": dict(group.call.params),
            "tried": group.tried,
            "rows": group.rows,
            "mean_movement": group.mean_movement,
            "mean_dx": group.mean_dx,
            "mean_dy": group.mean_dy,
        }
        for group in groups
    ]


def run_json(run: LearnedTool) -> dict[str, Any]:
    """Return a learning run as JSON types."""
    return {
        "run": run.id,
        "tool": run.spec.tool,
        "seed": run.spec.seed,
        "status": run.status,
        "behaviors": run.behaviors,
        "rows": run.rows,
        "resets": run.resets,
        "robot_seconds": run.robot_seconds,
    }
