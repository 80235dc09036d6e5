"""Tasks of a person's own: goals and starts, each goal from each start.

    [task]
    name = "corner"
    [[goal]]
    name = "far left"
    at = [-8, 26]
    half_width = 1.5
    [[start]]
    name = "middle"
    at = [0, 20]

Inches in the table frame: the origin under the arm's shoulder, x to the robot's right, y away.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from affcli.config import toml_file
from affcli.core.task import ALL_STARTS, GoalRegion, Task
from affcli.errors import BadInputError, one_line
from affcli.own_files.words import (
    at,
    checked_name,
    head,
    listed,
    number,
    point,
    require_tables,
)

MOST = 100
"""Of goals, and of starts."""
SMALLEST, WIDEST = 0.1, 10.0
"""Half the side of a goal region (in)."""


def tasks_from_file(path: Path) -> tuple[Task, ...]:
    """Return the tasks that a file describes.

    Raises:
        BadInputError: it cannot be read, or something in it is not as it must be; the message names
            the file and the place in it.
    """
    source = f"task {one_line(path)}"
    return tasks_of_tables(toml_file(path, source), source)


def tasks_of_tables(tables: Mapping[str, Any], source: str) -> tuple[Task, ...]:
    """Return the tasks that tables describe, as a file has them; see `tasks_from_file`."""
    with at(source):
        require_tables(tables, ("task", "goal", "start"))
        told = head(tables, "task", ("name",))
        name = checked_name(told.get("name"), "task: name")
        goals, starts = [], {}
        for place, one in listed(tables, "goal", ("name", "at", "half_width")):
            own = checked_name(one.get("name"), f"{place}: name")
            center = point(one.get("at"), f"{place}: at")
            half = number(one.get("half_width"), f"{place}: half_width", SMALLEST, WIDEST, "in")
            goals.append(GoalRegion(own, center, half))
        for place, one in listed(tables, "start", ("name", "at")):
            own = checked_name(one.get("name"), f"{place}: name")
            if own == ALL_STARTS or own in starts:
                raise BadInputError(f"{place}: name: {own} means another; give it another name")
            starts[own] = point(one.get("at"), f"{place}: at")
        for what, found in (("goal", goals), ("start", starts)):
            if not 1 <= len(found) <= MOST:
                raise BadInputError(
                    f"{len(found)} {what}s: write 1 to {MOST}, each under [[{what}]]"
                )
        if len({goal.name for goal in goals}) < len(goals):
            raise BadInputError("two goals have one name: give one another name")
        for goal in goals:
            for own, place_of_it in starts.items():
                if goal.contains(place_of_it):
                    raise BadInputError(
                        f"start {own} lies over goal {goal.name}: nothing would be left to do"
                    )
        return tuple(
            Task(name, goal, own, place_of_it)
            for goal in goals
            for own, place_of_it in starts.items()
        )
