"""Databases of several machines brought together: each robot once, and the same as in one go."""

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from affcli.core.records import FailedRobot
from affcli.core.specs import Counters
from affcli.errors import DatabaseError, UsageError
from affcli.lab.conducting import begin, run
from affcli.lab.definition import experiment_of
from affcli.lab.experiment import Experiment
from affcli.store import Merged, Store, check, merge, open_store
from tests.cli.program import contents
from tests.lab.quick import NOW, altered, now
from tests.store.records import (
    VERSIONS,
    begun,
    learned,
    replication,
    robot_record,
    save_trial,
    trial_spec,
    trial_step,
    verification_spec,
)

TABLES = {
    "experiment": {"name": "shared", "robots": 10, "seed": 5},
    "base": {"minutes": 2, "tools": ["stick", "t-hook"], "settings": {"trial": {"max_steps": 2}}},
    "condition": [
        {"name": "paper"},
        {"name": "narrow", "planner": "nested-query:share=0.05"},
        {"name": "rough", "tools": ["t-hook"], "settings": {"friction": {"tool_puck": 0.4}}},
    ],
}
WHAT = experiment_of(TABLES, "a test")


@contextmanager
def opened(path: Path) -> Iterator[Store]:
    with open_store(path, create=True, write=True) as store:
        yield store


def live(path: Path, robots: Sequence[int], what: Experiment = WHAT) -> Path:
    """Let some robots live in a database."""
    with opened(path) as store:
        list(run(store, what, begin(store, what, now), 1, now, robots=robots))
    return path


@pytest.fixture(scope="module")
def shards(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Ten databases, each with every tenth robot: here one."""
    folder = tmp_path_factory.mktemp("shards")
    return [live(folder / f"{k}.db", range(k, 10, 10)) for k in range(10)]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return live(tmp_path_factory.mktemp("whole") / "whole.db", range(10))


def test_ten_shards_are_the_whole(shards: list[Path], whole: Path, tmp_path: Path) -> None:
    """Even their numbers are the same: robots are taken in order."""
    told: list[tuple[int, int]] = []
    merged = merge(shards[::-1], tmp_path / "all.db", NOW, lambda *far: told.append(far))
    assert merged == Merged(10, 0, {})
    assert told == [(number, 10) for number in range(1, 11)]
    assert contents(tmp_path / "all.db") == contents(whole)
    assert [finding for finding in check(tmp_path / "all.db") if finding.wrong] == []


def test_a_robot_that_failed_here_and_lives_there_lives(shards: list[Path], tmp_path: Path) -> None:
    path, into = tmp_path / "some.db", tmp_path / "all.db"
    path.write_bytes(shards[0].read_bytes())
    with opened(path) as store:
        for robot in (1, 2):
            store.sessions.save_failure(1, FailedRobot(robot, "ValueError", "no", 3), NOW)
    merge([path, shards[1]], into, NOW)
    with opened(into) as store:
        assert [one.robot for one in store.sessions.failed_robots(1)] == [2]
    merge([path, shards[2]], into, NOW)
    with opened(into) as store:
        assert store.sessions.failed_robots(1) == ()
        store.sessions.save_failure(1, FailedRobot(1, "ValueError", "no", 3), NOW)
        assert store.sessions.failed_robots(1) == ()  # it lives


def test_a_merge_again_and_bit_by_bit_changes_nothing(
    shards: list[Path], whole: Path, tmp_path: Path
) -> None:
    path = tmp_path / "all.db"
    for number, shard in enumerate(shards):
        assert merge([shard], path, NOW) == Merged(1, 0, {})
        with opened(path) as store:
            status = store.experiments.named("shared").status
            assert status == ("done" if number == 9 else "running")
    before = path.read_bytes()
    assert merge([*shards, whole], path, NOW) == Merged(0, 20, {})
    assert path.read_bytes() == before
    assert contents(path) == contents(whole)


def test_robots_that_are_missing_live_after_a_merge(
    shards: list[Path], whole: Path, tmp_path: Path
) -> None:
    path = tmp_path / "all.db"
    merge(shards[:4], path, NOW)
    live(path, range(10))
    assert contents(path) == contents(whole)


def test_an_experiment_that_was_made_larger_makes_the_other_larger(
    shards: list[Path], tmp_path: Path
) -> None:
    tables = {**TABLES, "experiment": {"name": "shared", "robots": 12, "seed": 5}}
    larger = experiment_of(tables, "a test")
    more = live(tmp_path / "more.db", [10, 11], larger)
    path = tmp_path / "all.db"
    assert merge([*shards, more], path, NOW) == Merged(12, 0, {})
    with opened(path) as store:
        info = store.experiments.named("shared")
        assert (info.status, info.definition) == ("done", larger.definition)
        assert {session.spec.robots for session in store.sessions.all()} == {12}


def test_what_contradicts_is_refused_and_nothing_changed(
    shards: list[Path], tmp_path: Path
) -> None:
    path, other = tmp_path / "all.db", tmp_path / "other.db"
    merge(shards[:2], path, NOW)
    before = contents(path)
    other.write_bytes(shards[1].read_bytes())
    altered(other, "UPDATE trial SET steps = steps + 1 WHERE id = 3")
    with pytest.raises(DatabaseError) as refused:
        merge([shards[2], other], path, NOW)
    assert str(refused.value) == (
        f"{other}: robot 1 of experiment shared is another than in {path}: its trial with the "
        "stick at goal 1 from 3 differs; were they made by other versions?"
    )
    assert contents(path) == before
    altered(other, "UPDATE learning_run SET rows = rows + 1")
    with pytest.raises(DatabaseError, match=r"robot 1 of .*: the stick it learned differs"):
        merge([other], path, NOW)
    altered(other, "UPDATE experiment SET key = 'another'")
    with pytest.raises(
        DatabaseError, match=r"other.db: its experiment shared is another than that"
    ):
        merge([other], path, NOW)
    assert contents(path) == before


def test_a_record_by_the_name_of_before_is_of_the_same_robot(
    shards: list[Path], tmp_path: Path
) -> None:
    """`no row left` was the name of `no plan found`, too; what is there already stays."""
    older, newer, path = (tmp_path / name for name in ("older.db", "newer.db", "all.db"))
    for one, outcome in ((older, "no row left"), (newer, "no plan found")):
        one.write_bytes(shards[1].read_bytes())
        altered(one, f"UPDATE trial SET outcome = '{outcome}' WHERE id = 3")
    for first, second in ((older, newer), (newer, older)):
        path.unlink(missing_ok=True)
        merge([first], path, NOW)
        before = contents(path)
        assert merge([second], path, NOW) == Merged(0, 1, {})
        assert contents(path) == before
    altered(older, "UPDATE trial SET outcome = 'step limit' WHERE id = 3")
    with pytest.raises(DatabaseError, match=r"its trial with the .* differs"):
        merge([older], path, NOW)


@pytest.mark.parametrize("lacks", ["source", "target"])
@pytest.mark.parametrize("which", ["LIMIT 1 OFFSET 2", "DESC LIMIT 1"])
def test_a_robot_that_lacks_a_trial_is_refused(
    shards: list[Path], tmp_path: Path, lacks: str, which: str
) -> None:
    """One in the middle or the last one."""
    paths = {name: tmp_path / f"{name}.db" for name in ("source", "target")}
    for path in paths.values():
        path.write_bytes(shards[1].read_bytes())
    with closing(sqlite3.connect(paths[lacks])) as driver:
        wanted = f"SELECT id, shape, goal, start FROM trial ORDER BY id {which}"
        number, shape, goal, start = driver.execute(wanted).fetchone()
    altered(
        paths[lacks],
        f"DELETE FROM step WHERE trial_id = {number}",
        f"DELETE FROM trial WHERE id = {number}",
    )
    before = contents(paths["target"])
    with pytest.raises(DatabaseError) as refused:
        merge([paths["source"]], paths["target"], NOW)
    assert str(refused.value) == (
        f"{paths['source']}: robot 1 of experiment shared is another than in {paths['target']}: "
        f"its trial with the {shape} at goal {goal} from {start} is not in {paths[lacks]}; was it "
        "deleted?"
    )
    assert contents(paths["target"]) == before


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ("UPDATE trial SET goal = '7' WHERE id = 3", "its trial with the stick at goal 7 from 3"),
        ("UPDATE trial SET start = '7' WHERE id = 3", "its trial with the stick at goal 1 from 7"),
        ("UPDATE trial SET planner = 'p' WHERE id = 3", "its trial with the stick at goal 1 from"),
        ("UPDATE trial SET session_id = 2 WHERE id = 3", "its trial with the stick at goal 1"),
        ("UPDATE learning_run SET tool = 'hoe' WHERE id = 1", "the hoe it learned"),
    ],
)
def test_a_robot_that_did_other_things_is_refused(
    shards: list[Path], tmp_path: Path, change: str, what: str
) -> None:
    source, target = tmp_path / "source.db", tmp_path / "target.db"
    for path in (source, target):
        path.write_bytes(shards[1].read_bytes())
    altered(source, change)
    before = contents(target)
    with pytest.raises(DatabaseError, match=rf"robot 1 of experiment shared .*: {what}.* differs"):
        merge([source], target, NOW)
    assert contents(target) == before


def test_rows_that_solve_used_are_copied_as_they_were_learned(tmp_path: Path) -> None:
    """The trials and verifications that moved their counters are left out."""
    source, target = tmp_path / "a.db", tmp_path / "all.db"
    with opened(source) as store:
        lived = begun(store, "reproduce")
        store.sessions.save_robot({lived: VERSIONS}, robot_record(0), NOW)
        run_id = store.learning.runs(session_id=lived)[0].id
        (first, second), ids = store.learning.table(run_id)
        used = trial_spec(counters=Counters.STORED, tool="stick")
        save_trial(store, begun(store), run_id, used, [trial_step(first)])
        tried = [(*replication(second), ids[second.step])]
        store.verifications.save(run_id, verification_spec(), tried, VERSIONS, NOW, NOW)
    merged = merge([source], target, NOW)
    assert merged.left_out == {
        "sessions of affcli solve and break-tool": 1,
        "verifications of affcli verify": 1,
    }
    assert [finding for finding in check(source) if finding.wrong] == []
    assert [finding for finding in check(target) if finding.wrong] == []
    assert merge([source], target, NOW) == Merged(0, 1, merged.left_out)


def test_experiments_whose_numbers_are_the_same_are_kept_apart(tmp_path: Path) -> None:
    """Each begins at session 1 of its own database."""
    other = experiment_of(
        {**TABLES, "experiment": {"name": "other", "robots": 1, "seed": 6}}, "a test"
    )
    parts = [live(tmp_path / "a.db", [0]), live(tmp_path / "b.db", [0], other)]
    target = tmp_path / "all.db"
    assert merge(parts, target, NOW).new == 2
    with opened(target) as store:
        assert [info.name for info in store.experiments.all()] == ["shared", "other"]
        sessions = [number for info in store.experiments.all() for _, number in info.conditions]
        assert len(set(sessions)) == 6
        assert all(store.learning.runs(session_id=number) for number in sessions)
    assert not any(finding.wrong for finding in check(target))


@pytest.mark.parametrize("existing", [False, True])
def test_a_merge_that_fails_leaves_no_new_file(
    shards: list[Path], tmp_path: Path, *, existing: bool
) -> None:
    path, other = tmp_path / "all.db", tmp_path / "other.db"
    other.write_bytes(shards[1].read_bytes())
    altered(other, "UPDATE trial SET steps = steps + 1 WHERE id = 3")
    if existing:
        merge(shards[:1], path, NOW)
    with pytest.raises(DatabaseError, match="robot 1 of"):
        merge([shards[1], other], path, NOW)
    assert {one.name for one in tmp_path.iterdir()} == {"other.db", *(["all.db"] * existing)}


def test_a_file_that_appears_during_a_merge_is_kept(shards: list[Path], tmp_path: Path) -> None:
    path = tmp_path / "all.db"
    with pytest.raises(DatabaseError, match=r"all.db: another process made it meanwhile"):
        merge(shards[:1], path, NOW, lambda *_: path.write_text("mine"))
    assert path.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [path]


def test_a_merge_that_is_interrupted_changes_nothing(shards: list[Path], tmp_path: Path) -> None:
    path = tmp_path / "all.db"
    merge(shards[:1], path, NOW)
    before = contents(path)

    def interrupt(done: int, _: int) -> None:
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        merge(shards, path, NOW, interrupt)
    assert contents(path) == before
    assert merge(shards, path, NOW) == Merged(9, 1, {})


def test_a_source_is_not_the_target(shards: list[Path]) -> None:
    with pytest.raises(UsageError, match="is one of those to merge; name another file"):
        merge(shards, shards[3], NOW)


def test_no_target_is_made_where_a_source_is_missing(shards: list[Path], tmp_path: Path) -> None:
    with pytest.raises(DatabaseError, match=r"none.db: no database there"):
        merge([*shards, tmp_path / "none.db"], tmp_path / "all.db", NOW)
    assert list(tmp_path.iterdir()) == []


def test_reproductions_are_merged_by_what_they_are_functions_of(tmp_path: Path) -> None:
    paths = [tmp_path / f"{number}.db" for number in range(2)]
    for number, path in enumerate(paths):
        with opened(path) as store:
            begun(store, "reproduce", robots=5 + number)
            session = begun(store, "reproduce", robots=2)
            store.sessions.save_robot({session: VERSIONS}, robot_record(number), NOW)
    assert merge(paths, tmp_path / "all.db", NOW).new == 2
    with opened(tmp_path / "all.db") as store:
        found = {one.spec.robots: one for one in store.sessions.all("reproduce")}
        assert {robots: one.status for robots, one in found.items()} == {
            2: "done",
            5: "running",
            6: "running",
        }
        assert store.sessions.saved_robots(found[2].id) == {0, 1}


def test_what_is_not_merged_is_told(tmp_path: Path) -> None:
    with opened(tmp_path / "a.db") as store:
        learned(store)
        begun(store, "solve")
        begun(store, "break-tool")
    assert merge([tmp_path / "a.db"], tmp_path / "all.db", NOW) == Merged(
        *(0, 0),
        {
            "learning runs of affcli learn and import": 1,
            "sessions of affcli solve and break-tool": 2,
        },
    )
