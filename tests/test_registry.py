"""Everything registered, taken together: it says what it is, and it does what it says."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from affcli import registry
from affcli.behaviors.positioning import position_wrist
from affcli.config import Settings, settings_with
from affcli.core.behavior import Execution, ExecutionStatus
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point
from affcli.core.identity import Component
from affcli.core.part import Part
from affcli.core.setting import Setting
from affcli.core.specs import LearningSpec
from affcli.core.tool import Tool
from affcli.core.trial import Truth
from affcli.core.world import World
from affcli.errors import BadInputError, UsageError
from affcli.lab.run_parts import RunParts
from tests.factories import UNITS

SETTINGS = settings_with({"sensor": {"kind": "exact"}}, "a test")
PARTS = [part for kind in registry.KINDS for part in registry.parts(kind).values()]
PARAMS = [(part, name) for part in PARTS for name in part.params]
every_part = pytest.mark.parametrize("part", PARTS, ids=lambda part: f"{part.kind} {part.name}")
every_param = pytest.mark.parametrize(
    ("part", "name"), PARAMS, ids=[f"{part.name} {name}" for part, name in PARAMS]
)
BINDINGS = ("grasp", "grasp:grasp_point=4", "grasp:angle=90", "grasp:grasp_point=0,angle=-180")


def limits(param: Setting) -> tuple[float, float]:
    """Return the least and the largest value of a parameter."""
    return param.low, param.high


@every_part
def test_a_part_says_what_it_is_and_where_it_comes_from(part: Part) -> None:
    assert Component.parse(part.name) == Component(part.name)
    assert registry.part(part.kind, part.name) is part
    for text in (part.summary, part.source):
        assert text.strip() == text != ""
        assert text.isprintable()
    assert part.source == "affcli" or part.source.startswith("Stoytchev 2008, §")
    assert part.version >= 1


def test_names_are_those_of_one_part_each() -> None:
    for kind in registry.KINDS:
        found = [part.name for part in PARTS if part.kind == kind]
        assert found
        assert len(set(found)) == len(found)


def test_two_parts_of_one_name_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    stick = registry.part("tools", "stick")
    twins = SimpleNamespace(PARTS=(stick, replace(stick, summary="another")))
    monkeypatch.setattr(registry, "_modules", lambda home: [twins])
    with pytest.raises(BadInputError, match="two tools are named stick; rename one"):
        registry.parts.__wrapped__("tools")


def test_the_paper_s_parts_are_the_defaults_and_in_the_order_of_the_paper() -> None:
    tools = registry.parts("tools")
    assert list(tools)[:5] == ["stick", "l-stick", "l-hook", "t-stick", "t-hook"]
    others = list(tools.values())[5:]
    assert others
    assert all(part.summary.startswith("not the paper's: ") for part in others)
    for singular, name in registry.DEFAULTS.items():
        kind = {"repertoire": "behaviors"}.get(singular, f"{singular}s")
        assert name in registry.parts(next(k for k in registry.KINDS if k == kind))


@every_param
def test_a_parameter_has_a_unit_a_meaning_and_limits_that_hold_its_default(
    part: Part, name: str
) -> None:
    param = part.params[name]
    assert param.meaning.endswith(".")
    assert param.unit in UNITS
    assert all(map(math.isfinite, limits(param)))
    assert param.low < param.high
    for value in (param.default, *limits(param)):
        assert not param.refusal(param.canonical(value))


@every_param
def test_a_component_is_the_same_after_its_text_and_leaves_defaults_out(
    part: Part, name: str
) -> None:
    param = part.params[name]
    for value in limits(param):
        made = registry.component(part.kind, f"{part.name}:{name}={value!r}")
        assert dict(made.params) == ({} if value == param.default else {name: value})
        assert registry.component(part.kind, str(made)) == made
        assert part.values(made)[name] == value
    spelled = registry.component(part.kind, f"{part.name}:{name}={param.default!r}")
    assert spelled == Component(part.name, version=part.version)


@every_param
def test_a_value_out_of_its_limits_is_refused_in_one_line(part: Part, name: str) -> None:
    param = part.params[name]
    for value in (param.low - 1.0, param.high * 2.0 + 1.0, "nan", "wide"):
        with pytest.raises(BadInputError) as told:
            registry.component(part.kind, f"{part.name}:{name}={value}")
        message = str(told.value)
        assert told.value.exit_code == 4
        assert "\n" not in message
        assert part.name in message
        assert name in message
        assert f"[{param.low:g}, {param.high:g}]" in message
        assert param.unit in message


@every_part
def test_an_unknown_parameter_is_refused_in_one_line(part: Part) -> None:
    with pytest.raises(BadInputError) as told:
        registry.component(part.kind, f"{part.name}:colour_of_hair=3")
    message = str(told.value)
    assert told.value.exit_code == 4
    assert "\n" not in message
    assert "colour_of_hair" in message
    assert all(name in message for name in part.params)


@every_part
def test_an_unknown_name_is_refused_with_the_nearest_names(part: Part) -> None:
    with pytest.raises(UsageError) as told:
        registry.component(part.kind, f"{part.name}x")
    assert told.value.exit_code == 2
    assert "\n" not in str(told.value)
    assert part.name in str(told.value).split("did you mean")[1]


@every_part
def test_another_version_of_a_part_is_refused(part: Part) -> None:
    with pytest.raises(BadInputError, match="version"):
        registry.component(part.kind, f"{part.name}@{part.version + 1}")


@pytest.mark.parametrize("text", ["", "Grasp", "gr asp"])
def test_what_is_no_name_is_told_the_names_that_there_are(text: str) -> None:
    with pytest.raises(UsageError, match="did you mean grasp"):
        registry.component("bindings", text)


@pytest.mark.parametrize("text", ["grasp:", "grasp:angle", "grasp:angle=", "gr asp:angle=1"])
def test_what_is_no_part_as_text_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(BadInputError, match="name:key=value") as told:
        registry.component("bindings", text)
    assert "\n" not in str(told.value)


def test_a_whole_number_can_be_given_as_text() -> None:
    depth = Setting(2, "", "How many steps ahead.", 1, 9)
    part = Part("planners", "ahead", "looks ahead", "a test", object, {"depth": depth})
    given = Component.parse("ahead:depth=3")
    assert part.component(dict(given.params)).params == (("depth", 3),)
    with pytest.raises(BadInputError, match="whole number"):
        part.component({"depth": 2.5})


def test_a_grasp_beyond_the_end_of_the_handle_is_refused() -> None:
    tools = SETTINGS.workspace.tools
    end = tools.handle_below_grasp + tools.handle_length
    assert registry.binding(f"grasp:grasp_point={end}", tools)["grasp_point"] == end
    with pytest.raises(BadInputError, match=r"^grasp: grasp_point = 15.7 .* 15.6 in") as told:
        registry.binding("grasp:grasp_point=15.7", tools)
    assert "\n" not in str(told.value)


def test_a_behavior_that_comes_twice_is_refused() -> None:
    with pytest.raises(UsageError, match="extend arm 5 comes twice"):
        registry.repertoire(["paper", "extend-arm"])


# --- Specs: what a run is a function of -----------------------------------------------------------

SPELLED: dict[str, Any] = {
    "binding": "grasp:grasp_point=1,angle=0",
    "explorer": "random",
    "world": "table",
    "repertoire": ["paper"],
}


def run_key(settings: Settings | None = None, **parts: Any) -> str:
    """Return the key of an hour with the T-hook and these parts."""
    chosen = RunParts.chosen(settings or Settings(), **parts)
    return chosen.spec("t-hook", 0, 0, 1.0).key


def test_what_is_spelled_out_and_is_the_default_changes_no_key() -> None:
    assert run_key(**SPELLED) == run_key()
    assert run_key(settings_with({"friction": {"tool_puck": 0.225}}, "a test")) == run_key()
    one_by_one = [
        f"{name}:offset_distance={distance}"
        for name, distance in product(
            ("extend-arm", "contract-arm", "slide-arm-left", "slide-arm-right"), (2, 5)
        )
    ]
    assert run_key(repertoire=one_by_one) == run_key()


def test_the_key_of_the_papers_run_stays_the_same_in_every_version() -> None:
    """Stored runs are found by it: an hour with the T-hook, seed 0. Of another physics it is
    another run, and that of the first is still named by its own key.
    """
    assert run_key() == "f535e4103357ecb21cff3c481bc4465248810c6665a90edc31416fe6dc96edb4"
    first = replace(RunParts.chosen(Settings()), world=Component("table"))
    key = first.spec("t-hook", 0, 0, 1.0).key
    assert key == "b2e8e2dd403d5549caaab6f6905afa667b4e629fcbca43ef375452cdf2999cb0"


@pytest.mark.parametrize(
    "other",
    [
        {"binding": "grasp:grasp_point=3"},
        {"binding": "grasp:angle=5"},
        {"repertoire": ["extend-arm"]},
        {"repertoire": ["paper", "extend-arm:offset_distance=7"]},
        {"settings": settings_with({"puck": {"radius": 1.4}}, "a test")},
        {"settings": SETTINGS},
    ],
)
def test_what_differs_changes_the_key(other: dict[str, Any]) -> None:
    assert run_key(**other) != run_key()


def test_a_tool_is_known_by_its_value_and_not_by_its_name() -> None:
    spec = RunParts.chosen(Settings()).spec("t-hook", 0, 0, 1.0)
    bent = replace(spec.held, parts=spec.held.parts[:-1])
    assert replace(spec, held=bent).key != spec.key


# --- Everything with everything -------------------------------------------------------------------


def specs(tool: str, binding: str) -> LearningSpec:
    """Return a run with every behavior there is: its parameters at their limits, and in between."""
    texts = list(registry.DEFAULTS["repertoire"].split())
    for part in registry.parts("behaviors").values():
        for ends in zip(*map(limits, part.params.values()), strict=True):
            given = zip(part.params, ends, strict=True)
            texts.append(f"{part.name}:{','.join(f'{name}={value}' for name, value in given)}")
        if part.params:
            texts.append(f"{part.name}:{','.join(f'{name}=3' for name in part.params)}")
    return RunParts.chosen(SETTINGS, repertoire=texts, binding=binding).spec(tool, 3, 0, None, 1)


def beside(tool: Tool, angle: float, rng: np.random.Generator) -> list[Point]:
    """Return where the attractor stands to the wrist when it lies right beside a tool (in)."""
    outlines = [outline.turned(angle) for outline in tool.outlines]
    found: list[Point] = []
    while len(found) < 100:
        edges = outlines[rng.integers(len(outlines))].edges
        (ax, ay), (bx, by) = edges[rng.integers(len(edges))]
        share, around = rng.random(), rng.uniform(-math.pi, math.pi)
        gap = SETTINGS.workspace.puck.radius + 0.2
        at = Point(
            ax + share * (bx - ax) + gap * math.cos(around),
            ay + share * (by - ay) + gap * math.sin(around),
        )
        if min(outline.distance(at) for outline in outlines) > gap - 0.1:
            found.append(at)
    return found


def done(
    world: World, spec: LearningSpec, angle: float, *, filmed: bool = False
) -> Sequence[tuple[Execution, Truth | None]]:
    """Execute each behavior of a run's repertoire, the tool beside the attractor."""
    setting, rng = world.learning(spec), np.random.default_rng(11)
    shown: list[float] = []
    if filmed:
        assert setting.film(lambda clock, scene: shown.append(clock))
    setting.robot.execute(setting.binding, None)
    scene = setting.scene()
    assert scene is not None
    offsets = beside(scene.tool, angle, rng)
    made = []
    for call in setting.exploratory:
        setting.experimenter.put_attractor_back()
        seen = setting.sensor.observe()
        for offset in rng.permutation(offsets).tolist():
            placing = setting.robot.execute(position_wrist(Point(*offset), angle), seen)
            if placing.status is ExecutionStatus.DONE:
                break
        made.append((setting.robot.execute(call, setting.sensor.observe()), setting.truth()))
    assert bool(shown) is filmed
    return made


@pytest.mark.parametrize("binding", BINDINGS)
@pytest.mark.parametrize("tool", registry.parts("tools"))
def test_each_behavior_with_each_tool_ends_in_a_status_and_gives_the_same_again(
    tool: str, binding: str
) -> None:
    """To the bit: in a world of its own, in one used before, and filmed.

    Each tool and each way to hold it with the wrist straight and turned.
    """
    angle = 0.6 * ((list(registry.parts("tools")).index(tool) + BINDINGS.index(binding)) % 2)
    spec = specs(tool, binding)
    world, other = (registry.world(spec.world, SETTINGS) for _ in range(2))
    first = done(world, spec, angle)
    assert [one.call for one, _ in first] == [behavior.call for behavior in spec.repertoire]
    assert {one.status for one, _ in first} <= {ExecutionStatus.DONE, ExecutionStatus.TRUNCATED}
    assert done(world, spec, angle) == first
    assert done(other, spec, angle, filmed=True) == first
    moved = [math.dist(t.start.point, t.end.point) for _, t in first if t is not None]
    assert max(moved) > MOVEMENT_THRESHOLD, "no behavior touched the attractor: no test"
