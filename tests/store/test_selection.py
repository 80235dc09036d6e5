"""What filters leave: the same as when every row is looked at; and taken out whole."""

import operator
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from affcli.behaviors.moving import CONTRACT_ARM, EXTEND_ARM, SLIDE_ARM_LEFT
from affcli.core.behavior import BehaviorCall, BehaviorName
from affcli.core.records import StoredRow
from affcli.core.row_filter import Column, Relation, RowFilter
from affcli.errors import DatabaseError
from affcli.store import Store, open_store
from tests.factories import learning_spec
from tests.store.records import (
    NOW,
    VERSIONS,
    begun,
    learned,
    learning_step,
    robot_record,
    trial_record,
    trial_spec,
)

COMPARISONS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
NAMES = (EXTEND_ARM, CONTRACT_ARM, SLIDE_ARM_LEFT)
RUNS = (1, 2, 3)


def call(name: BehaviorName, inches: float) -> BehaviorCall:
    return BehaviorCall.of(name, {"offset_distance": inches})


@pytest.fixture(scope="module")
def varied(empty_database: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three runs, two of them of one tool, in which behaviors and counters vary.

    They were learned in turn, a chunk each: the ids of the rows are not in the order of the runs.
    """
    path = Path(shutil.copy(empty_database, tmp_path_factory.mktemp("varied") / "varied.db"))
    with open_store(path, create=False, write=True) as store:
        specs = [learning_spec(t, seed=n) for t, n in (("t-hook", 0), ("stick", 0), ("t-hook", 1))]
        runs = [store.learning.begin(spec, VERSIONS, NOW).id for spec in specs]
        steps = [
            learning_step(n, moved=(0.0, 4.0), call=call(NAMES[n % 3], 2.0 + 3.0 * (n % 2)))
            for n in range(1, 13)
        ]
        for first in (0, 6):
            chunk = steps[first : first + 6]
            for run in runs:
                over = first > 0
                assert store.learning.append(run, first, chunk, None, 1.0, done=over, now=NOW)
        with store.database.writing() as connection:
            connection.exec_driver_sql(
                "UPDATE affordance"
                " SET times_used = 1 + id % 5, times_successful = id % (2 + id % 5)"
            )
    return path


@pytest.fixture
def rows(varied: Path) -> Iterator[Store]:
    """`varied`, open for reading."""
    with open_store(varied, create=False, write=False) as store:
        yield store


bounds = st.tuples(st.sampled_from(list(COMPARISONS)), st.sampled_from((0.0, 0.25, 0.5, 2 / 3, 1)))
behaviors = st.sampled_from(
    [BehaviorCall(name, ()) for name in NAMES] + [call(name, 5.0) for name in NAMES]
)
filters = st.builds(
    RowFilter,
    runs=st.none() | st.sets(st.sampled_from((*RUNS, 4))).map(tuple),
    tool=st.sampled_from((None, "t-hook", "stick", "spoon")),
    behavior=st.none() | behaviors,
    probability=st.lists(bounds, max_size=2).map(tuple),
    limit=st.none() | st.integers(1, 40),
)


def naive(rows: list[StoredRow], wanted: RowFilter) -> list[int]:
    """Return the ids of the rows that are left when each is looked at."""
    left = []
    for stored in rows:
        row, behavior = stored.row, wanted.behavior
        keep = wanted.runs is None or stored.run_id in wanted.runs
        keep = keep and wanted.tool in (None, stored.tool)
        if behavior is not None:
            keep = keep and behavior.name == row.exploratory.name
            keep = keep and behavior.params in ((), row.exploratory.params)
        for comparison, bound in wanted.probability:
            keep = keep and COMPARISONS[comparison](row.replication_probability, bound)
        if keep:
            left.append(stored.id)
    return left[: wanted.limit]


@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=200
)
@given(filters)
def test_the_filter_of_the_database_is_that_of_a_person(rows: Store, wanted: RowFilter) -> None:
    """Row by row, listed and taken out."""
    every = [row for run in RUNS for row in rows.learning.rows(run)]
    assert len(every) == 36
    left = naive(every, wanted)
    assert [row.id for row in rows.selections.rows(wanted)] == left
    taken = rows.selections.extract("rows", wanted, lambda _, found: [row[0] for row in found])
    assert taken == left


def test_listed_rows_are_those_of_their_run(rows: Store) -> None:
    assert rows.selections.rows(RowFilter(runs=(2,))) == rows.learning.rows(2)
    assert rows.selections.rows(RowFilter(runs=())) == ()


TAKEN: dict[Relation, tuple[str, str]] = {
    "rows": ("affordance_wide", "run = 2"),
    "behaviors": ("behavior", "learning_run_id = 2"),
    "trials": ("trial", "learning_run_id = 2"),
    "steps": ("step", "trial_id IN (SELECT id FROM trial WHERE learning_run_id = 2)"),
}


@pytest.fixture
def lives(store: Store) -> Store:
    """A store with the lives of two robots, and a run of a person's own with a trial."""
    session = begun(store, "reproduce", robots=2)
    for robot in (0, 1):
        store.sessions.save_robot({session: VERSIONS}, robot_record(robot), NOW)
    run = learned(store)
    table, ids = store.learning.table(run.id)
    solving = begun(store)
    store.trials.save_all(solving, run.id, [trial_record(trial_spec(), list(table))], ids)
    return store


@pytest.mark.parametrize("what", TAKEN)
def test_all_columns_are_taken_out_as_they_stand(what: Relation, lives: Store) -> None:
    relation, condition = TAKEN[what]
    with closing(sqlite3.connect(lives.path)) as driver:
        cursor = driver.execute(f"SELECT * FROM {relation}")
        every, names = cursor.fetchall(), [name for name, *_ in cursor.description]
        of_one = driver.execute(f"SELECT * FROM {relation} WHERE {condition}").fetchall()
        of_tool = driver.execute(
            f"SELECT * FROM {relation} WHERE "
            + condition.replace("= 2", "IN (SELECT id FROM learning_run WHERE tool = 't-hook')")
        ).fetchall()
    assert 0 < len(of_one) < len(of_tool) < len(every)
    for wanted, left in (
        (RowFilter(), every),
        (RowFilter(runs=(2,)), of_one),
        (RowFilter(tool="t-hook"), of_tool),
        (RowFilter(tool="t-hook", runs=(1,)), []),
        (RowFilter(limit=1), every[:1]),
    ):
        columns, found = lives.selections.extract(
            what, wanted, lambda c, rows: (list(c), list(rows))
        )
        assert [column.name for column in columns] == names
        assert found == left
        for row in found:
            for column, value in zip(columns, row, strict=True):
                assert value is None or type(value) is column.kind, column


def test_the_kinds_of_columns_do_not_depend_on_what_is_in_them(store: Store, lives: Store) -> None:
    for what in TAKEN:
        empty = store.selections.extract(what, RowFilter(runs=()), lambda columns, _: list(columns))
        assert empty == lives.selections.extract(
            what, RowFilter(), lambda columns, _: list(columns)
        )
    columns = store.selections.extract("rows", RowFilter(), lambda columns, _: dict(columns))
    kinds = ("id", int), ("tool", str), ("expected_dx", float), ("replication_probability", float)
    assert {name: columns[name] for name, _ in kinds} == dict(kinds)
    assert Column("truncated", int) in columns.items()


def test_rows_are_given_one_after_the_other(rows: Store) -> None:
    """Whoever has seen enough reads no further."""
    assert rows.selections.extract("rows", RowFilter(), lambda _, found: next(found)[0]) == 1
    assert rows.selections.extract("rows", RowFilter(), lambda *_: "nothing") == "nothing"
    assert len(rows.selections.rows(RowFilter())) == 36


def test_the_steps_that_tried_a_row_are_those_of_all_its_trials(lives: Store) -> None:
    trials = [trial for trial in lives.trials.trials() if trial.steps]
    steps = [step for trial in trials for step in lives.trials.steps(trial.id)]
    tried = {step.affordance_id for step in steps}
    for row in lives.selections.rows(RowFilter()):
        expected = tuple(step for step in steps if step.affordance_id == row.id)
        assert lives.trials.steps_of_row(row.id) == expected
        assert bool(expected) == (row.id in tried)
    assert max(len(lives.trials.steps_of_row(row)) for row in tried) > 1
    assert lives.trials.steps_of_row(10**6) == ()


def test_text_in_no_encoding_is_named(lives: Store) -> None:
    with lives.database.writing() as connection:
        connection.exec_driver_sql("UPDATE affordance SET tool = CAST(x'ff41' AS TEXT)")
    with pytest.raises(DatabaseError, match="holds text that is none and that affcli did not wri"):
        lives.selections.rows(RowFilter())
    with pytest.raises(DatabaseError, match="holds text that is none"):
        lives.selections.extract("rows", RowFilter(), lambda _, found: list(found))
