"""The two views that are public interface, and the schema behind them."""

import sqlite3
from dataclasses import replace
from pathlib import Path

import pytest

from affcli.behaviors.moving import SLIDE_ARM_LEFT
from affcli.core.behavior import BehaviorCall, ExecutionStatus
from affcli.core.observation import Observation
from affcli.store import Store, run_sql
from affcli.store.database_file import APPLICATION_ID, RELATIONS
from affcli.store.migrate import migrations_folder
from affcli.store.tables import TABLES as BY_NAME
from tests.factories import BINDING, learning_spec
from tests.store.records import NOW, VERSIONS, learning_step

TABLES = BY_NAME.values()
START = Observation(5.744, 29.475, 0.0, -3.326, 16.392, 0.0, 241.4, 120.5, 16.1, 196.5, 39.0, 38.2)
END = Observation(2.744, 33.475, 0.0, -0.004, 16.9, 0.0, 241.8, 120.1, 18.6, 203.0, 38.5, 37.1)


@pytest.fixture
def row(store: Store) -> Store:
    """A store with one row, tried four times and successful in three of them."""
    call = BehaviorCall.of(SLIDE_ARM_LEFT, {"offset_distance": 5.0})
    record, truth = learning_step(7, moved=(0.0, 4.0))
    execution = replace(record.execution, call=call, status=ExecutionStatus.TRUNCATED)
    assert record.affordance is not None
    affordance = replace(
        record.affordance,
        exploratory=call,
        binding=BehaviorCall.of(BINDING.name, {"grasp_point": 1.5, "turn": -20.0}),
        start=START,
        end=END,
        truncated=True,
        times_used=4,
        times_successful=3,
    )
    step = replace(record, execution=execution, start=START, end=END, affordance=affordance)
    run = store.learning.begin(learning_spec(), VERSIONS, NOW)
    store.learning.append(run.id, 0, [(step, truth)], {}, 1.0, done=True, now=NOW)
    return store


def test_affordance_table_has_the_papers_eight_columns_readable(row: Store) -> None:
    result = run_sql(row.path, "SELECT * FROM affordance_table")
    (values,) = result.rows
    assert dict(zip(result.columns, values, strict=True)) == {
        "id": 1,
        "run": 1,
        "tool": "t-hook",
        "binding_behavior": "grasp",
        "binding_params": "grasp_point=1.5, turn=-20",
        "exploratory_behavior": "slide arm left",
        "exploratory_params": "offset_distance=5",
        "start_observation": "object (5.74, 29.48, 0.00) from wrist (-3.33, 16.39, 0.00)"
        " object rgb (241, 121, 16) tool rgb (197, 39, 38)",
        "end_observation": "object (2.74, 33.48, 0.00) from wrist (0.00, 16.90, 0.00)"
        " object rgb (242, 120, 19) tool rgb (203, 39, 37)",
        "times_used": 4,
        "times_successful": 3,
        "replication_probability": 0.75,
        "movement": pytest.approx(5.0),
        "direction": pytest.approx(126.8699, abs=1e-4),
        "truncated": 1,
    }


def test_affordance_wide_has_every_component_in_a_column(row: Store) -> None:
    result = run_sql(row.path, "SELECT * FROM affordance_wide")
    (values,) = result.rows
    wide = dict(zip(result.columns, values, strict=True))
    for prefix, seen in (("start", START), ("end", END)):
        for name, component in seen._asdict().items():
            assert wide.pop(f"{prefix}_{name}") == component
    assert wide == {
        "id": 1,
        "run": 1,
        "step": 7,
        "tool": "t-hook",
        "binding_behavior": "grasp",
        "binding_params": '{"grasp_point": 1.5, "turn": -20.0}',
        "exploratory_behavior": "slide arm left",
        "exploratory_params": '{"offset_distance": 5.0}',
        "expected_dx": pytest.approx(-3.0),
        "expected_dy": pytest.approx(4.0),
        "movement": pytest.approx(5.0),
        "direction": pytest.approx(126.8699, abs=1e-4),
        "times_used": 4,
        "times_successful": 3,
        "replication_probability": 0.75,
        "truncated": 1,
        "wrist_angle": 0.25,
        "travel_x": 0.0,
        "travel_y": 5.0,
    }


def test_the_schema_is_what_the_code_expects(empty_database: Path) -> None:
    driver = sqlite3.connect(empty_database)
    for table in TABLES:
        columns = [name for _, name, *_ in driver.execute(f"PRAGMA table_info({table.name})")]
        assert sorted(columns) == sorted(column.name for column in table.columns)
    tables = {
        name for (name,) in driver.execute("SELECT name FROM sqlite_master WHERE type = 'table'")
    }
    views = {
        name for (name,) in driver.execute("SELECT name FROM sqlite_master WHERE type = 'view'")
    }
    assert tables == {table.name for table in TABLES} | {"alembic_version", "sqlite_sequence"}
    assert {table.name for table in TABLES} | views == RELATIONS
    assert driver.execute("PRAGMA application_id").fetchone() == (APPLICATION_ID,)
    if sqlite3.sqlite_version_info >= (3, 37):
        strict = dict(
            driver.execute("SELECT name, strict FROM pragma_table_list WHERE schema = 'main'")
        )
        assert all(strict[table.name] for table in TABLES)
    driver.close()


@pytest.mark.parametrize(("used", "successful"), [(0, 0), (1, 2), (3, -1), (-1, -1)])
def test_counters_that_cannot_be_are_refused(used: int, successful: int, row: Store) -> None:
    with (
        pytest.raises(Exception, match="CHECK constraint failed"),
        row.database.writing() as connection,
    ):
        connection.exec_driver_sql(
            f"UPDATE affordance SET times_used = {used}, times_successful = {successful}"
        )


def test_references_are_kept(row: Store) -> None:
    with pytest.raises(Exception, match="FOREIGN KEY"), row.database.writing() as connection:
        connection.exec_driver_sql("DELETE FROM learning_run")


def test_the_first_migration_repeats_the_glossary() -> None:
    """A migration must not import what may change, so it spells the observation vector itself."""
    text = (migrations_folder() / "versions" / "0001_first_schema.py").read_text()
    assert "from affcli" not in text
