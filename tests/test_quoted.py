"""The numbers that results were published with; a change of one is a change of all results.

A default that changes is entered in `affcli.config.CHANGED`, and here; stored runs keep the former
one.
"""

from itertools import product

import pytest

from affcli import registry
from affcli.config import DEFAULTS, Settings, known_settings
from affcli.core import affordance, affordance_table, change_detection, verification
from affcli.core.geometry import Point
from affcli.core.mask import SCALE
from affcli.core.setting import LARGEST, SMALLEST, settings_of
from affcli.core.transfer import Borrowing
from affcli.planning import nested_query, prediction
from affcli.simulation.table_world import TableWorld
from affcli.simulation.worlds import TABLE_VERSION

MOVING = ("extend-arm", "contract-arm", "slide-arm-left", "slide-arm-right", "slide-arm")
TURNING = ("turn-wrist", "turn-and-pull", "turn-and-slide")
SETTINGS = {
    "arm.elbow_max_degrees": 146.0,
    "arm.flange_height": 1.05,
    "arm.forearm": 10.0,
    "arm.lift_height": 1.6,
    "arm.shoulder_height": 10.0,
    "arm.upper_arm": 10.0,
    "arm.wrist_to_flange": 2.0,
    "babbling.draws": 256,
    "babbling.offset_x_max": 7.5,
    "babbling.offset_y_max": 19.2,
    "babbling.offset_y_min": 6.8,
    "friction.puck_table": 0.35,
    "friction.tool_puck": 0.225,
    "layout.goal_1_y": 15.3,
    "layout.goal_2_y": 26.8,
    "layout.goal_half_width": 2.25,
    "layout.goal_side_x": 12.4,
    "layout.midline": 22.4,
    "layout.start_spacing": 6.0,
    "motion.grasp_time": 5.0,
    "motion.hold": 0.25,
    "motion.push_speed": 5.0,
    "motion.regrasp_time": 8.0,
    "motion.transfer_speed": 12.5,
    "puck.mass": 0.165,
    "puck.radius": 1.5,
    "sensor.color_noise": 2.4,
    "sensor.position_noise": 0.008,
    "table.far": 31.6,
    "table.half_width": 16.0,
    "table.near": 11.8,
    "tools.bar_reach": 5.6,
    "tools.handle_below_grasp": 1.0,
    "tools.handle_length": 14.6,
    "tools.hook_length": 5.3,
    "tools.part_width": 0.75,
    "trial.max_steps": 60,
}


@pytest.mark.parametrize(("name", "value"), SETTINGS.items())
def test_a_setting_has_the_default_that_results_were_published_with(
    name: str, value: float
) -> None:
    assert DEFAULTS == 1
    assert Settings().values()[name] == value


def test_the_rules_of_the_paper_have_its_numbers() -> None:
    """§5.2: 0.5 in and 40 degrees; §6.2: greater than 1/2, the top 20 %."""
    assert change_detection.MOVEMENT_THRESHOLD == 0.5
    assert affordance.REPLICATION_ANGLE_DEGREES == 40.0
    assert affordance.PROBABILITY_THRESHOLD == 0.5
    assert nested_query.TOP_SHARE == 0.2
    planner = registry.planner(registry.component("planners", registry.DEFAULTS["planner"]))
    assert (planner.angle_degrees, planner.threshold) == (40.0, 0.5)
    assert planner == nested_query.NestedQuery()


def test_the_choices_where_the_paper_is_silent_have_theirs() -> None:
    assert affordance_table.COLOR_TOLERANCE == 45.0
    assert prediction.RADIUS == 1.5
    assert (verification.INTACT, verification.CHANGED, verification.ERROR) == (0.02, 0.10, 0.01)
    assert TABLE_VERSION == 2


def test_rows_are_borrowed_with_the_numbers_that_results_were_published_with() -> None:
    usual = Borrowing()
    assert (usual.way, usual.radius, usual.limit) == ("local", 2.1, 0.3)
    assert (usual.each, usual.most, usual.shifts, usual.grown) == (60, 150, 2, 0.0)
    assert SCALE == 0.1


def test_goals_and_starts_lie_where_results_were_published_with() -> None:
    tasks = TableWorld(Settings()).tasks("extension-of-reach")
    goals = {"1": (0.0, 15.3), "2": (0.0, 26.8), "3": (-12.4, 22.4), "4": (12.4, 22.4)}
    starts = {"1": -9.0, "2": -3.0, "3": 3.0, "4": 9.0}
    assert [(task.goal.name, task.start_name) for task in tasks] == list(product(goals, starts))
    for task in tasks:
        assert task.goal.center == goals[task.goal.name]
        assert task.goal.half_width == 2.25
        assert task.start == Point(starts[task.start_name], 22.4)


LIMITS = {
    "arm.elbow_max_degrees": (SMALLEST, 180.0),
    "arm.flange_height": (0.0, LARGEST),
    "arm.shoulder_min_degrees": (-LARGEST, LARGEST),
    "arm.waist_max_degrees": (SMALLEST, 90.0),
    "camera.blur_px": (0.0, 20.0),
    "camera.distortion_per_mm2": (-0.05, 0.05),
    "camera.focal_length_mm": (SMALLEST, 100.0),
    "camera.grey_noise": (0.0, 255.0),
    "camera.height": (SMALLEST, 1000.0),
    "camera.tilt_degrees": (0.0, 89.0),
    "camera.turn_degrees": (0.0, 360.0),
    "camera.uneven_light": (0.0, 0.9),
    "camera.x": (-LARGEST, LARGEST),
    "camera.y": (-LARGEST, LARGEST),
    "friction.tool_puck": (0.0, LARGEST),
    "motion.grasp_time": (0.0, LARGEST),
    "motion.hold": (0.0, LARGEST),
    "motion.regrasp_time": (0.0, LARGEST),
    "physics.collision_slop": (1e-9, LARGEST),
    "physics.overlap_mended": (1e-6, 1.0),
    "puck.mass_direction_degrees": (-360.0, 360.0),
    "puck.mass_offset": (0.0, 1.0 / 3.0),
    "sensor.color_noise": (0.0, 255.0),
    "sensor.position_noise": (0.0, 10.0),
    "tools.handle_below_grasp": (0.0, LARGEST),
    "bindings: grasp: angle": (-180.0, 180.0),
    "bindings: grasp: grasp_point": (0.0, 100.0),
    **{f"behaviors: {name}: offset_distance": (0.1, 20.0) for name in MOVING},
    **{f"behaviors: {name}: angle": (-180.0, 180.0) for name in TURNING},
    **{f"behaviors: {name}: distance": (0.1, 20.0) for name in TURNING},
    **{f"behaviors: {name}: direction": (-360.0, 360.0) for name in ("slide-arm", TURNING[-1])},
    **{
        f"explorers: {name}: {param}": limits
        for name in ("goal-babbling", "information-gain", "occupancy", "thompson")
        for param, limits in {
            "contact": (0.001, 0.5),
            "cell": (0.1, 5.0),
            "near": (0.1, 10.0),
            "places": (0.0, 100.0),
            "place": (1.0, 20.0),
        }.items()
    },
    "explorers: inventing: babbling": (0.1, 600.0),
    "explorers: inventing: composing": (0.1, 600.0),
    "explorers: inventing: turn": (5.0, 180.0),
    "explorers: inventing: slide": (1.0, 20.0),
    "explorers: inventing: schemas": (1, 5),
    "explorers: inventing: most": (1, 20),
    "planners: lookahead: regrasp": (0.0, 1000.0),
    "planners: nested-query: guard": (0.0, 30.0),
    "planners: nested-query: regrasp": (0.0, 1000.0),
    "planners: nested-query: share": (0.001, 1.0),
    "planners: lookahead: smoothing": (0.0, 5.0),
    "planners: robust: radius": (0.05, 5.0),
    "planners: value-iteration: cell": (0.5, 10.0),
    **{
        f"planners: {name}: {param}": limits
        for param, limits in {
            "angle_degrees": (1.0, 180.0),
            "threshold": (0.0, 0.999),
            "depth": (1, 8),
            "beam": (1, 400),
            "counters": (0, 1),
            "spacing": (0.25, 2.0),
            "friction": (0.0, 10.0),
            "even": (0, 1),
        }.items()
        for name in registry.parts("planners")
    },
    "puck.mass_direction": (-360.0, 360.0),
    "transfer: radius": (SMALLEST, 20.0),
    "transfer: limit": (0.0, 100.0),
    "transfer: each": (1, 10_000),
    "transfer: most": (1, 10_000),
    "transfer: shifts": (0, 100),
    "transfer: grown": (0.0, 5.0),
    "tasks: anywhere: half_width": (0.1, 10.0),
    "tasks: anywhere: n": (1, 1000),
    "tasks: anywhere: seed": (0, 2**63 - 1),
}
"""Of what may be less, or not as much, as any length, speed, time or count."""


UNITS = {
    *("", "in", "in^2", "in/s", "in/s^2", "mm", "1/mm^2", "px", "of 255"),
    *("degrees", "degrees/s", "degrees/s^2", "kg", "min", "s"),
}
"""Of all values: a count has none."""


def test_a_value_says_what_it_is_and_may_be_what_it_could_be_before_and_no_more() -> None:
    """A limit that moves refuses old files, or lets through what the engine cannot bear."""
    parts = [part for kind in registry.KINDS for part in registry.parts(kind).values()]
    params = {f"{p.kind}: {p.name}: {name}": one for p in parts for name, one in p.params.items()}
    params |= {f"transfer: {name}": one for name, one in settings_of(Borrowing).items()}
    for name, one in (known_settings() | params).items():
        assert one.meaning.endswith("."), name
        assert one.unit in UNITS, name
        if not one.choices:
            least = 1 if isinstance(one.default, int) else SMALLEST
            assert (one.low, one.high) == LIMITS.get(name, (least, LARGEST)), name
