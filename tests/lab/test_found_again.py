"""Runs are found again in every version: by the parts that they carry (identity over time)."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from affcli import config
from affcli.config import Settings, settings_with, with_sensor
from affcli.core.identity import Component
from affcli.core.records import ChangedPart
from affcli.core.setting import Setting, Value
from affcli.lab import learning
from affcli.lab.learning import learn, made_by_other_defaults
from affcli.lab.run_parts import RunParts, settings_of
from affcli.store import Store, open_store, upgrade
from tests.factories import learning_spec
from tests.lab.quick import now, spec_of, stored

WORLD = ChangedPart("world", "table", "table@2")
DATABASES = Path(__file__).parents[1] / "store" / "databases"


@pytest.mark.parametrize("revision", ["0001", "0002", "0003"])
def test_runs_of_every_past_revision_are_found_again(revision: str, tmp_path: Path) -> None:
    """In the world that they were made in the same command says that it is done; in today's that
    there is one of another; and one without its --config is another.
    """
    path = Path(shutil.copy(DATABASES / f"{revision}.db", tmp_path / "old.db"))
    path.chmod(0o644)
    upgrade(path)
    with open_store(path, create=False, write=True) as store:
        runs = store.learning.runs(status="done")
        assert runs
        for run in runs:
            spec, own = run.spec, settings_of(run.spec)
            limits = (spec.seed, spec.robot, spec.hours, spec.behaviors)
            today = RunParts.chosen(own).spec(spec.tool, *limits)
            (alike,) = made_by_other_defaults(store, today)
            assert (alike.run, alike.changed) == (run, (WORLD,))
            again = replace(today, world=spec.world)
            assert made_by_other_defaults(store, again) == ()
            assert learn(store, again, now) == learning.Learned(run, new=False)
            usual = RunParts.chosen(with_sensor(Settings(), spec.sensor)).spec(spec.tool, *limits)
            if usual == today:
                continue
            # What somebody wished for was never a default.
            assert made_by_other_defaults(store, usual) == ()


def test_the_runs_of_other_defaults_are_named_with_what_changed(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The tool's shape and the usual grasp follow from the sizes: they are no other command."""
    old = stored(store, spec_of("t-hook", 20))
    first = settings_with({}, "a test").values()
    usual = {**first, "tools.handle_length": 13.5, "tools.handle_below_grasp": 1.25}
    changed = {name: (first[name],) for name in usual if usual[name] != first[name]}
    monkeypatch.setattr(config, "CHANGED", changed)
    monkeypatch.setattr(config, "_defaults", lambda: dict(usual))
    monkeypatch.setattr(learning, "known_settings", lambda: _with_defaults(usual))
    now_usual = settings_with({}, "a test")
    spec = learning_spec("t-hook", behaviors=20, settings=now_usual)
    (alike,) = made_by_other_defaults(store, spec)
    assert alike.run == old
    assert {"tools.handle_length": (first["tools.handle_length"], 13.5)}.items() <= {
        one.name: (one.stored, one.wanted) for one in alike.changed
    }.items()
    assert {one.name for one in alike.changed} == {*changed, "tool", "binding"}


def _with_defaults(usual: dict[str, Value]) -> dict[str, Setting]:
    """Return the known settings with other defaults."""
    known = config.known_settings()
    return {name: replace(one, default=usual[name]) for name, one in known.items()}


def test_a_run_of_another_world_version_is_named_and_one_of_other_wishes_is_not(
    store: Store,
) -> None:
    spec = spec_of("stick", 20)
    older = replace(spec, world=Component("table", version=9))
    store.learning.begin(older, {}, now())
    (alike,) = made_by_other_defaults(store, spec)
    assert [(one.name, one.stored, one.wanted) for one in alike.changed] == [
        ("world", "table@9", "table@2")
    ]
    wished = spec_of("stick", 20, settings=settings_with({"babbling": {"draws": 9}}, "a test"))
    assert made_by_other_defaults(store, wished) == ()
    stored(store, spec)
    assert made_by_other_defaults(store, spec) == ()
