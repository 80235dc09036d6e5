"""Tasks at random places: within reach, the same for a seed, and refused where there are none."""

from dataclasses import replace

import pytest

from affcli import registry
from affcli.config import Settings
from affcli.core.geometry import Point, near_any
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.core.workspace import TableSurface, Workspace
from affcli.errors import BadInputError
from affcli.lab.run_parts import tasks_of
from affcli.simulation.experimenter import SimulatedExperimenter
from affcli.simulation.table import Table
from affcli.simulation.tasks.anywhere import anywhere
from affcli.simulation.tools.paper import paper_tools

SETTINGS = Settings()
WORKSPACE = SETTINGS.workspace
TOOLS = tuple(paper_tools(WORKSPACE.tools).values())
TASKS = anywhere(WORKSPACE, 0.5, 60, 7)


def touched(tool: Tool, place: Point) -> bool:
    """Tell whether the experimenter would say that a tool reaches the attractor at a place."""
    table = Table(WORKSPACE, SETTINGS.physics)
    experimenter = SimulatedExperimenter(table, None, ())  # type: ignore[arg-type]  # nothing is drawn
    experimenter.lay_out_trial(tool, place, TASKS[0].goal)
    return not experimenter.attractor_out_of_reach()


@pytest.mark.parametrize("task", TASKS[:12], ids=lambda task: task.start_name)
def test_some_tool_reaches_the_start_and_the_goal(task: Task) -> None:
    for place in (task.start, task.goal.center):
        assert any(touched(tool, place) for tool in TOOLS)


def test_the_places_are_all_over_what_the_tools_reach() -> None:
    """Uniformly: about as many in each half of it, each way."""
    top = WORKSPACE.table
    drawn = [place for task in TASKS for place in (task.start, task.goal.center)]
    for lowest, at in ((-top.half_width, [p.x for p in drawn]), (top.near, [p.y for p in drawn])):
        middle = (min(at) + max(at)) / 2.0
        assert middle - lowest > 6.0
        assert len(drawn) / 3 < sum(one < middle for one in at) < 2 * len(drawn) / 3


def test_no_start_lies_over_its_goal_or_under_a_tool_that_is_laid_out() -> None:
    x, y = WORKSPACE.wrist_start
    for task in TASKS:
        assert not task.goal.contains(task.start)
        beside = Point(task.start.x - x, task.start.y - y)
        assert not any(near_any(t.outlines, beside, WORKSPACE.puck.radius) for t in TOOLS)


def test_tasks_are_told_apart_and_name_the_set_that_they_are_of() -> None:
    assert len({(task.goal.name, task.start_name) for task in TASKS}) == len(TASKS)
    assert {task.task_set for task in TASKS} == {"anywhere:half_width=0.5,n=60,seed=7"}
    assert {task.goal.half_width for task in TASKS} == {0.5}


def test_tasks_are_a_function_of_their_seed_and_more_begin_with_fewer() -> None:
    assert [t.start for t in anywhere(WORKSPACE, 0.5, 5, 7)] == [t.start for t in TASKS[:5]]
    narrow = anywhere(WORKSPACE, 0.25, 60, 7)
    assert [task.start for task in narrow] == [task.start for task in TASKS]
    assert {t.start for t in anywhere(WORKSPACE, 0.5, 60, 8)}.isdisjoint(t.start for t in TASKS)


@pytest.mark.parametrize(
    ("text", "seed", "name"),
    [
        ("anywhere", 0, "anywhere"),
        ("anywhere:n=3", 9, "anywhere:n=3,seed=9"),
        ("anywhere:n=3,seed=4", 9, "anywhere:n=3,seed=4"),
        ("extension-of-reach", 9, "extension-of-reach"),
    ],
)
def test_the_seed_of_a_session_draws_the_tasks_unless_they_say_another(
    text: str, seed: int, name: str
) -> None:
    world = registry.world(registry.component("worlds", "table"), SETTINGS)
    assert {task.task_set for task in tasks_of(world, text, seed)} == {name}


def test_where_no_tool_reaches_it_is_said_at_once() -> None:
    far = replace(WORKSPACE, table=TableSurface(half_width=1.0, near=60.0, far=61.0))
    with pytest.raises(BadInputError, match="nobody could do it"):
        anywhere(far, 1.0, 1, 0)


def test_a_table_that_tools_and_goal_cover_leaves_no_task() -> None:
    narrow = replace(WORKSPACE, table=TableSurface(half_width=1.0, near=15.0, far=24.0))
    with pytest.raises(BadInputError, match="no place for a"):
        anywhere(narrow, 10.0, 20, 0)


def test_the_workspace_is_all_that_it_depends_on() -> None:
    assert anywhere(Workspace(), 2.25, 2, 0) == anywhere(WORKSPACE, 2.25, 2, 0)
