"""The parts that a run carries: chosen by name, brought back from what was stored."""

from dataclasses import replace

import pytest

from affcli import registry
from affcli.config import Settings, settings_with
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.geometry import Point
from affcli.core.identity import Component, canonical_json
from affcli.core.motion import Slide
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.core.task import GoalRegion, Task
from affcli.core.tool import Tool, ToolName, unknown_tool
from affcli.core.workspace import ToolGeometry, Workspace
from affcli.errors import AffcliError, BadInputError, DatabaseError, UsageError
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import (
    RunParts,
    require_world_version,
    settings_of,
    tasks_of,
    tool_of,
    world_of,
)
from tests.factories import learning_spec, tool_named
from tests.lab.parts import CURIOUS, register

LEARNED = learning_spec()


def test_without_a_word_a_run_carries_the_papers_parts() -> None:
    parts = RunParts.chosen(Settings())
    assert [str(one) for one in (parts.world, parts.explorer, parts.binding)] == [
        "table@2",
        "random",
        "grasp 1",
    ]
    assert len(parts.repertoire) == 8
    assert LEARNED.settings == "{}"


def test_parts_are_chosen_with_parameters_and_repertoires_joined() -> None:
    parts = RunParts.chosen(
        Settings(),
        repertoire=["extend-arm:offset_distance=3", "paper"],
        binding="grasp:grasp_point=4",
    )
    first = parts.repertoire[0]
    assert str(first.call) == "extend arm 3"
    assert first.motion == (Slide(0.0, 3.0),)
    assert len(parts.repertoire) == 9
    assert parts.binding["grasp_point"] == 4.0


@pytest.mark.parametrize(
    ("chosen", "error", "says"),
    [
        ({"explorer": "randon"}, UsageError, "no explorer 'randon'; did you mean random"),
        ({"world": "tabel"}, UsageError, "no world 'tabel'; did you mean table"),
        ({"binding": "grasp:depth=1"}, BadInputError, "grasp: no parameter depth"),
        ({"repertoire": ["paper", "extend-arm"]}, UsageError, "extend arm 5 comes twice"),
        ({"explorer": "random@7"}, BadInputError, "this affcli has version 1 of random"),
    ],
)
def test_what_is_not_there_is_refused_in_a_line(
    chosen: dict[str, str], error: type[AffcliError], says: str
) -> None:
    with pytest.raises(error, match=says) as caught:
        RunParts.chosen(Settings(), **chosen)
    assert "\n" not in str(caught.value)


def test_settings_are_kept_as_what_differs_and_come_back_whole() -> None:
    other = settings_with({"babbling": {"draws": 12}, "sensor": {"kind": "exact"}}, "a test")
    spec = learning_spec(settings=other)
    assert spec.settings == '{"babbling.draws":12}'
    assert spec.sensor == "exact"
    assert settings_of(spec) == other
    assert settings_of(spec, "noisy").sensor.kind == "noisy"


def test_a_tool_is_the_one_that_was_learned_or_a_registered_one_in_the_runs_sizes() -> None:
    large = settings_with({"tools": {"handle_length": 15.0}}, "a test")
    spec = replace(learning_spec(settings=large), held=tool_named("stick"))
    assert tool_of(spec, "stick") == tool_named("stick")
    assert tool_of(spec, "l-hook") == tool_named("l-hook", large)
    with pytest.raises(UsageError, match="no tool 'spoon'"):
        tool_of(spec, "spoon")


def test_tasks_of_a_set_that_is_not_there() -> None:
    with pytest.raises(UsageError, match=r"no task 'juggling'.*affcli list tasks"):
        tasks_of(world_of(LEARNED), "juggling", 0)


BEHAVIOR = BehaviorCall.of(BehaviorName("juggle"), {})


@pytest.mark.parametrize(
    ("lacking", "error", "says"),
    [
        ({"world": Component("moon")}, BadInputError, "world moon: this affcli has no such part"),
        ({"world": Component("table", version=9)}, BadInputError, "version 9 of the world table"),
        ({"explorer": Component("levy")}, BadInputError, "explorer levy: this affcli has no such"),
        ({"explorer": Component("random", version=2)}, BadInputError, "random@2: this affcli has"),
        (
            {"explorer": Component.of("random", {"step": 2})},
            BadInputError,
            "random: no parameter step",
        ),
        ({"settings": canonical_json({"wings.span": 3.0})}, DatabaseError, r"wings\.span = 3"),
        ({"held": unknown_tool("spoon")}, DatabaseError, "what a spoon looks like"),
        ({"binding": BEHAVIOR}, BadInputError, "juggle: this affcli does not know where"),
    ],
)
def test_a_run_begins_with_all_its_parts_or_says_which_is_missing(
    lacking: dict[str, object], error: type[AffcliError], says: str
) -> None:
    with pytest.raises(error, match=says) as caught:
        LearningRun(replace(LEARNED, **lacking))  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


def test_an_older_world_is_used_for_new_things_and_refused_to_do_again() -> None:
    older = replace(LEARNED, world=Component("table", version=9))
    assert world_of(older).version == 2
    with pytest.raises(BadInputError, match="version 9"):
        world_of(older, again=True)
    with pytest.raises(BadInputError, match="made in version 9 of the world table"):
        require_world_version(older.world)


def test_a_repertoire_by_value_needs_no_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    """An interrupted run goes on with the motions that it began with."""
    before = [record.execution for record, _ in LearningRun(LEARNED).steps()]
    register(monkeypatch, without="paper")
    assert "paper" not in registry.parts("behaviors")
    assert [record.execution for record, _ in LearningRun(LEARNED).steps()] == before


def test_a_part_that_was_added_is_found_like_any_other(monkeypatch: pytest.MonkeyPatch) -> None:
    register(monkeypatch, CURIOUS)
    parts = RunParts.chosen(Settings(), explorer="curious:patience=2")
    assert parts.explorer == Component.of("curious", {"patience": 2.0})
    assert RunParts.chosen(Settings(), explorer="curious:patience=3").explorer.params == ()


def near(workspace: Workspace) -> tuple[Task, ...]:
    """Return one task that the paper has not: a small goal beside the start."""
    midline = workspace.layout.midline
    goal = GoalRegion("beside", Point(3.0, midline), 1.0)
    return (Task("near", goal, "middle", Point(0.0, midline)),)


def test_a_set_of_tasks_is_there_as_soon_as_it_is_registered(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    part = Part(kind="tasks", name="near", summary="one task", source="a test", build=near)
    with pytest.raises(UsageError, match="near"):
        tasks_of(world_of(LEARNED), "near", 0)
    before = world_of(LEARNED)
    register(monkeypatch, part)
    (task,) = tasks_of(world_of(LEARNED), "near", 0)
    assert (task.goal.name, task.start_name) == ("beside", "middle")
    with pytest.raises(UsageError, match="the world table has no tasks near"):
        tasks_of(before, "near", 0)


def pinching(geometry: ToolGeometry) -> BehaviorCall:
    return BehaviorCall.of(BehaviorName("pinch"), {"side": 2.0})


def test_a_binding_that_no_robot_can_execute_is_refused_before_a_run_begins(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    part = Part(kind="bindings", name="pinch", summary="s", source="a test", build=pinching)
    register(monkeypatch, part)
    with pytest.raises(BadInputError, match="where that binding holds the tool"):
        RunParts.chosen(Settings(), binding="pinch")
    with pytest.raises(BadInputError, match="has version 1 of grasp; leave the version out"):
        RunParts.chosen(Settings(), binding="grasp@2:angle=30")


def test_a_tool_has_the_name_of_its_part_and_takes_parameters(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    width = Setting(2.0, "in", "Of the head.", 1.0, 9.0)

    def rake(geometry: ToolGeometry, width: float) -> Tool:
        return replace(tool_named("t-stick"), name=ToolName("rake" if width < 8.0 else "fork"))

    register(
        monkeypatch,
        Part("tools", "rake", "a rake", "a test", build=rake, params={"width": width}),
    )
    parts = RunParts.chosen(Settings())
    assert parts.tool("rake:width=5").name == "rake"
    with pytest.raises(BadInputError, match="tool rake: its part makes a fork"):
        parts.tool("rake:width=8")
    with pytest.raises(BadInputError, match="rake: width = 20"):
        parts.tool("rake:width=20")
