"""Many robots under several conditions: paired, each once, the same however they are run."""

import shutil
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from affcli.core.records import FailedRobot
from affcli.core.row_filter import RowFilter
from affcli.core.specs import Keep, Protocol, RobotRecord
from affcli.errors import BadInputError, DatabaseError, SimulationDivergedError, UsageError
from affcli.lab import conducting, experiment, reproduction
from affcli.lab.conducting import begin, estimate, run
from affcli.lab.definition import experiment_of
from affcli.lab.experiment import Experiment, one_robot
from affcli.lab.reproduction import Reproduced
from affcli.lab.table import listed_rows
from affcli.lab.workers import Failed
from affcli.store import (
    PackedRobot,
    Store,
    check,
    open_store,
    pack_robot,
    run_sql,
    upgrade,
)
from affcli.store.columns import COLUMNS
from tests.lab.quick import PLANNER, now, taken
from tests.lab.test_reproduction import contents

TABLES = {
    "experiment": {"name": "three", "question": "Does it matter?", "robots": 3, "seed": 11},
    "base": {
        "minutes": 6,
        "tools": ["stick", "t-hook"],
        "settings": {"trial": {"max_steps": 3}},
    },
    "condition": [
        {"name": "paper"},
        {"name": "narrow", "planner": "nested-query:share=0.05"},
        {"name": "rough", "tools": ["t-hook"], "settings": {"friction": {"tool_puck": 0.4}}},
    ],
}
WHAT = experiment_of(TABLES, "a test")
KEPT_BY_ALL = ("experiment", "session", "learning_run", "trial", "tool")
NEEDED_BY = {
    Keep.TRIALS: KEPT_BY_ALL,
    Keep.ROWS: (*KEPT_BY_ALL, "affordance", "step"),
    Keep.ALL: (*KEPT_BY_ALL, "affordance", "step", "behavior"),
}
"""The tables that hold what is kept."""
OLD = Path(__file__).parents[1] / "store" / "databases" / "interrupted_0004.db"
"""A reproduction of two robots that was interrupted after one, made by revision 0004."""


@pytest.fixture(scope="module")
def life() -> RobotRecord:
    return one_robot(WHAT, 1)


@pytest.fixture
def another_store(migrated: Path, tmp_path: Path) -> Iterator[Store]:
    path = tmp_path / "another.db"
    path.write_bytes(migrated.read_bytes())
    with open_store(path, create=False, write=True) as opened:
        yield opened


def run_all(store: Store, what: Experiment = WHAT, workers: int = 1) -> list[int]:
    return list(run(store, what, begin(store, what, now), workers, now))


def test_what_conditions_share_is_learned_once(life: RobotRecord) -> None:
    assert [(spec.tool, spec.settings) for spec, _, _ in life.learned] == [
        ("stick", '{"trial.max_steps":3}'),
        ("t-hook", '{"trial.max_steps":3}'),
        ("t-hook", '{"friction.tool_puck":0.4,"trial.max_steps":3}'),
    ]
    counts: dict[tuple[int, int], int] = {}
    for one in life.tested:
        counts[one.condition, one.run] = counts.get((one.condition, one.run), 0) + 1
    # Of each tool 16 trials, and of the T-hook that becomes an L-hook 16 more.
    assert counts == {(0, 0): 16, (0, 1): 32, (1, 0): 16, (1, 1): 32, (2, 2): 32}


def test_a_condition_alone_is_what_it_is_among_others(life: RobotRecord) -> None:
    for number, condition in enumerate(WHAT.conditions):
        alone = one_robot(replace(WHAT, conditions=(condition,)), 1)
        assert alone.trials == tuple(t.trial for t in life.tested if t.condition == number)


def test_the_papers_condition_is_a_reproduction() -> None:
    paper = replace(WHAT.conditions[0], tools=("stick", "t-hook"))
    what = Reproduced(paper.parts, PLANNER, 11, hours=0.1)
    whole = reproduction.one_robot(what, 1)
    ours = one_robot(replace(WHAT, conditions=(paper,)), 1)
    tools = {"stick", "t-hook"}
    assert ours.trials == tuple(trial for trial in whole.trials if trial.spec.tool in tools)
    assert any(trial.spec.protocol is Protocol.TOOL_ADAPTATION for trial in ours.trials)


def test_the_store_is_the_same_for_any_number_of_workers(
    store: Store, another_store: Store
) -> None:
    assert run_all(store) == run_all(another_store, workers=2) == [0, 1, 2, 3]
    assert contents(store) == contents(another_store)
    assert [finding for finding in check(store.path) if finding.wrong] == []
    info = store.experiments.named("three")
    assert (info.status, info.question, info.definition) == (
        *("done", "Does it matter?"),
        WHAT.definition,
    )
    assert [name for name, _ in info.conditions] == ["paper", "narrow", "rough"]
    sessions = {one.id: one for one in store.sessions.all("experiment")}
    for condition, (name, session) in zip(WHAT.conditions, info.conditions, strict=True):
        one = sessions[session]
        assert (one.experiment_id, one.condition, one.status) == (info.id, name, "done")
        assert one.spec == condition.session("experiment", 11, 3)
        assert store.sessions.saved_robots(session) == {0, 1, 2}
        used = store.learning.runs(session_id=session)
        assert {(r.spec.tool, r.spec.robot) for r in used} == {
            (tool, robot) for tool in condition.tools for robot in range(3)
        }
        owner = session if name == "rough" else info.conditions[0][1]
        assert {r.session_id for r in used} == {owner}
    assert store.learning.runs() == ()
    assert run_sql(store.path, "select count(*) from learning_run").rows == ((9,),)


def test_an_interrupted_experiment_goes_on_with_the_robots_that_are_missing(
    store: Store, another_store: Store
) -> None:
    run_all(another_store)
    info = begin(store, WHAT, now)
    taken(run(store, WHAT, info, 1, now), 2)
    half = store.experiments.named("three")
    assert half.status == "running"
    again = experiment_of(half.definition, "a database")
    assert list(run(store, again, begin(store, again, now), 1, now)) == [1, 2, 3]
    assert contents(store) == contents(another_store)
    assert run_all(store) == [3]
    assert contents(store) == contents(another_store)


def test_more_robots_are_added_to_those_that_are_there(store: Store, another_store: Store) -> None:
    run_all(store, replace_head(robots=1))
    assert run_all(store, replace_head(robots=3, question="And now?")) == [1, 2, 3]
    run_all(another_store, replace_head(robots=3, question="And now?"))
    assert contents(store) == contents(another_store)
    with pytest.raises(UsageError, match=r"three: 3 robots are in .* write robots = 3 or more"):
        run_all(store, replace_head(robots=2))


def replace_head(**head: object) -> Experiment:
    return experiment_of({**TABLES, "experiment": TABLES["experiment"] | head}, "a test")  # type: ignore[operator]


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"experiment": {**TABLES["experiment"], "seed": 12}}, "its seed is 11, not 12"),  # type: ignore[dict-item]
        ({"condition": TABLES["condition"][:2]}, "its conditions are paper, narrow, rough"),  # type: ignore[index]
        ({"base": {**TABLES["base"], "minutes": 7}}, "hours of paper is 0.1, not 0.11666"),  # type: ignore[dict-item]
        (
            {"base": {**TABLES["base"], "settings": {"trial": {"max_steps": 4}}}},  # type: ignore[dict-item]
            "trial.max_steps of paper is 3, not 4",
        ),
        (
            {"base": {**TABLES["base"], "settings": {}}},  # type: ignore[dict-item]
            "trial.max_steps of paper is 3, not its default",
        ),
    ],
)
def test_another_experiment_of_the_same_name_is_refused(
    store: Store, changed: dict[str, object], says: str
) -> None:
    taken(run(store, WHAT, begin(store, WHAT, now), 1, now), 2)
    before = contents(store)
    with pytest.raises(UsageError, match=r"three is in .* already, but .* another name") as refused:
        begin(store, experiment_of({**TABLES, **changed}, "a test"), now)
    assert says in str(refused.value)
    assert contents(store) == before


def test_one_that_has_no_robot_yet_makes_room_for_another_of_its_name(store: Store) -> None:
    old = begin(store, replace_head(seed=12), now)
    info = begin(store, WHAT, now)
    assert (info.key, [one.id for one in store.experiments.all()]) == (WHAT.key, [info.id])
    sessions = {one.id for one in store.sessions.all()}
    assert sessions == {number for _, number in info.conditions}
    assert sessions.isdisjoint(number for _, number in old.conditions)  # no id is given twice


def test_of_two_begun_at_once_only_one_has_robots(store: Store) -> None:
    """What another process begins and saves is seen although it began in the meantime."""
    other = replace_head(seed=12, robots=1)
    with open_store(store.path, create=False, write=True, timeout=0.0) as theirs:
        first = run(theirs, other, begin(theirs, other, now), 1, now)
        mine = begin(store, WHAT, now)  # the other has no robot yet
        with pytest.raises(DatabaseError, match="perhaps it was deleted meanwhile"):
            list(first)
    taken(run(store, WHAT, mine, 1, now), 2)
    with pytest.raises(UsageError, match="its seed is 11, not 12"):
        begin(store, other, now)

    def while_begun() -> str:
        with open_store(store.path, create=False, write=True, timeout=0.0) as theirs:
            begin(theirs, replace_head(name="four", seed=1), now)
        return now()

    with pytest.raises(DatabaseError, match="locked"):  # nobody comes in between
        begin(store, replace_head(name="four"), while_begun)


def test_it_is_done_when_all_that_it_is_to_have_are_there(store: Store) -> None:
    few = replace_head(robots=1)
    info = begin(store, few, now)
    begin(store, WHAT, now)  # another process wants more of it meanwhile
    assert list(run(store, few, info, 1, now)) == [0, 1]
    assert store.experiments.named("three").status == "running"
    assert run_all(store) == [1, 2, 3]
    assert store.experiments.named("three").status == "done"


def test_as_much_is_kept_of_all_robots(store: Store) -> None:
    few = replace_head(robots=1)
    list(run(store, few, begin(store, few, now, Keep.ROWS), 1, now, keep=Keep.ROWS))
    with pytest.raises(UsageError, match="with --keep rows, not trials; give the same, or another"):
        begin(store, WHAT, now, Keep.TRIALS)
    more = replace_head(robots=2)
    list(run(store, more, begin(store, more, now), 1, now))
    assert run_sql(store.path, "select distinct kept from learning_run").rows == (("rows",),)


def test_no_worker_lives_on_when_saving_fails(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed = []

    def lives(*_: object) -> Iterator[None]:
        try:
            yield None
        finally:
            closed.append(True)

    monkeypatch.setattr(conducting, "in_order", lives)
    told = run(store, replace_head(robots=1), begin(store, WHAT, now), 1, now)
    with pytest.raises(AttributeError):  # what it is given is no robot
        list(told)
    assert closed == [True]


def test_experiments_are_found_by_name(store: Store) -> None:
    with pytest.raises(UsageError, match="no experiment 'three': there is none yet"):
        store.experiments.named("three")
    begin(store, WHAT, now)
    begin(store, replace_head(name="four"), now)
    assert [one.name for one in store.experiments.all()] == ["three", "four"]
    with pytest.raises(UsageError, match="no experiment 'thre'; did you mean three"):
        store.experiments.named("thre")


def test_an_estimate_is_of_a_robot_that_lived(store: Store) -> None:
    found = estimate(WHAT, now)
    assert (found.robots, found.learning_runs, found.trials) == (3, 9, 3 * 128)
    assert found.robot_hours == pytest.approx(0.9)
    empty = store.path.stat().st_size
    run_all(store, replace_head(robots=1))
    assert found.bytes == pytest.approx(store.path.stat().st_size - empty, rel=0.1)
    assert found.seconds > 0.0


def test_a_reproduction_of_older_physics_is_not_gone_on_with(tmp_path: Path) -> None:
    """It says so in one line, and what is there stays."""
    path = Path(shutil.copy(OLD, tmp_path / "old.db"))
    path.chmod(0o644)
    upgrade(path)
    with open_store(path, create=False, write=True) as store:
        (half,) = store.sessions.all("reproduce")
        assert (half.id, half.status, half.experiment_id) == (1, "running", None)
        before = contents(store)
        what, robots = reproduction.reproduced_again(half.spec), half.spec.robots
        with pytest.raises(BadInputError, match="world table: this affcli has version 2 of it"):
            list(reproduction.reproduce(store, what, robots, 1, now))
        assert contents(store) == before
    assert [finding for finding in check(path) if finding.wrong] == []


def fail(which: frozenset[int], experiment: Experiment, keep: Keep, robot: int) -> PackedRobot:
    """Let a robot live, unless it is one of those that fail."""
    if robot in which:
        raise SimulationDivergedError("too stiff; soften it")
    return pack_robot(one_robot(experiment, robot), keep)


def test_a_robot_that_fails_does_not_keep_the_others_from_living(
    store: Store, another_store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    info = begin(store, WHAT, now)
    with monkeypatch.context() as changed:
        changed.setattr(conducting, "_packed_life", partial(fail, frozenset({1})))
        assert list(run(store, WHAT, info, 1, now)) == [0, 1, 2]
    sessions = [session for _, session in info.conditions]
    noted = (FailedRobot(1, "SimulationDivergedError", "too stiff; soften it", 3),)
    assert [store.sessions.failed_robots(one) for one in sessions] == [noted] * 3
    assert store.sessions.saved_robots(sessions[0]) == {0, 2}
    assert store.experiments.named("three").status == "done"  # nothing is left that was not tried
    (unfinished,) = (finding for finding in check(store.path) if finding.unfinished)
    assert unfinished.example == "robot 1 of session 1 (SimulationDivergedError)"
    assert run_all(store) == [2, 3]
    assert store.sessions.failed_robots(sessions[0]) == ()
    run_all(another_store)
    count = "select robot, count(*), sum(steps) from trial group by robot"
    assert run_sql(store.path, count).rows == run_sql(another_store.path, count).rows


@dataclass(frozen=True)
class Pool:
    """Gives answers that are made already."""

    answers: Sequence[Any]

    def in_order(
        self, work: Callable[[Any], Any], tasks: Sequence[Any], warn: Callable[[str], object]
    ) -> Generator[Any, None, None]:
        yield from self.answers


def test_a_bug_is_noted_with_its_traceback(store: Store, life: RobotRecord) -> None:
    what = replace_head(robots=2)
    info = begin(store, what, now)
    lives = [Failed(ZeroDivisionError("one\nby zero"), 3), pack_robot(life)]
    assert list(run(store, what, info, Pool(lives), now)) == [0, 1]
    (failed,) = store.sessions.failed_robots(info.conditions[2][1])
    assert (failed.robot, failed.kind, failed.message) == (
        *(0, "ZeroDivisionError"),
        "one\\nby zero",
    )
    ((noted,),) = run_sql(store.path, "select traceback from failed_robot").rows
    assert str(noted).endswith("ZeroDivisionError: one\nby zero\n")


def test_where_the_first_robots_all_fail_the_others_are_not_tried(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    what = replace_head(robots=1000)
    monkeypatch.setattr(conducting, "_packed_life", partial(fail, frozenset(range(1000))))
    with pytest.raises(SimulationDivergedError, match=r"^robot 0 \(and 2 more\): too stiff"):
        run_all(store, what)


@pytest.mark.parametrize("keep", Keep)
def test_what_is_kept_is_the_same_and_what_is_not_is_said(
    store: Store, another_store: Store, keep: Keep
) -> None:
    what, kept = replace_head(robots=1), NEEDED_BY[keep]
    run_all(another_store, what)
    info = begin(store, what, now)
    assert list(run(store, what, info, 1, now, keep=keep)) == [0, 1]
    assert [finding for finding in check(store.path) if finding.wrong] == []
    for table, columns in COLUMNS.items():
        names = ", ".join(name for name in columns if name != "kept")
        every = f"select {names} from {table}"
        wanted = run_sql(another_store.path, every).rows if table in kept else ()
        assert run_sql(store.path, every).rows == wanted, table
    assert {one.kept for one in store.learning.runs(session_id=1)} == {keep}
    counts = store.results.success_counts(1)
    assert counts == another_store.results.success_counts(1)
    readers: dict[str, Callable[[], object]] = {
        "affordance": lambda: store.learning.table(1),
        "step": lambda: store.trials.steps(1),
        "behavior": lambda: store.learning.scene(1, 1),
    }
    for table, read in readers.items():
        if table in kept:
            assert read()
        else:
            words = rf"run 1: its .* were not kept \(--keep {keep}\); .* makes them again"
            with pytest.raises(UsageError, match=words):
                read()
    rows = partial(listed_rows, store, store.learning.runs(session_id=1), RowFilter(), None)
    if keep is Keep.TRIALS:
        with pytest.raises(UsageError, match=r"run 1: its rows were not kept \(--keep trials\)"):
            rows()
    else:
        assert rows()


def test_a_life_is_a_pure_function(life: RobotRecord) -> None:
    assert experiment.one_robot(WHAT, 1) == life
