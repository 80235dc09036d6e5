"""The person of §6: lays out runs and trials, and puts the attractor back."""

import math
from functools import cache

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from affcli.config import Settings, settings_with
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point, Pose
from affcli.errors import BadInputError
from affcli.simulation import experimenter
from affcli.simulation.arm import reach_at
from affcli.simulation.table_world import TableSetting
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.simulation.wrist_motion import GRID
from tests.factories import goal_at, setting_with, tool_named

SETTINGS = Settings()
WORKSPACE = SETTINGS.workspace
TABLE, ARM, RADIUS = WORKSPACE.table, WORKSPACE.arm, WORKSPACE.puck.radius
REACH = reach_at(ARM, ARM.flange_height)
tools = st.sampled_from(sorted(TOOL_PARTS))
some_seeds = st.integers(0, 2**32)


def learning(tool: str, seed: int) -> TableSetting:
    """Return a setting laid out for learning."""
    setting = setting_with("stick", seed)
    setting.table.goal = goal_at(0.0, 15.0)
    setting.experimenter.lay_out_learning(tool_named(tool))
    return setting


def assert_attractor_can_be_played_with(setting: TableSetting) -> None:
    """Check that the attractor lies on the table, in the tool's reach, and clear of the tool."""
    table = setting.table
    at = table.attractor
    assert abs(at.x) <= TABLE.half_width
    assert TABLE.near <= at.y <= TABLE.far
    assert not setting.experimenter.attractor_out_of_reach()
    wrists = wrists_on_a_fine_grid()
    shape = shapely.union_all([shapely.Polygon(p.vertices) for p in table.tool.outlines])
    beside = shapely.Point(at.x - table.wrist.x, at.y - table.wrist.y)
    assert shape.distance(beside) >= RADIUS - 1e-9
    offsets = shapely.points(at.x - wrists[:, 0], at.y - wrists[:, 1])
    assert float(shapely.distance(shape, offsets).min()) < RADIUS


@cache
def wrists_on_a_fine_grid() -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Return wrist positions (n, 2) about a third of an inch apart, all over the reach."""
    radii = np.linspace(REACH.inner, REACH.outer, 45)
    bearings = np.linspace(-REACH.waist_max, REACH.waist_max, 180)
    r, b = (axis.ravel() for axis in np.meshgrid(radii, bearings))
    return np.stack([-r * np.sin(b), r * np.cos(b)], axis=1)


@settings(deadline=None, max_examples=30)
@given(tools, some_seeds)
def test_a_learning_run_begins_with_tool_and_attractor_at_random_places(
    tool: str, seed: int
) -> None:
    """§6: "The initial positions of the attractor and the tool were random." No goal yet."""
    setting = learning(tool, seed)
    table = setting.table
    assert table.tool.name == tool
    assert table.goal is None
    radius = math.hypot(*table.wrist.point)
    assert REACH.inner - GRID <= radius <= REACH.outer + GRID
    assert abs(math.atan2(-table.wrist.x, table.wrist.y)) <= REACH.waist_max + 1e-6
    assert all((c / GRID).is_integer() for c in table.wrist)
    assert_attractor_can_be_played_with(setting)


@settings(deadline=None, max_examples=30)
@given(tools, some_seeds)
def test_the_attractor_is_put_back_on_the_table_within_reach_and_off_the_tool(
    tool: str, seed: int
) -> None:
    """§6: "manually placed in a new random position", where the robot can go on learning."""
    setting = setting_with(tool, seed)
    setting.table.attractor = Pose(0.0, 2.0 * TABLE.far)
    wrist = setting.table.wrist
    assert setting.experimenter.attractor_out_of_reach()
    setting.experimenter.put_attractor_back()
    assert setting.table.wrist == wrist
    assert_attractor_can_be_played_with(setting)


def test_the_tools_first_places_are_spread_evenly_over_the_reach() -> None:
    """Uniform over the ring: the squares of the radii and the bearings are uniform."""
    n = 400
    wrists = [learning("stick", seed).table.wrist for seed in range(n)]
    spread = REACH.outer**2 - REACH.inner**2
    areas = sorted((w.x**2 + w.y**2 - REACH.inner**2) / spread for w in wrists)
    bearings = sorted((math.atan2(w.x, w.y) / REACH.waist_max + 1.0) / 2.0 for w in wrists)
    for shares in (areas, bearings):
        assert max(abs(s - (k + 0.5) / n) for k, s in enumerate(shares)) < 2.5 / math.sqrt(n)


def test_the_attractor_is_put_everywhere_within_reach_left_and_right_near_and_far() -> None:
    setting = setting_with("t-hook", 5)
    places = []
    for _ in range(300):
        setting.experimenter.put_attractor_back()
        places.append(setting.table.attractor)
    assert len(set(places)) == len(places)
    left = sum(place.x < 0.0 for place in places)
    assert 100 < left < 200
    span = max(p.y for p in places) - min(p.y for p in places)
    assert span > 0.5 * (TABLE.far - TABLE.near)


def test_the_same_seed_lays_out_the_same_and_another_seed_something_else() -> None:
    def laid_out(seed: int) -> tuple[Pose, Pose]:
        table = learning("t-hook", seed).table
        return table.wrist, table.attractor

    assert laid_out(3) == laid_out(3)
    assert len({laid_out(seed) for seed in range(30)}) == 30


def test_a_trial_begins_with_the_tool_at_the_tables_centre_and_the_attractor_at_its_start() -> None:
    """§7.1: "The tool was always placed in the center of the table"."""
    setting = learning("stick", 0)
    goal = goal_at(0.0, 15.0)
    setting.experimenter.lay_out_trial(tool_named("l-hook"), Point(-3.0, 25.0), goal)
    table = setting.table
    assert table.tool == tool_named("l-hook")
    assert table.wrist == table.home
    assert table.attractor == Pose(-3.0, 25.0, 0.0)
    assert table.goal == goal


@pytest.mark.parametrize("tool", sorted(TOOL_PARTS))
def test_an_attractor_pushed_over_the_edge_of_the_table_is_out_of_reach(tool: str) -> None:
    setting = setting_with(tool)
    for x, y in (
        (math.nextafter(TABLE.half_width, 99.0), 0.5 * (TABLE.near + TABLE.far)),
        (-TABLE.half_width - 0.1, 0.5 * (TABLE.near + TABLE.far)),
        (0.0, TABLE.near - 0.1),
        (0.0, TABLE.far + 0.1),
    ):
        setting.table.attractor = Pose(x, y)
        assert setting.experimenter.attractor_out_of_reach()


@settings(deadline=None)
@given(tools, st.floats(-1.0, 1.0), st.floats(0.0, 1.0))
def test_the_attractor_is_out_of_reach_where_no_wrist_position_lets_the_tool_move_it(
    tool: str, across: float, away: float
) -> None:
    """§6: "out of tool reach": no wrist position from which the tool touches it, and by more than
    T detects. The exact gap is that between the attractor less the tool, and the ring of wrists."""
    setting = setting_with(tool)
    x, y = across * TABLE.half_width, TABLE.near + away * (TABLE.far - TABLE.near)
    setting.table.attractor = Pose(x, y)
    shape = shapely.union_all([shapely.Polygon(p.vertices) for p in setting.table.tool.outlines])
    turned = shapely.affinity.rotate(shape, 180.0, origin=(0.0, 0.0))
    wrists = shapely.affinity.translate(turned, x, y)
    gap = wrists.distance(ring()) - (RADIUS - MOVEMENT_THRESHOLD)
    if abs(gap) > 0.05:
        assert setting.experimenter.attractor_out_of_reach() is (gap > 0.0)


def ring() -> shapely.Polygon:
    """Return the wrist positions with the tool on the table, to a hundredth of a thousandth."""
    bearings = np.linspace(-REACH.waist_max, REACH.waist_max, 1441)
    outer = np.stack([-np.sin(bearings), np.cos(bearings)], axis=1) * REACH.outer
    inner = outer[::-1] * (REACH.inner / REACH.outer)
    return shapely.Polygon(np.concatenate([outer, inner]))


def test_a_bigger_tool_reaches_what_a_smaller_one_of_its_parts_reaches() -> None:
    rng = np.random.default_rng(0)
    for x, y in rng.uniform(
        (-TABLE.half_width, TABLE.near), (TABLE.half_width, TABLE.far), (99, 2)
    ):
        lost = {}
        for tool in TOOL_PARTS:
            setting = setting_with(tool)
            setting.table.attractor = Pose(x, y)
            lost[str(tool)] = setting.experimenter.attractor_out_of_reach()
        chain = ("stick", "l-stick", "l-hook", "t-hook")
        assert [lost[t] for t in chain] == sorted((lost[t] for t in chain), reverse=True)


def test_a_table_on_which_nothing_is_in_reach_is_bad_input_that_names_the_table(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(experimenter, "PLACEMENTS", 20)
    nowhere_near = settings_with({"table": {"near": 500.0, "far": 600.0}}, "a file")
    setting = setting_with("stick", settings=nowhere_near)
    with pytest.raises(BadInputError, match=r"stick in 20 tries; bring table\.near") as told:
        setting.experimenter.put_attractor_back()
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("turned", ["fixed", "drawn"])
def test_the_heavy_side_of_the_puck_is_drawn_anew_where_it_is_to_be(turned: str) -> None:
    """For each trial, and each time that the puck is put back (§8)."""
    chosen = settings_with({"puck": {"mass_offset": 0.3, "mass_turned": turned}}, "a test")
    angles = set()
    for seed in range(5):
        setting = setting_with("stick", seed, settings=chosen)
        setting.experimenter.lay_out_trial(
            tool_named("stick"), Point(3.0, 22.4), goal_at(0.0, 15.0)
        )
        angles.add(setting.table.attractor.angle)
        setting.experimenter.put_attractor_back()
        angles.add(setting.table.attractor.angle)
    assert len(angles) == {"fixed": 1, "drawn": 10}[turned]
    assert all(abs(angle) <= math.pi for angle in angles)


@pytest.mark.parametrize(
    ("name", "value"), [("mass_offset", 0.34), ("mass_turned", "now and then"), ("mass", 0.0)]
)
def test_a_puck_that_cannot_be_is_refused(name: str, value: float | str) -> None:
    with pytest.raises(BadInputError, match=rf"puck.{name} = .* must"):
        settings_with({"puck": {name: value}}, "a test")
