"""What a stored run keeps of its settings: the same form in every version of affcli."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import make_dataclass, replace
from typing import Any

import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from affcli.config import (
    CHANGED,
    RENAMED,
    SECTIONS,
    Settings,
    known_settings,
    load_settings,
    require_known,
    settings_from,
    settings_with,
)
from affcli.config import DEFAULTS as DEFAULTS_NUMBER
from affcli.core.setting import Value, setting, settings_of
from affcli.core.workspace import MotionTiming
from affcli.errors import DatabaseError
from affcli.perception.noisy_sensor import SensorSettings
from affcli.procedures.extension_of_reach import TrialLimits
from tests.test_config import overrides

ADDED = {
    *("motion.regrasp_time", "motion.turn_speed", "motion.turn_acceleration"),
    *("puck.mass_offset", "puck.mass_direction_degrees", "puck.mass_turned"),
}
"""Settings that came after the first version."""


def compact(mapping: Mapping[str, Value]) -> str:
    return json.dumps(mapping, sort_keys=True, separators=(",", ":"))


@hypothesis_settings(deadline=None)
@given(overrides)
def test_what_differs_gives_the_settings_back(changes: dict[str, dict[str, Any]]) -> None:
    settings = settings_with(changes, "a test")
    assert settings_from(settings.differing()) == settings
    assert settings_from(json.loads(compact(settings.differing()))) == settings


@hypothesis_settings(deadline=None)
@given(overrides, st.data())
def test_what_differs_is_the_same_for_equal_settings_whatever_the_order(
    changes: dict[str, dict[str, Any]], data: st.DataObject
) -> None:
    differing = settings_with(changes, "a test").differing()
    shuffled = data.draw(st.permutations(list(differing.items())))
    assert compact(settings_from(dict(shuffled)).differing()) == compact(differing)
    assert list(differing) == sorted(differing)


def test_what_differs_is_no_more_and_no_less() -> None:
    """These texts are part of the keys of stored runs: none of them may ever change."""
    assert Settings().differing() == {}
    for text, stored in {
        "tools.bar_reach=7": '{"tools.bar_reach":7.0}',
        "tools.bar_reach=5.6": "{}",
        "trial.max_steps=5": '{"trial.max_steps":5}',
        "camera.y=-0.0": '{"camera.y":0.0}',
        "camera.x=-0.0": "{}",
        "physics.collision_slop=1e-9": '{"physics.collision_slop":1e-09}',
        "sensor.kind=camera": "{}",
    }.items():
        assert compact(load_settings(None, [text]).differing()) == stored
    whole = replace(Settings(), trial=TrialLimits(max_steps=5), sensor=SensorSettings("exact", 2))
    assert compact(whole.differing()) == '{"sensor.position_noise":2.0,"trial.max_steps":5}'


def test_the_defaults_number_1_are_those_of_the_first_version() -> None:
    """They are what every stored run stands on: a changed default must be put into CHANGED."""
    kept = {name: former[0] for name, former in CHANGED.items()}
    first = {n: kept.get(n, v) for n, v in Settings().values().items() if n not in ADDED}
    digest = hashlib.sha256(compact(dict(sorted(first.items()))).encode()).hexdigest()
    assert digest == "2bac97be946d6e91d983a39a000ef953be06a5f7ad8cceecab147893d138d768"


def test_a_new_setting_changes_no_stored_form() -> None:
    """Time to grasp the tool elsewhere came after the first version."""
    assert "motion.regrasp_time" not in Settings().differing()
    assert settings_from({}).workspace.motion.regrasp_time == 8.0
    slow = load_settings(None, ["motion.regrasp_time=9"])
    assert slow.differing() == {"motion.regrasp_time": 9.0}


def with_motion(monkeypatch: pytest.MonkeyPatch, *added: Any, left_out: str = "") -> None:
    """Let another version of affcli run, whose section of motion has other settings."""
    kept = [
        (name, float, setting(one.default, one.unit, one.meaning, low=one.low))
        for name, one in settings_of(MotionTiming).items()
        if name not in {left_out, *(name for name, *_ in added)}
    ]
    motion = make_dataclass("MotionTiming", [*kept, *added], frozen=True)
    monkeypatch.setitem(SECTIONS, "motion", motion)


@hypothesis_settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(overrides)
def test_a_setting_added_with_a_default_changes_no_stored_form(
    monkeypatch: pytest.MonkeyPatch, changes: dict[str, dict[str, Any]]
) -> None:
    differing = settings_with(changes, "a test").differing()
    with monkeypatch.context() as later:
        with_motion(later, ("pause", float, setting(0.5, "s", "Rest.")))
        settings = settings_from(differing)
        assert settings.workspace.motion.pause == 0.5  # type: ignore[attr-defined]
        assert settings.differing() == differing


@hypothesis_settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(overrides)
def test_a_changed_default_leaves_stored_runs_what_they_were(
    monkeypatch: pytest.MonkeyPatch, changes: dict[str, dict[str, Any]]
) -> None:
    own = settings_with(changes, "a test")
    with monkeypatch.context() as later:
        with_motion(later, ("grasp_time", float, setting(6.0, "s", "Grasping.", low=0.0)))
        later.setitem(CHANGED, "motion.grasp_time", (5.0,))
        settings = settings_from(own.differing())
        assert settings.workspace.motion.grasp_time == own.workspace.motion.grasp_time
        assert settings.differing() == own.differing()
        assert load_settings(None).differing() == {"motion.grasp_time": 6.0}
        assert load_settings(None, ["motion.grasp_time=5"]).differing() == {}


def test_a_removed_setting_is_shown_and_kept_but_not_run(monkeypatch: pytest.MonkeyPatch) -> None:
    differing = load_settings(None, ["motion.hold=1", "motion.lift_speed=3"]).differing()
    with_motion(monkeypatch, left_out="hold")
    settings = settings_from(differing)
    assert settings.unknown == (("motion.hold", 1.0),)
    assert settings.differing() == differing
    with pytest.raises(DatabaseError) as told:
        require_known(settings)
    assert "motion.hold = 1; install the affcli that wrote it" in str(told.value)
    require_known(load_settings(None))


@pytest.mark.parametrize(
    ("name", "value", "shown"),
    [
        ("wings.span", 3.0, "wings.span = 3"),
        ("motion.hold", "short", "motion.hold = short"),
        ("motion.hold", -1.0, "motion.hold = -1"),
        ("wings.feathers", True, "wings.feathers = 1"),
        ("\x1b[31m", "\x1b", r"\x1b[31m = \x1b"),
    ],
)
def test_what_a_later_version_stored_is_kept(name: str, value: Value, shown: str) -> None:
    """Also a value that is none in this version."""
    settings = settings_from({name: value})
    assert settings.differing() == {name: value}
    with pytest.raises(DatabaseError) as told:
        require_known(settings)
    assert f"cannot run with {shown}; install" in str(told.value)


def test_a_renamed_setting_is_stored_under_its_first_name(monkeypatch: pytest.MonkeyPatch) -> None:
    differing = load_settings(None, ["motion.hold=1"]).differing()
    with_motion(monkeypatch, ("rest", float, setting(0.25, "s", "Rest.", low=0.0)), left_out="hold")
    monkeypatch.setitem(RENAMED, "motion.rest", "motion.hold")
    settings = settings_from(differing)
    assert settings.workspace.motion.rest == 1.0  # type: ignore[attr-defined]
    assert settings.differing() == differing == {"motion.hold": 1.0}
    assert not settings.unknown
    for name in ("rest", "hold"):
        assert load_settings(None, [f"motion.{name}=1"]) == settings


def test_tables_of_changes_name_settings_of_this_version() -> None:
    known = known_settings()
    assert {*CHANGED, *RENAMED} <= set(known)
    assert not set(RENAMED.values()) & set(known)
    assert max(map(len, CHANGED.values()), default=0) < DEFAULTS_NUMBER
