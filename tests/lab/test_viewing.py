"""Pictures and films of stored steps show what happened in them."""

from dataclasses import replace

import numpy as np
import pytest

from affcli.config import Settings
from affcli.core.geometry import Pose
from affcli.core.identity import Component
from affcli.core.records import StepScene
from affcli.core.scene import Scene
from affcli.errors import UsageError
from affcli.lab.filming import FRAME_RATE
from affcli.lab.run_parts import settings_of
from affcli.lab.viewing import scenes_of_step, view_of_step, view_of_table
from affcli.store import Store
from tests.lab.parts import SILENT, register
from tests.lab.quick import counted, solving, spec_of, stored


@pytest.fixture
def steps(store: Store) -> list[StepScene]:
    """The steps of a trial with the T-hook."""
    counted(solving(store, stored(store, spec_of(behaviors=400)), "1", "1"))
    count = len(store.trials.steps(1))
    return [store.trials.scene(1, number) for number in range(1, count + 1)]


def test_a_film_of_a_step_runs_from_its_beginning_to_its_end(steps: list[StepScene]) -> None:
    """15 frames a robot second; the tool is carried lifted, and the puck moves as it did then."""
    assert steps
    for step in steps:
        film = scenes_of_step(step)
        first, last = film[0], film[-1]
        home = Pose(*settings_of(step.learned).workspace.wrist_start)
        assert first.wrist == pytest.approx(step.wrist_before or home, abs=1e-5)
        assert first.attractor.point == step.attractor_start
        if step.blocked:
            continue
        assert last.wrist == pytest.approx(step.wrist_end, abs=0.3)
        assert last.attractor.point == pytest.approx(step.attractor_end, abs=0.02)
        lifts = [scene.lift for scene in film]
        assert lifts[0] == 0.0
        assert max(lifts) == pytest.approx(1.6, abs=0.3)
        assert lifts[-1] == 0.0
        seconds = len(film) / FRAME_RATE
        assert 1.0 < seconds < 20.0
        assert largest_leap(film) <= 12.5 / FRAME_RATE + 0.1


def test_a_world_that_cannot_show_a_step_again_is_named(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    info = stored(store, spec_of("stick", behaviors=5))
    step = store.learning.scene(info.id, 1)
    register(monkeypatch, SILENT)
    silent = replace(step, learned=replace(step.learned, world=Component("silent")))
    with pytest.raises(UsageError, match="the world silent cannot show a step again"):
        scenes_of_step(silent)


def test_a_film_of_a_babbled_behavior(store: Store) -> None:
    """Any behavior can be seen again, those of learning too."""
    info = stored(store, spec_of("l-stick", behaviors=40))
    with pytest.raises(UsageError, match="no behavior 41 in run 1; it has 1 to 40"):
        store.learning.scene(info.id, 41)
    with pytest.raises(UsageError, match="no learning run 2; they are numbered 1 to 1"):
        store.learning.scene(2, 1)
    for step in (store.learning.scene(info.id, number) for number in range(1, 41)):
        film = scenes_of_step(step)
        assert film[-1].attractor.point == pytest.approx(step.attractor_end, abs=0.02)
        assert film[-1].goal is None
    last = store.learning.scene(info.id, 40)
    assert "Run 1, behavior 40 of 40, after" in view_of_step(last, after=True).title


def largest_leap(film: list[Scene]) -> float:
    """Return how far the wrist moves between two frames at the most (in)."""
    places = np.array([scene.wrist.point for scene in film])
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).max())


def test_before_and_after_a_step_the_puck_is_where_it_was(steps: list[StepScene]) -> None:
    step = steps[0]
    for after, truth in ((False, step.attractor_start), (True, step.attractor_end)):
        view = view_of_step(step, after=after)
        assert f"step 1 of {len(steps)}, {'after' if after else 'before'} {step.call}" in view.title
        (blob,) = view.seen.blobs[0]
        pixel = Settings().camera.camera().project(np.array([[*truth, 0.5]]))[0]
        assert (blob.x, blob.y) == pytest.approx(pixel, abs=2.0)


def test_a_view_is_the_same_every_time() -> None:
    first, second, other = (view_of_table(Settings(), seed) for seed in (0, 0, 1))
    assert first.png(frame_alone=True) == second.png(frame_alone=True)
    assert first.png(frame_alone=True) != other.png(frame_alone=True)
    assert first.png(frame_alone=False) != first.png(frame_alone=True)


@pytest.mark.usefixtures("steps")
def test_steps_and_trials_that_are_not_there(store: Store) -> None:
    with pytest.raises(UsageError, match="no trial 9; they are numbered 1 to 1"):
        store.trials.scene(9, 1)
    with pytest.raises(UsageError, match="no step 99 in trial 1; it has steps 1 to"):
        store.trials.scene(1, 99)
