"""What stands in a database though affcli did not write it is named in one line (3, 4)."""

import json
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from tests.cli.program import affcli, done, refused
from tests.fuzz.places import interrupt

NOT_OURS = "holds a value that affcli did not write"
READING = (
    ("report",),
    ("table", "show", "1"),
    ("sql", "select 1"),
    ("solve", "--goal", "1", "--start", "1"),
    ("db", "check"),
    ("learn", "--tool", "stick", "--behaviors", "5"),
)


def written(database: Path, *statements: str) -> None:
    """Write into a database as anybody can."""
    with closing(sqlite3.connect(database, isolation_level=None)) as driver:
        driver.execute("PRAGMA ignore_check_constraints = ON")
        driver.execute("PRAGMA writable_schema = ON")
        for statement in statements:
            driver.execute(statement)


@pytest.mark.parametrize("args", READING, ids=" ".join)
@pytest.mark.parametrize(
    ("change", "missing"),
    [
        ("ALTER TABLE learning_run RENAME COLUMN versions TO made", "learning_run.versions"),
        ("ALTER TABLE step RENAME COLUMN died TO gone", "step.died"),
        ("ALTER TABLE alembic_version RENAME COLUMN version_num TO v", "alembic_version.version"),
    ],
)
def test_a_column_that_is_missing_is_named(
    args: tuple[str, ...], change: str, missing: str, learned: Path
) -> None:
    written(learned, change)
    assert f"damaged, its {missing}" in refused(3, *args, "--db", learned)


def test_a_view_that_cannot_be_read_is_named(learned: Path) -> None:
    written(
        learned, "DROP VIEW affordance_wide", "CREATE VIEW affordance_wide AS SELECT x FROM step"
    )
    assert "its affordance_wide is missing" in refused(3, "table", "list", "--db", learned)


def test_a_table_without_its_key_is_damaged(learned: Path) -> None:
    written(
        learned,
        "CREATE TABLE kept AS SELECT * FROM affordance",
        "DROP VIEW affordance_table",
        "DROP VIEW affordance_wide",
        "DROP TABLE affordance",
        "ALTER TABLE kept RENAME TO affordance",
        "CREATE VIEW affordance_table AS SELECT *, learning_run_id AS run FROM affordance",
        "CREATE VIEW affordance_wide AS SELECT *, learning_run_id AS run, "
        "1.0 AS replication_probability FROM affordance",
    )
    assert "damaged" in refused(3, "db", "check", "--db", learned)


LOOSE = "UPDATE sqlite_master SET sql = replace(replace(sql, 'STRICT', ''), ' NOT NULL', '')"


@pytest.mark.parametrize("args", READING, ids=" ".join)
@pytest.mark.parametrize("value", ["'many'", "NULL", "x'00'", "1.5"])
def test_a_table_of_another_program_holds_what_affcli_would(
    args: tuple[str, ...], value: str, learned: Path
) -> None:
    written(learned, f"{LOOSE} WHERE name = 'learning_run'")
    done("report", "--db", learned)
    written(learned, f"UPDATE learning_run SET behaviors = {value}")
    says = f"its learning_run {NOT_OURS}"
    assert says in refused(3, *args, "--db", learned)


def test_records_that_contradict_one_another_are_told(used: Path) -> None:
    """The next session takes the number of one that is gone, whose trials are still there."""
    written(used, "DELETE FROM session")
    line = refused(3, "break-tool", "--db", used)
    assert "UNIQUE constraint failed" in line
    assert "its records contradict one another" in line


USING = (
    ("solve", "--goal", "1", "--start", "1", "--tool", "t-hook"),
    ("verify",),
    ("predict",),
    ("break-tool",),
)


@pytest.mark.parametrize("args", USING, ids=" ".join)
@pytest.mark.parametrize(
    "change",
    [
        "exploratory_behavior = 'juggle'",
        "exploratory_behavior = 'position wrist'",
        "exploratory_params = '{}'",
        f"""exploratory_params = '{{"offset_distance": {"[" * 9_000}'""",
        """exploratory_params = '{"offset_distance": 1e300}'""",
        "start_object_x = 1e300",
        "end_object_y = 9e999",
    ],
)
def test_a_row_that_no_robot_can_try_is_not_tried(
    args: tuple[str, ...], change: str, learned: Path
) -> None:
    written(learned, f"UPDATE affordance SET {change}")
    assert NOT_OURS in refused(3, *args, "--db", learned)


@pytest.mark.parametrize("counters", [(2**62, 2**62), (2**41, 1)])
def test_counters_that_no_uses_can_give_are_not_counted_on(
    counters: tuple[int, int], learned: Path
) -> None:
    used, successful = counters
    written(learned, f"UPDATE affordance SET times_used = {used}, times_successful = {successful}")
    assert NOT_OURS in refused(3, "solve", "--goal", "1", "--db", learned)


def test_a_row_without_its_behavior_cannot_be_told_lost(learned: Path) -> None:
    written(learned, "DELETE FROM behavior")
    assert NOT_OURS in refused(3, "break-tool", "--db", learned)


@pytest.mark.parametrize("change", ["robots = 9223372036854775807", "seed = -1"])
def test_a_reproduction_of_more_robots_than_there_can_be_is_not_gone_on_with(
    change: str, reproduced: Path
) -> None:
    written(reproduced, f"UPDATE session SET {change}, status = 'running'")
    for args in (("report",), ("reproduce", "--resume")):
        assert NOT_OURS in refused(3, *args, "--db", reproduced)


@pytest.mark.parametrize(
    ("place", "value"),
    [
        *(("clock", 1e9), ("clock", "x"), ("step", 30), ("step", 3), ("grasped", 2)),
        *(("seen", [1.0]), ("seen", ["x"] * 12), ("wrist", [1e300, 0.0]), ("wrist", None)),
        *(("attractor", [0.0, 9e999, 0.0]), ("streams", {}), ("streams", [])),
        ("streams", {name: {"state": 1} for name in ("choices", "noise", "hand")}),
    ],
)
def test_a_run_does_not_go_on_from_where_it_cannot_have_been(
    place: str, value: object, learned: Path, leisurely: Path
) -> None:
    (learned.parent / "settings.toml").write_text(leisurely.read_text())
    interrupt(learned)
    with closing(sqlite3.connect(learned)) as driver, driver:
        wanted = "SELECT checkpoint FROM learning_run WHERE status = 'running'"
        ((text,),) = driver.execute(wanted).fetchall()
        changed = json.dumps({**json.loads(text), place: value})
        driver.execute(
            "UPDATE learning_run SET checkpoint = ? WHERE status = 'running'", (changed,)
        )
    assert f"learning run 3 {NOT_OURS}" in refused(3, "learn", "--resume", "--db", learned)


@pytest.mark.parametrize(
    "change",
    [
        *("checkpoint = NULL", "checkpoint = '[]'", "hours = 1e300, behaviors_limit = NULL"),
        *("behaviors_limit = 9223372036854775807", "behaviors_limit = 20", "robot = -1"),
    ],
)
def test_a_run_that_would_never_end_is_not_gone_on_with(
    change: str, learned: Path, leisurely: Path
) -> None:
    (learned.parent / "settings.toml").write_text(leisurely.read_text())
    interrupt(learned)
    written(learned, f"UPDATE learning_run SET {change} WHERE status = 'running'")
    assert f"learning run 3 {NOT_OURS}" in refused(3, "learn", "--resume", "--db", learned)


def test_an_interrupted_run_goes_on(learned: Path, leisurely: Path) -> None:
    (learned.parent / "settings.toml").write_text(leisurely.read_text())
    interrupt(learned)
    assert affcli("learn", "--resume", "--db", learned).code == 0
