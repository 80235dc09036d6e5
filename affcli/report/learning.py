"""Tables of what was learned (§6.1)."""

from collections.abc import Iterable, Sequence
from typing import Any

from affcli.analysis.inventions import in_passing
from affcli.core.records import LearningRunInfo
from affcli.core.results import BehaviorGroup
from affcli.report.sheet import Sheet
from affcli.report.words import (
    call_words,
    clock,
    degrees_of,
    many,
    run_words,
    seed_words,
    settings_words,
)


def groups_table(run: LearningRunInfo, groups: Sequence[BehaviorGroup]) -> Sheet:
    """Return the behavior-distance groups: tried, rows, mean movement and direction.

    Composed behaviors that were only tried in passing are one group.
    """
    table = Sheet(
        ("behavior", "tried", "rows", "inches", "degrees"),
        title=f"Run {run.id}: what the {run.spec.tool} affords, by behavior",
        caption="mean movement of the rows; degrees: 0 right, 90 away from the robot, 180 left",
        left=("behavior",),
    )
    passing = [one for one in groups if in_passing(one.call, run.spec.repertoire, one.rows)]
    for group in groups:
        if group in passing:
            continue
        length, (dx, dy) = group.mean_movement, (group.mean_dx, group.mean_dy)
        table.add(
            call_words(group.call),
            str(group.tried),
            str(group.rows),
            "-" if length is None else f"{length:.1f}",
            "-" if dx is None or dy is None else str(degrees_of(dx, dy)),
        )
    if passing:
        counts = (sum(one.tried for one in passing), sum(one.rows for one in passing))
        table.add(f"{len(passing)} composed in passing", *map(str, counts), "-", "-")
    return table


def learned_table(runs: Sequence[LearningRunInfo]) -> Sheet:
    """Return the learning runs, each with what is not the paper's or the default in it."""
    table = Sheet(
        ("run", "tool", "seed", "robot time", "behaviors", "rows", "resets", "settings"),
        title="Tools learned",
        caption="resets: the attractor put back by hand",
        left=("tool", "settings"),
    )
    for run in runs:
        unfinished = "" if run.status == "done" else " (unfinished)"
        table.add(
            str(run.id),
            f"{run.spec.tool}{unfinished}",
            seed_words(run.spec),
            clock(run.robot_seconds),
            str(run.behaviors),
            str(run.rows),
            str(run.resets),
            run_words(run.spec),
        )
    return table


def summary(run: LearningRunInfo) -> str:
    """Return in words what a learning run gave, robot time first."""
    counts = ((run.behaviors, "behavior"), (run.rows, "row"), (run.resets, "reset"))
    return ", ".join([clock(run.robot_seconds), *(many(count, noun) for count, noun in counts)])


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


def run_json(run: LearningRunInfo) -> dict[str, Any]:
    """Return a learning run as JSON types."""
    spec = run.spec
    return {
        "run": run.id,
        "session": run.session_id,
        "tool": spec.tool,
        "seed": None if spec.logged else spec.seed,
        "status": run.status,
        "begun": run.started_at,
        "note": run.note,
        "behaviors": run.behaviors,
        "rows": run.rows,
        "resets": run.resets,
        "robot_seconds": run.robot_seconds,
        "world": str(spec.world),
        "binding": " or ".join(map(str, spec.bindings)),
        "explorer": str(spec.explorer),
        "sensor": spec.sensor,
        "settings": settings_words(spec.settings),
        "repertoire": [str(one.call) for one in spec.repertoire],
    }
