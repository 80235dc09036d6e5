"""Databases of several machines brought together: each robot once, and the same as in one go."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

from affcli.errors import DatabaseError, UsageError
from affcli.lab.conducting import begin, run
from affcli.lab.definition import experiment_of
from affcli.lab.experiment import Experiment
from affcli.store import Merged, Store, check, merge, open_store
from tests.cli.program import contents
from tests.lab.quick import NOW, altered, now
from tests.store.records import VERSIONS, begun, learned, robot_record

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
        {"learning runs of affcli learn": 1, "sessions of affcli solve and break-tool": 2},
    )
