"""The experimenter puts the attractor where a row's start can be set up anew (§8)."""

import math
from dataclasses import replace
from functools import cache

import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.config import Settings
from affcli.core.affordance import Affordance
from affcli.core.behavior import BehaviorCall, ExecutionStatus
from affcli.core.geometry import Point, Pose
from affcli.errors import BadInputError
from affcli.lab.learning_run import LearningRun
from affcli.simulation import experimenter
from affcli.simulation.arm import reach_at
from affcli.simulation.table_world import TableSetting
from affcli.simulation.tools.paper import TOOL_PARTS
from tests.factories import EXACT, affordance, learning_spec, rows_learned, setting_with, tool_named

WORKSPACE = Settings().workspace
TABLE, ARM, RADIUS = WORKSPACE.table, WORKSPACE.arm, WORKSPACE.puck.radius
LOW, HIGH = reach_at(ARM, ARM.flange_height), reach_at(ARM, ARM.flange_height + ARM.lift_height)
HAIR = 1e-5
"""Wrists lie on a grid of 2^-20 in, and what is seen without noise is rounded."""
tools = st.sampled_from(sorted(TOOL_PARTS))
some_seeds = st.integers(0, 2**32)


@cache
def rows_of(tool: str, *, truncated: bool) -> tuple[Affordance, ...]:
    """Return rows learned without noise, those that met the edge of the reach or those that did
    not."""
    rows = rows_learned(tool, settings=EXACT)
    found = tuple(row for row in rows if row.truncated is truncated)
    assert found
    return found


def put_for(row: Affordance, tool: str, seed: int) -> TableSetting:
    """Return a table on which the attractor was put for a row."""
    setting = setting_with(tool, seed)
    setting.experimenter.put_attractor_for(row)
    return setting


def wrist_of(row: Affordance, setting: TableSetting) -> Point:
    """Return where the row's O^s asks the wrist to be."""
    at, offset = setting.table.attractor, row.start.wrist_to_object
    return Point(at.x - offset.x, at.y - offset.y)


def distance_gone(row: Affordance) -> float:
    """Return how far the wrist went when a row was made (in)."""
    start, end = row.start, row.end
    return math.dist(
        (start.object_x - start.wrist_to_object_x, start.object_y - start.wrist_to_object_y),
        (end.object_x - end.wrist_to_object_x, end.object_y - end.wrist_to_object_y),
    )


@settings(deadline=None, max_examples=60)
@given(tools, some_seeds, st.booleans(), st.data())
def test_the_rows_start_can_be_set_up_and_its_behavior_goes_as_far_as_it_did(
    tool: str, seed: int, truncated: bool, data: st.DataObject
) -> None:
    """Also of a row that met the edge of the reach: as far before the edge, and it meets it."""
    row = data.draw(st.sampled_from(rows_of(tool, truncated=truncated)))
    setting = put_for(row, tool, seed)
    at, wrist = setting.table.attractor, wrist_of(row, setting)
    assert abs(at.x) <= TABLE.half_width
    assert TABLE.near <= at.y <= TABLE.far
    assert LOW.holds(wrist)
    assert HIGH.holds(wrist)
    setting.table.wrist = Pose(*wrist)
    done = setting.robot.execute(row.exploratory, None)
    assert math.dist(done.wrist_start.point, done.wrist_end.point) == pytest.approx(
        distance_gone(row), abs=HAIR
    )
    expected = ExecutionStatus.TRUNCATED if truncated else ExecutionStatus.DONE
    assert done.status is expected


@settings(deadline=None, max_examples=30)
@given(tools, some_seeds, st.booleans(), st.data())
def test_the_tool_lies_beside_the_attractor_wherever_it_was(
    tool: str, seed: int, truncated: bool, data: st.DataObject
) -> None:
    """Where the tool is in the way it is put aside, within the reach."""
    row = data.draw(st.sampled_from(rows_of(tool, truncated=truncated)))
    setting = put_for(row, tool, seed)
    at = setting.table.attractor
    # Once more, with the tool right on it: the place of the same stream is another, so try on.
    setting.table.wrist = Pose(at.x, at.y - 10.0)
    setting.experimenter.put_attractor_for(row)
    at, wrist = setting.table.attractor, setting.table.wrist
    shape = shapely.union_all([shapely.Polygon(p.vertices) for p in setting.table.tool.outlines])
    assert shape.distance(shapely.Point(at.x - wrist.x, at.y - wrist.y)) >= RADIUS - 1e-9


def test_a_tool_in_the_way_is_put_aside_and_one_beside_stays() -> None:
    row = rows_of("t-hook", truncated=False)[0]
    moved = stayed = 0
    for seed in range(40):
        setting = setting_with("t-hook", seed)
        before = setting.table.wrist
        setting.experimenter.put_attractor_for(row)
        if setting.table.wrist == before:
            stayed += 1
        else:
            moved += 1
            twin = setting_with("t-hook", seed).table
            twin.attractor = setting.table.attractor
            assert not twin.clear_of_attractor(before)
    assert moved > 0
    assert stayed > 0


@pytest.mark.parametrize("truncated", [False, True])
def test_places_and_angles_are_fresh_every_time(truncated: bool) -> None:
    for row in rows_of("t-hook", truncated=truncated)[:5]:
        setting = setting_with("t-hook", 3)
        places = []
        for _ in range(60):
            setting.experimenter.put_attractor_for(row)
            places.append(setting.table.attractor)
        assert len({(p.x, p.y) for p in places}) == 60
        # Along an edge that is nearly straight across there may be little room; some there is.
        spread = max(math.dist(p[:2], q[:2]) for p in places for q in places)
        assert spread > 2.0
        assert min(p.angle for p in places) < -2.0
        assert max(p.angle for p in places) > 2.0


def test_the_same_seed_puts_it_at_the_same_place() -> None:
    row = rows_of("stick", truncated=False)[0]
    assert put_for(row, "stick", 8).table.attractor == put_for(row, "stick", 8).table.attractor
    assert put_for(row, "stick", 8).table.attractor != put_for(row, "stick", 9).table.attractor


@pytest.mark.parametrize("truncated", [False, True])
def test_where_chance_finds_no_place_it_is_the_rows_own(
    truncated: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(experimenter, "PLACEMENTS", 0)
    row = rows_of("t-hook", truncated=truncated)[0]
    setting = setting_with("t-hook", 1)
    with pytest.raises(BadInputError, match="the t-hook has no place beside the attractor"):
        setting.experimenter.put_attractor_for(row)
    at = setting.table.attractor
    assert (at.x, at.y) == pytest.approx(row.start.object_position)


def test_a_row_that_cannot_be_done_anywhere_is_bad_input_that_names_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """By what was seen, the wrist was 40 in away: the noise was that large."""
    monkeypatch.setattr(experimenter, "PLACEMENTS", 50)
    wild = affordance(17, at=Point(0.0, 60.0), offset=Point(0.0, 20.0))
    far_off = replace(wild, end=wild.end._replace(wrist_to_object_y=-90.0))
    with pytest.raises(
        BadInputError, match=r"^arm: row 17 \(extend arm 5\) cannot be done"
    ) as told:
        put_for(far_off, "stick", 0)
    assert "\n" not in str(told.value)


def test_a_verification_begins_with_the_tool_at_the_tables_centre_and_no_goal() -> None:
    setting = setting_with("stick", 0)
    held = tool_named("l-hook")
    setting.experimenter.lay_out_verification(held)
    table = setting.table
    assert (table.tool, table.goal, table.wrist) == (held, None, table.home)


def test_a_row_made_where_it_was_made_replicates_to_the_bit() -> None:
    """The row's own place, wrist and angle, without noise: the very same push."""
    steps = LearningRun(learning_spec(behaviors=400, settings=EXACT)).steps()
    setting = setting_with("t-hook", settings=EXACT)
    for record, truth in steps:
        if record.affordance is None or truth is None:
            continue
        row, offset = record.affordance, record.affordance.start.wrist_to_object
        setting.table.attractor = Pose(*truth.start)
        setting.table.wrist = Pose(0.0, 10.0)
        seen = setting.sensor.observe()
        aim = BehaviorCall.of(record.placing.call.name, {"x": offset.x, "y": offset.y})
        placed = setting.robot.execute(aim, seen)
        assert placed.status is ExecutionStatus.DONE
        assert placed.wrist_end == record.execution.wrist_start
        assert setting.sensor.observe() == row.start
        setting.robot.execute(row.exploratory, row.start)
        assert setting.sensor.observe() == row.end


@pytest.mark.parametrize("truncated", [False, True])
def test_a_row_keeps_how_far_the_wrist_went(truncated: bool) -> None:
    """By the joint encoders; seen without noise it is the same."""
    for row in rows_of("t-hook", truncated=truncated):
        assert math.hypot(*row.travel) == pytest.approx(distance_gone(row), abs=HAIR)
        assert row.wrist_angle == 0.0
