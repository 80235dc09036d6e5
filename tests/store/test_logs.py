"""Where imported runs come from is told as it was given."""

import pytest

from affcli.core.log import LogFile, LogLine, LogSource
from affcli.errors import DatabaseError
from affcli.store import Store
from tests.store.records import learned, learning_steps

FILES = (LogFile("b.txt", "b" * 64), LogFile("unused.txt", "c" * 64), LogFile("a.txt", "a" * 64))
SOURCE = LogSource("a robot", None, "who, 2026", {"columns": {"x": 1}}, 4, FILES)
LINES = (LogLine(1, 3, 7, "cube"), LogLine(2, 1, 9, None), LogLine(3, 3, 8, "ball"))


def test_a_source_is_told_as_it_was_saved(store: Store) -> None:
    """Of the files those that lines stand in, in the order of their numbers."""
    run = learned(store, 3)
    assert store.logs.source(run.id) is None
    assert store.logs.line(run.id, 1) is None
    store.logs.save(run.id, SOURCE, LINES)
    assert store.logs.source(run.id) == SOURCE._replace(files=(FILES[0], FILES[2]))
    told = [store.logs.line(run.id, line.step) for line in LINES]
    assert told == [(FILES[line.file - 1], line) for line in LINES]
    assert store.logs.line(run.id, 4) is None


def test_a_source_that_cannot_be_read_is_named(store: Store) -> None:
    run = learned(store, 3)
    store.logs.save(run.id, SOURCE, LINES)
    with store.database.writing() as connection:
        connection.exec_driver_sql("update log set map = '{'")
    with pytest.raises(DatabaseError, match=f"the log of run {run.id}"):
        store.logs.source(run.id)


def test_what_each_behavior_did_is_told_in_their_order(store: Store) -> None:
    run, made = learned(store, 3), [record for record, _ in learning_steps(3)]
    told = store.learning.tries(run.id)
    assert [one.step for one in told] == [1, 2, 3]
    assert [one.call for one in told] == [record.execution.call for record in made]
    assert [one.moved for one in told] == [record.affordance is not None for record in made]
    for one, record in zip(told, made, strict=True):
        assert one.at == record.start.object_position
        assert one.offset == (record.start.wrist_to_object_x, record.start.wrist_to_object_y)
        off = (record.end.object_x - one.at.x, record.end.object_y - one.at.y)
        assert (one.seen.dx, one.seen.dy) == off
