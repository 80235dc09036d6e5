"""Databases of every past revision, made by the affcli of their time: upgraded, and then used."""

import json
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from affcli.behaviors.moving import paper_repertoire
from affcli.config import load_settings
from affcli.core.choice import Reason
from affcli.core.identity import Component
from affcli.core.records import ChangedPart
from affcli.core.specs import LearningSpec
from affcli.core.trial import Outcome
from affcli.core.workspace import TaskLayout
from affcli.errors import BadInputError
from affcli.lab.learning import learn
from affcli.lab.replaying import replay_run, replay_trial
from affcli.lab.run_parts import RunParts
from affcli.simulation.tasks.extension_of_reach import extension_of_reach
from affcli.store import Store, check, open_store, run_sql, upgrade
from affcli.store.database_file import REVISION

DATABASES = Path(__file__).parent / "databases"
PAST = [f"{k:04}" for k in range(1, int(REVISION))]
KEPT = ("session", "learning_run", "behavior", "affordance", "trial", "step")
LEARNED: dict[str, tuple[tuple[str, tuple[str, ...], tuple[str, int, int]], ...]] = {
    "0001": (("t-hook", ("sensor.position_noise=0.06", "sensor.color_noise=2"), ("noisy", 5, 60)),),
    "0002": (
        ("t-hook", ("trial.max_steps=6",), ("noisy", 5, 60)),
        ("stick", (), ("camera", 5, 6)),
    ),
    "0003": (
        ("t-hook", ("trial.max_steps=5",), ("noisy", 5, 60)),
        ("l-hook", (), ("noisy", 2, 16)),
        ("stick", (), ("camera", 5, 3)),
        ("l-stick", (), ("noisy", 7, 24)),
    ),
    "0004": (
        ("t-hook", ("trial.max_steps=5",), ("noisy", 5, 60)),
        ("l-hook", (), ("noisy", 2, 16)),
        ("stick", (), ("camera", 5, 3)),
        ("l-stick", (), ("noisy", 7, 24)),
    ),
    "0005": (
        ("t-hook", ("trial.max_steps=5",), ("noisy", 5, 60)),
        ("l-hook", (), ("noisy", 2, 16)),
        ("stick", (), ("camera", 5, 3)),
        ("l-stick", (), ("noisy", 7, 24)),
    ),
    "0006": (
        ("t-hook", ("trial.max_steps=5",), ("noisy", 5, 60)),
        ("l-hook", (), ("noisy", 2, 16)),
        ("stick", (), ("camera", 5, 3)),
        ("l-stick", (), ("noisy", 7, 24)),
    ),
    "0007": (
        ("t-hook", ("trial.max_steps=5",), ("noisy", 5, 60)),
        ("l-hook", (), ("noisy", 2, 16)),
        ("stick", (), ("camera", 5, 3)),
        ("l-stick", (), ("noisy", 7, 24)),
    ),
    "0008": (
        ("t-hook", ("trial.max_steps=5",), ("noisy", 5, 60)),
        ("l-hook", (), ("noisy", 2, 16)),
        ("stick", (), ("camera", 5, 3)),
        ("l-stick", (), ("noisy", 7, 24)),
    ),
    "0009": (
        ("t-hook", ("trial.max_steps=5",), ("noisy", 5, 60)),
        ("l-hook", (), ("noisy", 2, 16)),
        ("stick", (), ("camera", 5, 3)),
        ("l-stick", (), ("noisy", 7, 24)),
    ),
}
"""The runs of each database: tool, settings, then sensor, seed and behaviors of the command."""
CASES = [(revision, *run) for revision, runs in LEARNED.items() for run in runs]


def old_database(revision: str, folder: Path) -> Path:
    """Return a database of a past revision, for this test alone."""
    path = Path(shutil.copy(DATABASES / f"{revision}.db", folder / "old.db"))
    path.chmod(0o644)
    return path


def rows(path: Path, text: str) -> list[tuple[Any, ...]]:
    """Run a query without affcli."""
    with closing(sqlite3.connect(path)) as driver:
        return driver.execute(text).fetchall()


@pytest.fixture(scope="module")
def upgraded(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The databases, brought to this revision."""
    paths = {r: old_database(r, tmp_path_factory.mktemp(r)) for r in PAST}
    for revision, path in paths.items():
        assert upgrade(path) == (revision, REVISION)
    return paths


@pytest.fixture(params=PAST)
def stored(request: pytest.FixtureRequest, upgraded: dict[str, Path]) -> Iterator[Store]:
    """Each of them, open for reading."""
    with open_store(upgraded[request.param], create=False, write=False) as store:
        yield store


def asked(tool: str, settings: tuple[str, ...], how: tuple[str, int, int]) -> LearningSpec:
    """Return what `affcli learn` made of a command while the world was in its first version."""
    sensor, seed, behaviors = how
    parts = RunParts.chosen(load_settings(None, [*settings, f"sensor.kind={sensor}"]))
    return replace(parts.spec(tool, seed, 0, None, behaviors), world=Component("table"))


@pytest.mark.parametrize("revision", PAST)
def test_nothing_is_lost(revision: str, upgraded: dict[str, Path]) -> None:
    """Every record is there, and the views read as before."""
    old, new = DATABASES / f"{revision}.db", upgraded[revision]
    for name in KEPT:
        count = f"SELECT count(*) FROM {name}"
        assert rows(new, count) == rows(old, count) > [(0,)]
    for view, columns in (("affordance_table", "*"), ("affordance_wide", _columns(old))):
        query = f"SELECT {columns} FROM {view} ORDER BY id"
        assert rows(new, query) == rows(old, query)
    assert [finding for finding in check(new) if finding.wrong] == []


def _columns(old: Path) -> str:
    """Return the columns of the view affordance_wide as it was."""
    return ", ".join(row[1] for row in rows(old, "PRAGMA table_info(affordance_wide)"))


@pytest.mark.parametrize(("revision", "tool", "settings", "how"), CASES)
def test_the_same_command_finds_the_run(
    revision: str,
    tool: str,
    settings: tuple[str, ...],
    how: tuple[str, int, int],
    upgraded: dict[str, Path],
) -> None:
    """What the migration spells out is what the code makes of the same command, but for the world's
    version.
    """
    spec = asked(tool, settings, how)
    with open_store(upgraded[revision], create=False, write=False) as store:
        found = store.learning.find(spec)
        assert found is not None
        assert found.spec == spec
        assert (found.spec.held.key, found.spec.key) == (spec.held.key, spec.key)
        assert found.spec.repertoire == paper_repertoire()


def test_a_default_that_changed_since_is_named(upgraded: dict[str, Path]) -> None:
    """The sensor was noisier when the first database was made."""
    spec = asked("t-hook", (), ("noisy", 5, 60))
    with open_store(upgraded["0001"], create=False, write=False) as store:
        assert store.learning.find(spec) is None
        (alike,) = store.learning.find_alike(spec)
        assert alike.run.id == 1
        assert alike.changed == (
            ChangedPart("sensor.color_noise", 2.0, None),
            ChangedPart("sensor.position_noise", 0.06, None),
        )
        assert store.learning.find_alike(alike.run.spec) == ()
        assert store.learning.find_alike(replace(spec, seed=6)) == ()


def test_a_later_version_of_the_world_is_named(upgraded: dict[str, Path]) -> None:
    spec = replace(asked("l-hook", (), ("noisy", 2, 16)), world=Component("table", version=2))
    assert spec == RunParts.chosen(load_settings(None, [])).spec("l-hook", 2, 0, None, 16)
    with open_store(upgraded["0003"], create=False, write=False) as store:
        (alike,) = store.learning.find_alike(spec)
        assert alike.changed == (ChangedPart("world", "table", "table@2"),)


def test_trials_have_their_task_and_planner_by_value(stored: Store) -> None:
    tasks = {(t.goal.name, t.start_name): t for t in extension_of_reach(TaskLayout())}
    trials = stored.trials.trials()
    for trial in trials:
        spec = trial.spec
        assert spec.task == tasks[spec.goal, spec.start]
        assert (spec.planner, spec.world) == (Component("nested-query"), Component("table"))
        held = {"t-hook", "l-hook", "stick"}
        assert spec.shape in held
        assert spec.held.parts
        assert trial.learned == stored.learning.run(trial.run_id).spec
    by_kind = [stored.trials.trials(kind=kind) for kind in ("solve", "break-tool")]
    assert all(by_kind)
    assert sum(map(len, by_kind)) == len(trials)
    assert {session.spec.task_set for session in stored.sessions.all()} == {"extension-of-reach"}


def test_the_rows_left_by_each_search_are_the_reasons_of_a_step(stored: Store) -> None:
    trial = next(t for t in stored.trials.trials() if t.steps)
    for step in stored.trials.steps(trial.id):
        names = [(reason.name, reason.value) for reason in step.reasons]
        assert names == [
            *(("consistent", None), ("probable", 0.5)),
            *(("reachable", None), ("nearest", 0.2)),
        ]
        left = [reason.rows for reason in step.reasons]
        assert left == sorted(left, key=lambda count: -(count or 0))
        assert isinstance(step.reasons[0], Reason)


def test_a_row_has_the_travel_of_its_wrist(stored: Store) -> None:
    for run in stored.learning.runs():
        for row in stored.learning.rows(run.id):
            distance = row.row.exploratory["offset_distance"]
            assert row.row.wrist_angle == 0.0
            whole = abs(row.row.travel.x) + abs(row.row.travel.y)
            assert whole == pytest.approx(distance) or row.row.truncated


OLDER = (
    "made in version 1 of the world table, this affcli has 2: it cannot be done again to the bit"
)


def test_a_learning_run_of_older_physics_is_not_replayed(stored: Store) -> None:
    with pytest.raises(BadInputError, match=OLDER):
        list(replay_run(stored, stored.learning.run(1), 20, 20))


def test_trials_of_older_physics_are_not_replayed(stored: Store) -> None:
    trials = stored.trials.trials()
    assert trials
    for trial in trials:
        with pytest.raises(BadInputError, match=OLDER):
            replay_trial(stored, trial.id)


@pytest.mark.parametrize("revision", [f"{k:04}" for k in range(3, int(REVISION))])
def test_an_interrupted_run_of_older_physics_is_not_gone_on_with(
    revision: str, tmp_path: Path
) -> None:
    """Nothing of it is lost, and the same command learns anew."""
    path, now = old_database(revision, tmp_path), "2026-01-02T03:04:05+00:00"
    upgrade(path)
    with open_store(path, create=False, write=True) as store:
        (run,) = store.learning.runs(status="running")
        with pytest.raises(BadInputError, match=OLDER):
            learn(store, run.spec, lambda: now)
        assert store.learning.runs(status="running") == (run,)
        again = learn(store, replace(run.spec, world=Component("table", version=2)), lambda: now)
        assert (again.new, again.info.behaviors) == (True, 24)


def test_runs_that_became_equal_are_told_apart(tmp_path: Path) -> None:
    """One was stored before a settings key was known, and again with it: both are kept."""
    path = old_database("0003", tmp_path)
    with closing(sqlite3.connect(path, isolation_level=None)) as driver:
        ((text,),) = driver.execute("SELECT settings FROM learning_run WHERE id = 2").fetchall()
        settings = json.loads(text)
        del settings["camera"]
        driver.execute(
            "INSERT INTO learning_run SELECT 9, session_id, tool, seed, robot, hours, "
            "behaviors_limit, ?, 'other', versions, status, 0, 0, 0, 0, 0.0, NULL, started_at, "
            "finished_at, calibration FROM learning_run WHERE id = 2",
            [json.dumps(settings)],
        )
    upgrade(path)
    with open_store(path, create=False, write=False) as store:
        found = store.learning.find(asked("l-hook", (), ("noisy", 2, 16)))
        assert found is not None
        assert found.id == 2
        assert store.learning.run(9).spec == found.spec
    ((first,), (other,)) = run_sql(
        path, "SELECT key FROM learning_run WHERE id IN (2, 9) ORDER BY id"
    ).rows
    assert other == str(first) + "-9"


def test_a_tool_of_another_name_has_no_shape(tmp_path: Path) -> None:
    """It can be listed and its rows shown."""
    path = old_database("0003", tmp_path)
    with closing(sqlite3.connect(path, isolation_level=None)) as driver:
        driver.execute("UPDATE learning_run SET tool = 'rake' WHERE id = 2")
    upgrade(path)
    with open_store(path, create=False, write=False) as store:
        run = store.learning.run(2)
        assert (run.spec.tool, run.spec.held.parts) == ("rake", ())
        assert len(store.learning.table(2)[0]) == run.rows
    assert run_sql(path, "SELECT tool_key FROM learning_run WHERE id = 2").rows == ((None,),)


def test_numbers_come_back_exactly(stored: Store) -> None:
    """Floats of a tool, of settings and of a task are those that the code computes."""
    for key, name, text in run_sql(stored.path, "SELECT * FROM tool").rows:
        own = asked(str(name), (), ("noisy", 0, 1)).held
        assert (key, json.loads(str(text))) == (own.key, own.canonical())
    starts = run_sql(stored.path, "SELECT DISTINCT start_x, start_y FROM trial").rows
    assert set(starts) == {task.start for task in extension_of_reach(TaskLayout())}


@pytest.fixture
def without_plan(tmp_path: Path) -> Path:
    """Two trials of revision 0009 that ended with `no row left`: of lookahead, which chose none of
    three rows that could be used, and of the nested query, which had none.
    """
    return Path(shutil.copy(DATABASES / "no_plan_0009.db", tmp_path / "old.db"))


def test_a_trial_that_no_plan_was_found_in_keeps_its_name_and_equals_its_record(
    without_plan: Path,
) -> None:
    """What it is called now is no difference: before revision 0010 there was no other name."""
    upgrade(without_plan)
    with open_store(without_plan, create=False, write=False) as store:
        for trial, planner in ((1, "lookahead"), (2, "nested-query")):
            info, again = store.trials.trial(trial), replay_trial(store, trial)
            assert str(info.spec.planner) == planner
            assert info.outcome is again.outcome is Outcome.NO_ROW
            assert again.end is not None
            assert (again.end.outcome, again.end.last_reasons) == (info.outcome, info.last_reasons)
            assert again.differences == ()


@pytest.mark.parametrize(
    ("trial", "outcome", "differs"),
    [
        (1, "no plan found", False),
        (1, "step limit", True),
        (2, "no plan found", True),
        (2, "step limit", True),
    ],
)
def test_any_other_end_than_the_recorded_is_a_difference(
    without_plan: Path, trial: int, outcome: str, *, differs: bool
) -> None:
    upgrade(without_plan)
    with closing(sqlite3.connect(without_plan, isolation_level=None)) as driver:
        driver.execute("UPDATE trial SET outcome = ? WHERE id = ?", [outcome, trial])
    with open_store(without_plan, create=False, write=False) as store:
        again = replay_trial(store, trial)
    found = [(d.number, d.column, d.stored) for d in again.differences]
    assert found == [(0, "outcome", outcome)] * differs
    assert again.outcome == outcome


def test_no_trial_gets_the_number_of_a_deleted_one(without_plan: Path) -> None:
    """The table is made anew, and the last number given stays."""
    with closing(sqlite3.connect(without_plan, isolation_level=None)) as driver:
        driver.execute("DELETE FROM step WHERE trial_id = 2")
        driver.execute("DELETE FROM trial WHERE id = 2")
    upgrade(without_plan)
    assert rows(without_plan, "SELECT seq FROM sqlite_sequence WHERE name = 'trial'") == [(2,)]
