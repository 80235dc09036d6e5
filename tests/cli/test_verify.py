"""``affcli verify``: the verdict, what is written and what is not, and what stops it."""

import signal
import sqlite3
import time
from contextlib import closing
from pathlib import Path

import pytest

from affcli.simulation.tools.paper import TOOL_PARTS
from tests.cli.program import (
    affcli,
    contents,
    done,
    ending,
    refused,
    rows,
    side_by_side,
    started,
    wait_until,
)

USES = "SELECT sum(times_used - 1), sum(times_successful - 1) FROM affordance"
TRIES = "SELECT count(*), sum(replicated) FROM replication"


def verify(database: Path, *more: str | Path) -> tuple[str | Path, ...]:
    return ("verify", *more, "--db", database)


def tries(database: Path) -> int:
    """Return how many tries are saved."""
    ((count,),) = rows(database, "SELECT count(*) FROM replication")
    return int(count)


def test_an_intact_tool_is_found_intact_and_nothing_is_written(learned: Path) -> None:
    before = learned.read_bytes()
    ended = done(*verify(learned))
    assert ended.err == ""
    assert ended.out.startswith("Run 1, t-hook: table holds: ")
    assert "stored table left as it is" in ended.out
    value = done(*verify(learned, "--json")).result
    ((in_table,),) = rows(learned, "SELECT rows FROM learning_run WHERE tool = 't-hook'")
    assert value["tries"] == value["rows"] == in_table
    assert (value["verdict"], value["updated"], value["shape"]) == ("table holds", False, "t-hook")
    assert learned.read_bytes() == before


def test_a_broken_tool_is_found_out_with_the_rows_and_the_region(learned: Path) -> None:
    value = done(*verify(learned, "--shape", "l-hook", "--json")).result
    assert value["verdict"] == "tool has changed"
    assert value["decided_after"] < 60
    assert len(value["drifted"]) == value["of_live_rows"]["failed"] > 20
    share = {one["what"]: one["replicated"] / one["tries"] for one in value["by_region"]}
    assert share["left hook"] > 0.9
    assert share["right hook"] < 0.6
    assert set(share) == set(TOOL_PARTS[next(t for t in TOOL_PARTS if t == "t-hook")])
    for group in ("by_behavior", "by_region"):
        assert sum(one["tries"] for one in value[group]) == value["tries"]
        for one in value[group]:
            assert 0 <= one["low"] <= one["replicated"] / one["tries"] <= one["high"] <= 1
    known = {row for (row,) in rows(learned, "SELECT id FROM affordance")}
    assert {row["row"] for row in value["drifted"]} <= known


def test_it_stops_as_soon_as_it_can_be_told(learned: Path) -> None:
    value = done(*verify(learned, "--shape", "l-hook", "--until-verdict", "--json")).result
    assert value["tries"] == value["decided_after"] < 60


def test_more_tries_than_rows_go_round_again(learned: Path) -> None:
    value = done(*verify(learned, "--tool", "stick", "--rows", "400", "--json")).result
    assert value["tries"] == 400 > value["rows"]
    assert value["verdict"] == "table holds"
    few = done(*verify(learned, "--tool", "stick", "--rows", "3")).out
    assert "undecided: 3 tries were too few (0 failed)" in few


def test_the_same_seed_says_the_same_and_another_something_else(learned: Path) -> None:
    args = verify(learned, "--shape", "l-hook", "--rows", "30", "--json")
    assert done(*args).result == done(*args).result
    assert done(*args).result["drifted"] != done(*args, "--seed", "3").result["drifted"]


def test_update_counts_the_tries_in_the_stored_table(learned: Path) -> None:
    value = done(*verify(learned, "--shape", "l-hook", "--rows", "70", "--update", "--json")).result
    assert value["updated"]
    assert rows(learned, USES) == rows(learned, TRIES)
    assert tries(learned) == value["tries"] == 70
    kept = "SELECT verdict, tries, decided_after, robot_seconds, shape, seed FROM verification"
    told = (value["verdict"], 70, value["decided_after"], value["robot_seconds"], "l-hook", 0)
    assert rows(learned, kept) == [told]
    dead = "SELECT count(*) FROM affordance WHERE 2 * times_successful <= times_used"
    ((excluded,),) = rows(learned, dead)
    assert excluded == value["of_live_rows"]["failed"]
    again = done(*verify(learned, "--shape", "l-hook", "--json")).result
    assert again["of_excluded_rows"]["tries"] == excluded
    done("db", "check", "--db", learned)


def test_a_trial_and_a_verification_share_the_counters(learned: Path) -> None:
    done("solve", "--goal", "2", "--tool", "t-hook", "--db", learned)
    done(*verify(learned, "--update", "--rows", "30"))
    done("solve", "--goal", "3", "--tool", "t-hook", "--db", learned)
    ((last,),) = rows(learned, "SELECT max(id) FROM trial WHERE goal = 2")
    assert rows(learned, "SELECT after_trial FROM verification") == [(last,)]
    ((steps, good), (more, too)) = (
        rows(learned, "SELECT count(*), sum(replicated) FROM step")[0],
        rows(learned, TRIES)[0],
    )
    assert rows(learned, USES) == [(steps + more, good + too)]
    done("db", "check", "--db", learned)


def test_updates_of_two_copies_are_the_same(learned: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.db"
    copy.write_bytes(learned.read_bytes())
    for database in (learned, copy):
        done(*verify(database, "--update", "--rows", "25", "--seed", "4"))
    assert contents(learned) == contents(copy)


@pytest.mark.parametrize("columns", ["80", "40"])
def test_it_fits_the_screen(columns: str, learned: Path) -> None:
    out = done(*verify(learned, "--shape", "l-hook"), COLUMNS=columns, NO_COLOR="1").out
    assert max(map(len, out.splitlines())) <= int(columns)
    assert "\x1b" not in out


def test_without_a_finished_run_it_says_what_to_do_first(learned: Path, empty: Path) -> None:
    for database, tool in ((empty, "t-hook"), (learned, "l-stick")):
        before = database.read_bytes()
        line = refused(2, *verify(database, "--tool", tool))
        assert f"nothing learned with the {tool}" in line
        assert f"affcli learn --tool {tool} --db {database}" in line
        assert refused(2, *verify(database, "--tool", tool, "--update")) == line
        assert database.read_bytes() == before


def test_a_missing_database_is_not_made(tmp_path: Path) -> None:
    for more in ((), ("--update",)):
        assert "no database there" in refused(3, *verify(tmp_path / "no.db", *more))
    assert list(tmp_path.iterdir()) == []


def test_a_table_without_rows_has_nothing_to_verify(empty: Path) -> None:
    done("learn", "--tool", "stick", "--behaviors", "1", "--seed", "1", "--db", empty)
    assert rows(empty, "SELECT rows FROM learning_run") == [(0,)]
    before = empty.read_bytes()
    for more in ((), ("--update",)):
        line = refused(2, *verify(empty, "--tool", "stick", *more))
        assert "run 1 of the stick made no rows" in line
    assert empty.read_bytes() == before


def test_a_table_learned_through_wild_noise_is_bad_input_that_names_the_row(
    tmp_path: Path,
) -> None:
    """What was seen then is no place the arm can take up."""
    config, database = tmp_path / "wild.toml", tmp_path / "wild.db"
    config.write_text("[sensor]\nposition_noise = 9.0\n")
    done("learn", "--tool", "stick", "--behaviors", "40", "--config", config, "--db", database)
    line = refused(4, *verify(database, "--tool", "stick"))
    assert "lower sensor.position_noise and learn again" in line


def test_a_table_can_be_verified_while_another_process_writes(learned: Path) -> None:
    with closing(sqlite3.connect(learned, isolation_level=None)) as driver:
        driver.execute("BEGIN IMMEDIATE")
        value = done(*verify(learned, "--rows", "5", "--json")).result
        assert value["tries"] == 5


def is_locked(database: Path) -> bool:
    """Whether somebody writes into the database."""
    with closing(sqlite3.connect(database, timeout=0.0, isolation_level=None)) as driver:
        try:
            driver.execute("BEGIN IMMEDIATE")
        except sqlite3.OperationalError:
            return True
    return False


@pytest.mark.fault(1)
@pytest.mark.parametrize("_try", range(2))
def test_killed_while_updating_counters_and_tries_are_together(learned: Path, _try: int) -> None:
    """Whenever it is killed: the tries are saved whole, with the counters, or not at all."""
    with started(*verify(learned, "--update", "--rows", "5000")) as process:
        wait_until(lambda: is_locked(learned), process)
        time.sleep(0.3 * _try)
        process.kill()
        assert ending(process).code == -signal.SIGKILL
    assert rows(learned, "SELECT count(*) FROM verification") == [(0,)]
    assert rows(learned, USES) == [(0, 0)]
    done("db", "check", "--db", learned)
    done(*verify(learned, "--update", "--rows", "5"))
    assert rows(learned, USES) == rows(learned, TRIES)


@pytest.mark.fault(3)
def test_stopped_it_keeps_what_was_saved(learned: Path) -> None:
    done(*verify(learned, "--update", "--rows", "5"))
    with started(*verify(learned, "--update", "--rows", "5000")) as process:
        wait_until(lambda: is_locked(learned), process)
        process.send_signal(signal.SIGINT)
        ended = ending(process)
    assert (ended.code, ended.err) == (130, "affcli: stopped; what was saved is kept\n")
    assert tries(learned) == 5
    assert rows(learned, USES) == rows(learned, TRIES)
    done("db", "check", "--db", learned)


@pytest.mark.fault(6)
def test_two_at_once_take_turns(learned: Path) -> None:
    both = side_by_side(2, *verify(learned, "--update", "--rows", "40"))
    assert [ended.code for ended in both] == [0, 0]
    assert rows(learned, USES) == rows(learned, TRIES)
    done("db", "check", "--db", learned)


@pytest.mark.parametrize(
    ("args", "code", "says"),
    [
        (("--rows", "0"), 4, "--rows 0: must lie in 1 to 100000"),
        (("--rows", "-3"), 4, "--rows -3: must lie in 1 to 100000"),
        (("--rows", "1" + "0" * 30), 4, "must lie in 1 to 100000"),
        (("--rows", "many"), 2, "--rows "),
        (("--seed", "-1"), 4, "--seed -1: must lie in 0 to 2^63 - 1"),
        (("--seed", str(2**63)), 4, "must lie in 0 to 2^63 - 1"),
        (("--sensor", "eyes"), 2, "no sensor 'eyes'"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_opened(
    args: tuple[str, ...], code: int, says: str, tmp_path: Path
) -> None:
    assert says in refused(code, "verify", *args, cwd=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_all_five_tools_can_be_held(learned: Path) -> None:
    """Whatever the shape: lost parts, gained parts, all of them."""
    for shape in TOOL_PARTS:
        for tool in ("stick", "t-hook"):
            ended = affcli(*verify(learned, "--tool", tool, "--shape", str(shape), "--json"))
            assert ended.code == 0, ended
