"""Film strips of trials made by hand."""

from dataclasses import replace

from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Movement
from affcli.core.records import StoredStep
from affcli.core.task import GoalRegion
from affcli.core.tool import ToolName
from affcli.core.workspace import TableSurface, ToolGeometry
from affcli.report.film import FilmedTrial
from affcli.simulation.tools.paper import paper_tools
from tests.factories import affordance, moved_by

TOOLS = paper_tools(ToolGeometry())
START = Point(9.0, 22.4)
TWO_LEFT = moved_by(-2.0, 0.0)


def filmed_step(
    number: int = 1,
    *,
    row: int = 7,
    at: Point = START,
    moved: tuple[float, float] = (-2.0, 0.0),
    expected: Movement = TWO_LEFT,
    behavior: str = "slide arm left 2",
    blocked: bool = False,
    lost: bool | None = None,
    excluded: bool = False,
    used: int = 2,
    successful: int = 2,
) -> StoredStep:
    """Return a step in which the wrist slid 2 in to the left; it replicated if the puck did too."""
    wrist = Pose(at.x - 2.0, at.y - 10.0)
    there = Point(at.x + moved[0], at.y + moved[1])
    still = moved == (0.0, 0.0)
    seen = moved_by(0.02, 0.01) if still else moved_by(*moved)
    return StoredStep(
        trial_id=1,
        number=number,
        clock=10.0 * number,
        reasons=(),
        affordance_id=row,
        row=replace(affordance(row), exploratory=BehaviorCall(BehaviorName(behavior), ())),
        regrasped=False,
        placing_status="blocked" if blocked else "done",
        status=None if blocked else "done",
        wrist_start=wrist,
        wrist_end=wrist if blocked else Pose(wrist.x - 2.0, wrist.y),
        seen_start=at,
        seen_end=there,
        true_start=at,
        true_end=there,
        expected=expected,
        seen=seen,
        seen_distance=seen.distance,
        replicated=not still,
        died=excluded,
        lost=lost,
        times_used_after=used,
        times_successful_after=successful,
    )


def in_vain(number: int, *, row: int = 7, blocked: bool = False) -> StoredStep:
    """Return a step in which the puck stayed where it was."""
    return filmed_step(number, row=row, moved=(0.0, 0.0), blocked=blocked)


def filmed_trial(
    *steps: StoredStep,
    ending: str | None = "solved",
    tool: str = "t-hook",
    shape: str | None = None,
) -> FilmedTrial:
    """Return a trial of these steps."""
    believed, held = TOOLS[ToolName(tool)], TOOLS[ToolName(shape or tool)]
    return FilmedTrial(
        title=f"Trial 1: {tool}, goal 3, start 4",
        caption="run 1",
        ending=ending,
        parts=held.parts,
        missing=believed.parts_missing_in(held),
        goal=GoalRegion("3", Point(-12.4, 22.4), 2.25),
        wrist=Pose(0.0, 15.0),
        puck=START,
        puck_radius=1.5,
        table=TableSurface(),
        steps=steps,
    )
