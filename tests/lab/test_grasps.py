"""A run whose tool is held in several ways: drawn, recorded, gone on with, used, done again."""

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import islice, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.config import Settings
from affcli.core.geometry import Point, Pose
from affcli.core.row_filter import RowFilter
from affcli.core.specs import LearningSpec
from affcli.core.tool import ToolName
from affcli.core.transfer import Borrowed, Borrowing, Transfer
from affcli.core.trial import BabblingRecord
from affcli.errors import AffcliError, BadInputError, UsageError
from affcli.lab.film_strips import film_of
from affcli.lab.learning_run import LearningRun
from affcli.lab.predicting import fresh_pushes
from affcli.lab.replaying import replay_run, replay_trial
from affcli.lab.run_parts import RunParts, beyond_the_box
from affcli.lab.table import listed_rows, taken_out
from affcli.lab.transferring import lendable, lender_of, lending
from affcli.lab.verifying import verification_spec, verify
from affcli.lab.viewing import scene_of_behavior, scenes_of_step
from affcli.report.film import take_title
from affcli.simulation.table_world import TableWorld
from affcli.store import Store
from tests.factories import tool_named, trial_spec
from tests.factories import verification_spec as pushes_spec
from tests.lab.quick import IMPATIENT, counted, learned, now, solving, stored

LOW, HIGH, TURNED = "grasp", "grasp:grasp_point=7", "grasp:grasp_point=8,angle=180"
SEVERAL = (HIGH, LOW, TURNED)
MANY = 250


@cache
def several(
    bindings: Sequence[str] = SEVERAL, explorer: str = "random", behaviors: int = MANY
) -> LearningSpec:
    """Return a run of the T-hook that is held in several ways."""
    parts = RunParts.chosen(IMPATIENT, binding=bindings, explorer=explorer)
    return parts.spec("t-hook", 0, 0, None, behaviors)


def records() -> list[BabblingRecord]:
    return [record for record, _ in learned(several())]


def test_rows_of_every_grasp_are_made_and_each_says_which_it_was() -> None:
    held = {record.binding for record in records()}
    assert held == set(several().bindings)
    rows = [(r.binding, r.affordance.binding) for r in records() if r.affordance is not None]
    assert {binding for binding, _ in rows} == held
    assert all(binding == of_row for binding, of_row in rows)


def test_taking_the_tool_anew_takes_robot_time() -> None:
    """Between two behaviors without a wrist position in vain: the way there, what is done, and the
    grasp where there is a new one."""
    regrasp, waited = IMPATIENT.workspace.motion.regrasp_time, set()
    done = records()
    for before, record in pairwise(done):
        if record.resets == 0 and record.redraws == 0:
            anew = record.binding != before.binding
            took = record.placing.duration + record.execution.duration + regrasp * anew
            assert record.clock - before.clock == pytest.approx(took)
            waited.add(anew)
    assert waited == {True, False}


@pytest.mark.parametrize("explorer", ["random", "occupancy"])
@pytest.mark.parametrize("stop", [0, 1, 90])
def test_a_run_stopped_anywhere_goes_on_as_if_it_had_not_been_stopped(
    explorer: str, stop: int
) -> None:
    """With the tool in the hand as it was, and what was explored with each grasp."""
    run = LearningRun(several(explorer=explorer, behaviors=120))
    before = tuple(islice(run.steps(), stop))
    again = LearningRun(run.spec, json.loads(json.dumps(run.checkpoint())))
    assert before + tuple(again.steps()) == learned(run.spec)


@given(st.permutations([LOW, HIGH, TURNED]), st.integers(1, 3))
def test_one_grasp_is_the_run_that_it_always_was_and_several_are_another(
    texts: list[str], many: int
) -> None:
    """Also in another order, for trials begin with the first; and one in a list is that one."""
    chosen = tuple(texts[:many])
    spec = several(chosen)
    assert [str(one) for one in spec.bindings] == [str(several((t,)).binding) for t in chosen]
    assert (spec.key == several((chosen[0],)).key) is (many == 1)
    assert many == 1 or spec.key != several((*chosen[1:], chosen[0])).key
    alone = RunParts.chosen(IMPATIENT, binding=chosen[0]).spec("t-hook", 0, 0, None, MANY)
    assert several((chosen[0],)) == alone
    assert isinstance(alone.canonical()["binding"], dict)


def test_it_is_stored_shown_used_and_done_again(store: Store) -> None:
    """Each step says how the tool was held, films hold it so, and all is equal to the record."""
    run = stored(store, several())
    assert run.spec == several()
    assert store.learning.find(several()) == run
    assert not any(one.differences for one in replay_run(store, run))
    for goal in "1234":
        counted(solving(store, run, goal))
    steps = [step for t in store.trials.trials() for step in store.trials.steps(t.id)]
    assert {step.regrasped for step in steps} == {True, False}
    assert len({step.row.binding for step in steps}) > 1
    for trial in store.trials.trials():
        assert replay_trial(store, trial.id).differences == ()
        film = film_of(store, trial.id)
        for step in film.steps:
            hold = step.row.binding["grasp_point"], step.row.binding.get("angle", 0.0)
            drawn = min(y for part in film.held(step).parts for _, y in part.outline.vertices)
            assert drawn == pytest.approx(-hold[0] if hold[1] == 0.0 else -(15.6 - hold[0]))
            assert (str(step.row.binding) in take_title([step])) is step.regrasped


def test_a_behavior_is_shown_as_the_tool_was_held_whether_or_not_it_made_a_row(
    store: Store,
) -> None:
    run = stored(store, several())
    for record in records()[::60]:
        assert scene_of_behavior(store, run.id, record.step).binding == record.binding
    number = next(r.step for r in records() if r.binding == several().bindings[2] and r.affordance)
    scene = scene_of_behavior(store, run.id, number)
    film = scenes_of_step(scene)
    assert film[-1].attractor.point == pytest.approx(scene.attractor_end, abs=0.02)


def test_its_rows_are_verified_each_with_its_own_grasp(store: Store) -> None:
    run = stored(store, several())
    spec = verification_spec(run, tool_named("t-hook"), 0, None, 40, until_verdict=False)
    tries = [one.record for one in verify(store, run, spec, now, update=False)]
    assert {use.regrasped for use in tries} == {True, False}
    assert sum(use.replicated for use in tries) >= 36


def test_fresh_pushes_are_made_with_each_grasp() -> None:
    spec = several()
    held = [r.binding for r in fresh_pushes(pushes_spec(spec, tries=30), spec)]
    assert set(held) == set(spec.bindings)


def test_what_another_grasp_can_touch_is_not_out_of_reach_of_a_trial() -> None:
    """§7.1: a trial ends when nothing that the robot can do touches the attractor."""
    near, both = several(("grasp:grasp_point=11",)), several(("grasp:grasp_point=11", LOW))
    out = {}
    for learned_by in (near, both):
        setting = TableWorld(IMPATIENT).trial(trial_spec(learned_by), learned_by)
        setting.robot.execute(setting.binding, None)
        setting.table.attractor = Pose(0.0, 30.0)
        out[learned_by] = setting.experimenter.attractor_out_of_reach()
        setting.table.attractor = Pose(0.0, 40.0)
        assert setting.experimenter.attractor_out_of_reach()
    assert out == {near: True, both: False}


def test_the_box_must_reach_all_sides_of_the_tool_in_any_grasp() -> None:
    assert beyond_the_box(several((LOW, HIGH))) == ""
    assert "offset_y_min" not in beyond_the_box(several((LOW, TURNED)))


@pytest.mark.parametrize(
    ("chosen", "error", "says"),
    [
        ([LOW, "grasp:grasp_point=16"], BadInputError, "16 lies beyond the end of the handle"),
        ([LOW, "grasp:grasp_point=1"], UsageError, "grasp 1 comes twice; leave one out"),
        (
            ["grasp:angle=180", "grasp:angle=-180"],
            UsageError,
            "grasp:angle=-180: grasp 1 -180 comes twice",
        ),
        ([LOW, "pinch"], UsageError, "no binding 'pinch'"),
        (
            [f"grasp:grasp_point={n / 2}" for n in range(21)],
            UsageError,
            "21 of them; give at most 20",
        ),
    ],
)
def test_grasps_that_cannot_be_are_refused_in_a_line(
    chosen: list[str], error: type[AffcliError], says: str
) -> None:
    with pytest.raises(error, match=says) as caught:
        RunParts.chosen(Settings(), binding=chosen)
    assert "\n" not in str(caught.value)


def test_a_robot_that_invents_takes_one_grasp() -> None:
    with pytest.raises(BadInputError, match="inventing: invents with one grasp") as caught:
        LearningRun(several(explorer="inventing"))
    assert "\n" not in str(caught.value)


def test_a_tool_is_not_grasped_where_there_is_nothing_of_it() -> None:
    parts = RunParts.chosen(Settings(), binding=[LOW, "grasp:grasp_point=12"])
    parts.spec("t-hook", 0, 0, 1.0)
    whole = tool_named("t-hook")
    short = replace(whole, name=ToolName("half"), parts=whole.parts[1:])
    with pytest.raises(BadInputError, match="tool half: nothing to grasp at x = 0") as caught:
        parts.spec(short, 0, 0, 1.0)
    assert "\n" not in str(caught.value)


def test_it_lends_what_it_did_with_the_grasp_that_its_camera_saw() -> None:
    spec = several()
    rows = [r.affordance for r in records() if r.affordance is not None]
    world = TableWorld(IMPATIENT)
    lent = lender_of(spec, rows, world.mask(spec)).rows
    assert [row.step for row in lent] == [r.step for r in rows if r.binding == spec.binding]
    assert 0 < len(lent) < len(rows)


def test_a_figure_shows_of_several_grasps_those_rows_that_can_be_lent(store: Store) -> None:
    run = stored(store, several())
    lent = lendable(run.spec, (one.row for one in store.learning.rows(run.id)))
    borrower = replace(run.spec, seed=9, transfer=Transfer((run.spec.key,), Borrowing()))
    one = replace(lent[0], step=0)
    whence = Borrowed(one, run.spec.key, "t-hook", lent[0].step, Point(0.0, 0.0), mirrored=False)
    info = store.learning.begin(borrower, {}, now(), borrowing=[whence])
    _, (lender, _) = lending(store, info)
    assert [row for row, _ in lender.rows] == lent
    assert lender.heading.endswith(f"1 of {len(lent)} rows lent")
    assert len(lent) < run.rows


def test_rows_that_are_taken_out_have_the_region_of_their_own_grasp(store: Store) -> None:
    run = stored(store, several())
    regions, _ = taken_out(
        *(store, "rows", [run], RowFilter(), None),
        lambda columns, rows: [
            {c.name: value for c, value in zip(columns, row, strict=True)}["region"] for row in rows
        ],
    )
    assert regions == [region for _, region in listed_rows(store, [run], RowFilter(), None)]
