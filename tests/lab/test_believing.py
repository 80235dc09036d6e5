"""Baselines: what they are told, what they never see, and their trials beside those of robots."""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from affcli import registry
from affcli.baselines.beliefs.pushes import pushes
from affcli.config import Settings, load_settings
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point, near_any
from affcli.core.specs import Protocol, RobotRecord
from affcli.errors import BadInputError, UsageError
from affcli.lab.believing import belief_of, require_believable, require_own, told_spec
from affcli.lab.conducting import begin, run
from affcli.lab.definition import experiment_file
from affcli.lab.experiment import one_robot
from affcli.lab.run_parts import RunParts
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.wrist_motion import trapezoid
from affcli.store import Store
from tests.factories import learning_spec, tool_named
from tests.lab.quick import counted, now

COARSE = "spacing=2"
LEARNED = learning_spec("t-hook")


FILE = f"""
[experiment]
name = "small"
robots = 1
seed = 5
[base]
tools = ["t-hook"]
tasks = ["adaptation"]
minutes = 2
[[condition]]
name = "robot"
planner = "one-step"
[[condition]]
name = "static"
planner = "push-planner:counters=0,{COARSE}"
[[condition]]
name = "oracle"
planner = "oracle:{COARSE}"
"""


@pytest.fixture(scope="module")
def life(tmp_path_factory: pytest.TempPathFactory) -> RobotRecord:
    path = tmp_path_factory.mktemp("small") / "small.toml"
    path.write_text(FILE)
    return one_robot(experiment_file(path), 0)


def test_each_push_that_is_told_is_what_the_physics_gives() -> None:
    spec = told_spec(LEARNED, registry.component("planners", f"oracle:{COARSE}"))
    belief = belief_of(spec)
    outlines, place = spec.held.outlines, belief.workspace
    simulator = PushSimulator(outlines, place.puck, place.friction, belief.physics)
    steps = pushes(belief)
    assert len(steps) == spec.behaviors
    for record, truth in steps[::7]:
        row = record.affordance
        assert row is not None
        assert truth is not None
        length = float(np.hypot(*row.travel))
        direction = Point(row.travel.x / length, row.travel.y / length)
        motion = trapezoid(length, place.motion.push_speed, place.motion.push_acceleration)
        after = simulator.push(truth.start, Point(0.0, 0.0), direction, motion)
        assert after == truth.end
        assert row.expected_movement.distance > MOVEMENT_THRESHOLD
        assert not near_any(outlines, row.start.wrist_to_object, place.puck.radius)


def test_the_oracle_knows_the_tool_that_is_left_and_the_push_planner_believes_the_old_one() -> None:
    left = tool_named("l-hook")
    oracle, planner = (
        told_spec(LEARNED, registry.component("planners", f"{name}:{COARSE}"), left)
        for name in ("oracle", "push-planner")
    )
    assert oracle.held.outlines == left.outlines
    assert (oracle.tool, oracle.held.color) == (LEARNED.tool, LEARNED.held.color)
    assert planner.held == LEARNED.held
    assert planner == told_spec(LEARNED, registry.component("planners", f"push-planner:{COARSE}"))


def test_what_is_believed_of_friction_changes_the_pushes() -> None:
    plain, rough = (
        pushes(belief_of(told_spec(LEARNED, registry.component("planners", text))))
        for text in (f"push-planner:{COARSE}", f"push-planner:{COARSE},friction=0.9")
    )
    assert plain != rough


def test_a_lopsided_puck_is_believed_even_by_who_is_told_so() -> None:
    lopsided = learning_spec(settings=load_settings(None, ["puck.mass_offset=0.3"]))
    told = {
        (even, offset): told_spec(
            spec, registry.component("planners", f"push-planner:{COARSE},even={even}")
        )
        for even in (0, 1)
        for offset, spec in ((0.0, LEARNED), (0.3, lopsided))
    }
    found = {which: pushes(belief_of(spec)) for which, spec in told.items()}
    assert found[1, 0.3] == found[0, 0.0] == found[1, 0.0]
    assert found[0, 0.3] != found[0, 0.0]
    # Tables that were told before one could be told of an even puck keep their names.
    assert str(told[0, 0.0].explorer) == "told:friction=0,spacing=2"


def test_only_straight_slides_are_known() -> None:
    behavior = replace(LEARNED.repertoire[0], motion=())
    spec = replace(LEARNED, repertoire=(behavior,))
    with pytest.raises(BadInputError, match="is no straight slide"):
        told_spec(spec, registry.component("planners", f"oracle:{COARSE}"))


TURNING = RunParts.chosen(Settings(), repertoire=["paper", "turn-wrist:angle=30"])
LOPSIDED = RunParts.chosen(load_settings(None, ["puck.mass_offset=0.3"]))


@pytest.mark.parametrize("name", ["push-planner", "oracle"])
@pytest.mark.parametrize(
    ("parts", "why"),
    [
        (TURNING, "is told straight slides alone; leave out turn wrist 30"),
        (LOPSIDED, "how this one lies changes with every push; name push-planner:even=1"),
    ],
)
def test_what_cannot_be_computed_is_said_before_any_is(
    name: str, parts: RunParts, why: str
) -> None:
    with pytest.raises(BadInputError, match=why):
        require_believable(registry.component("planners", name), parts)


def test_what_can_be_computed_and_what_a_robot_learns_itself_is_let_pass() -> None:
    require_believable(registry.component("planners", "push-planner:even=1"), LOPSIDED)
    require_believable(registry.component("planners", "oracle"), RunParts.chosen(Settings()))
    for parts in (TURNING, LOPSIDED):
        require_believable(registry.component("planners", "one-step"), parts)


def test_what_the_oracle_has_no_use_for_is_not_computed(store: Store, tmp_path: Path) -> None:
    """Of a tool that broke it knows what is left; a whole one it does not need, and nobody else."""
    path = tmp_path / "small.toml"
    path.write_text(FILE.replace(f"push-planner:counters=0,{COARSE}", "nested-query"))
    what = experiment_file(path)
    info = begin(store, what, now)
    counted(run(store, what, info, 1, now))
    used = [store.learning.runs(session_id=number) for _, number in info.conditions]
    assert [[one.spec.explorer.name for one in own] for own in used] == [
        ["random"],
        ["random"],
        ["told"],
    ]
    assert len(store.trials.trials()) == 3 * 16


def test_an_experiment_is_told_so_before_it_begins(tmp_path: Path) -> None:
    path = tmp_path / "turning.toml"
    path.write_text(FILE.replace("minutes = 2", 'repertoire = ["paper", "turn-wrist:angle=30"]'))
    with pytest.raises(BadInputError, match=r"straight slides alone.*in condition static"):
        experiment_file(path)


@pytest.mark.parametrize("belief", ["friction=5", "even=1", "counters=0"])
def test_the_oracle_can_be_told_no_lies(belief: str) -> None:
    with pytest.raises(BadInputError, match="no parameter"):
        registry.component("planners", f"oracle:{belief}")


def test_a_robot_has_no_use_for_a_planner_that_is_told() -> None:
    for name, part in registry.parts("planners").items():
        planner = registry.component("planners", name)
        assert registry.is_told(planner) is part.told is ("no robot's own" in part.summary)
        if part.told:
            with pytest.raises(UsageError, match="no robot's own"):
                require_own(planner)


def test_baselines_do_the_trials_of_the_robot_from_tables_of_their_own(life: RobotRecord) -> None:
    assert [str(spec.explorer.name) for spec, _, _ in life.learned] == ["random", "told", "told"]
    assert [seconds for _, _, seconds in life.learned[1:]] == [0.0, 0.0]
    count = Counter((one.condition, one.run) for one in life.tested)
    assert count == {(0, 0): 16, (1, 1): 16, (2, 2): 16}
    for one in life.tested:
        spec = one.trial.spec
        assert (spec.protocol, spec.tool, spec.shape) == (
            Protocol.TOOL_ADAPTATION,
            "t-hook",
            "l-hook",
        )


def test_who_believes_in_the_whole_tool_repeats_itself_and_the_oracle_does_not(
    life: RobotRecord,
) -> None:
    """§8: the table is to "excel in situations that cannot be predicted by the planners"."""
    tries = Counter[tuple[int, int]]()
    for one in life.tested:
        rows = Counter(step.record.row.step for step in one.trial.steps)
        for number, uses in rows.items():
            tries[one.condition, number] = max(tries[one.condition, number], uses)
    most = {k: max(uses for (c, _), uses in tries.items() if c == k) for k in (0, 1, 2)}
    assert most[1] > 20 > most[2]


def test_an_experiment_with_a_baseline_is_read(tmp_path: Path) -> None:
    path = tmp_path / "small.toml"
    path.write_text(FILE)
    tables = ([spec for spec, _ in one.tables(0, 0)] for one in experiment_file(path).conditions)
    assert len({spec.key for specs in tables for spec in specs}) == 3
