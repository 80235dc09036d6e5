"""``affcli table list`` and ``show``: rows chosen and looked at."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from rich.cells import cell_len

from affcli.core.behavior import LONGEST_NAME
from affcli.core.observation import Observation
from affcli.core.tool import ToolName
from affcli.errors import one_line
from affcli.simulation.tools.paper import TOOL_PARTS
from tests.cli.program import affcli, done, names_in, refused, rows
from tests.cli.table_rows import EVIL, listed, tamper, vary_counters

Row = dict[str, Any]


def test_rows_are_those_of_the_latest_finished_run_of_each_tool(
    learned: Path, impatient: Path
) -> None:
    """A newer run takes the place of the one before; an unfinished one does not."""
    ids = [
        one for (one,) in rows(learned, "SELECT id FROM affordance ORDER BY learning_run_id, id")
    ]
    assert [row["id"] for row in listed(learned)] == ids
    learn = ("learn", "--tool", "stick", "--behaviors", "400", "--config", impatient)
    for seed in ("1", "2"):
        done(*learn, "--seed", seed, "--db", learned)
    tamper(learned, "UPDATE learning_run SET status = 'running' WHERE id = 4")
    assert {row["run"] for row in listed(learned)} == {1, 3}
    assert {row["run"] for row in listed(learned, "--tool", "stick")} == {3}
    assert {row["run"] for row in listed(learned, "--tool", "t-hook")} == {1}
    assert {row["run"] for row in listed(learned, "--run", "2")} == {2}
    assert {row["run"] for row in listed(learned, "--run", "4")} == {4}
    assert {row["run"] for row in listed(learned, "--all-runs")} == {1, 2, 3, 4}
    assert {row["run"] for row in listed(learned, "--all-runs", "--tool", "stick")} == {2, 3, 4}


def test_a_row_says_what_was_learned(learned: Path) -> None:
    found = {row["id"]: row for row in listed(learned, "--run", "1")}
    query = "SELECT * FROM affordance_wide WHERE run = 1 ORDER BY id"
    wide = done("sql", query, "--json", "--db", learned).results
    assert list(found) == [row["id"] for row in wide]
    for row in wide:
        listed_row = found[row["id"]]
        for name in ("run", "step", "tool", "direction", "times_used", "times_successful"):
            assert listed_row[name] == row[name]
        assert listed_row["from_wrist"] == [
            row["start_wrist_to_object_x"],
            row["start_wrist_to_object_y"],
        ]
        assert listed_row["expected"] == [row["expected_dx"], row["expected_dy"]]
        assert math.isclose(listed_row["movement"], row["movement"])
        assert listed_row["behavior"] == row["exploratory_behavior"]
        assert listed_row["region"] in TOOL_PARTS[row["tool"]]
        assert listed_row["excluded"] is (row["replication_probability"] <= 0.5)
    assert {row["region"] for row in found.values()} == set(TOOL_PARTS[ToolName("t-hook")])


def between(low: float, high: float) -> Callable[[float], bool]:
    return lambda value: low <= value <= high


PROBABILITIES: dict[str, Callable[[float], bool]] = {
    "<=0.5": lambda p: p <= 0.5,
    "<0.5": lambda p: p < 0.5,
    ">0.5": lambda p: p > 0.5,
    ">=.5": lambda p: p >= 0.5,
    " > 0.5 ": lambda p: p > 0.5,
    "0.2..0.8": between(0.2, 0.8),
    "0.5 .. 0.5": between(0.5, 0.5),
    "0..1": between(0, 1),
    "<0": between(1, 0),
}


@pytest.mark.parametrize("text", PROBABILITIES)
def test_rows_are_chosen_by_their_probability(text: str, learned: Path) -> None:
    vary_counters(learned)
    every = listed(learned)
    wanted = [row for row in every if PROBABILITIES[text](row["replication_probability"])]
    assert listed(learned, "--probability", text) == wanted
    assert len(wanted) < len(every) or text == "0..1"
    assert wanted or text == "<0"


@pytest.mark.parametrize(("name", "inches"), [("extend arm", ""), ("slide arm left", " 5")])
def test_rows_are_chosen_by_behavior(name: str, inches: str, learned: Path) -> None:
    wanted = [
        row
        for row in listed(learned)
        if row["behavior"] == name
        and (not inches or row["params"] == {"offset_distance": float(inches)})
    ]
    assert wanted or name == "contract arm"
    assert listed(learned, "--behavior", f"{name}{inches}") == wanted


def test_filters_go_together(learned: Path) -> None:
    vary_counters(learned)
    every = listed(learned, "--all-runs")
    args = ("--tool", "t-hook", "--region", "left hook", "--probability", ">0.3")
    wanted = [
        row
        for row in every
        if row["tool"] == "t-hook"
        and row["region"] == "left hook"
        and row["replication_probability"] > 0.3
    ]
    assert len(wanted) > 3
    assert listed(learned, *args) == wanted
    assert listed(learned, *args, "--limit", "2") == wanted[:2]
    slid = [row for row in wanted if row["behavior"] == "slide arm right"]
    assert slid
    assert listed(learned, *args, "--behavior", "slide arm right") == slid
    assert listed(learned, "--limit", "5", "--all-runs") == every[:5]


def test_the_table_says_the_same_and_fits(learned: Path) -> None:
    found = listed(learned)
    for columns in (80, 40):
        out = done("table", "list", "--db", learned, COLUMNS=str(columns)).out
        lines = out.splitlines()
        assert max(map(cell_len, lines)) <= columns
        assert lines[0] == "Rows of run 1 (t-hook), run 2 (stick)"[:columns]
        if columns == 80:
            body = [line.split() for line in lines[3 : 3 + len(found)]]
            assert [line[0] for line in body] == [str(row["id"]) for row in found]
            assert [line[-3] for line in body] == [f"{row['movement']:.1f}" for row in found]
        else:
            assert out.count("\nregion ") == len(found)


def test_rows_of_robots_of_a_reproduction_are_asked_for(reproduced: Path) -> None:
    line = refused(2, "table", "list", "--db", reproduced)
    assert "but by robots of a reproduction; give --run ID or --all-runs" in line
    line = refused(2, "table", "list", "--tool", "stick", "--db", reproduced)
    assert "nothing learned with the stick in " in line
    every = listed(reproduced, "--all-runs")
    assert [row["id"] for row in every] == [
        one for (one,) in rows(reproduced, "SELECT id FROM affordance ORDER BY id")
    ]
    ((run, tool),) = rows(reproduced, "SELECT id, tool FROM learning_run WHERE id = 7")
    assert listed(reproduced, "--run", "7") == [row for row in every if row["run"] == run]
    assert listed(reproduced, "--run", "7", "--tool", tool) == listed(reproduced, "--run", "7")


def test_no_rows_are_said_to_be_none(learned: Path) -> None:
    none = ("--probability", "<=0.5", "--db", learned)
    ended = done("table", "list", *none)
    assert ended.out.startswith("Rows of run 1 (t-hook), run 2 (stick)\nid  tool ")
    assert ended.err == "no rows\n"
    ended = done("table", "list", *none, "--json")
    assert (ended.results, ended.err) == ([], "no rows\n")


@pytest.mark.parametrize("command", [("list",), ("list", "--all-runs"), ("export",)])
def test_where_nothing_was_learned_it_says_how_to(command: tuple[str, ...], empty: Path) -> None:
    line = refused(2, "table", *command, "--db", empty)
    assert f"nothing learned with the tools in {empty}; first run: affcli learn --tool " in line
    line = refused(2, "table", *command, "--tool", "stick", "--db", empty)
    assert "first run: affcli learn --tool stick" in line


def test_a_row_that_is_not_there_is_named(empty: Path, learned: Path) -> None:
    assert "no affordance 1; there are none yet" in refused(2, "table", "show", "1", "--db", empty)
    assert "no learning run 1; there are none yet" in refused(
        2, "table", "list", "--run", "1", "--db", empty
    )
    ((last,),) = rows(learned, "SELECT max(id) FROM affordance")
    for row_id in (str(last + 1), str(2**63 - 1)):
        line = refused(2, "table", "show", row_id, "--db", learned)
        assert line.endswith(f"no affordance {row_id}; they are numbered 1 to {last}")


@pytest.mark.parametrize("number", ["0", "9223372036854775808", "-9223372036854775809"])
def test_numbers_that_no_record_has_are_bad_input(number: str, learned: Path) -> None:
    for option in ("--run", "--limit"):
        for command in ("list", "export"):
            line = refused(4, "table", command, option, number, "--db", learned)
            assert f"{option} {number}: must lie in 1 to 9223372036854775807" in line
    line = refused(4, "table", "show", "--db", learned, "--", number)
    assert f"row {number}: must lie in 1 to 9223372036854775807" in line


USAGE: dict[str, tuple[tuple[str, ...], str]] = {
    "unknown tool": (("--tool", "t-hok"), "no tool 't-hok'; did you mean t-hook"),
    "unknown behavior": (("--behavior", "push"), "no behavior 'push'; did you mean "),
    "unknown distance": (
        ("--behavior", "extend arm 3"),
        "no behavior 'extend arm 3'; did you mean extend arm",
    ),
    "a behavior without rows": (("--behavior", "position wrist"), "no behavior 'position wrist'"),
    "unknown region": (
        ("--region", "hook", "--tool", "t-hook"),
        "no region 'hook' of the t-hook; the parts are handle, left bar, right bar, left hook, ",
    ),
    "a region of another tool": (
        ("--region", "right hook", "--run", "2"),
        "no region 'right hook' of the stick; the parts are handle",
    ),
    "an escape sequence as region": (
        ("--region", "\x1b[31m"),
        r"no region '\\x1b[31m' of the stick, t-hook; the parts are handle, left bar, ",
    ),
    "unknown run": (("--run", "3"), "no learning run 3; they are numbered 1 to 2"),
    "a run of another tool": (
        ("--run", "1", "--tool", "stick"),
        "run 1 is of the t-hook, not of the stick; leave out --tool",
    ),
    "a run and all runs": (("--run", "1", "--all-runs"), "give --run ID or --all-runs, not both"),
    "run in words": (("--run", "first"), "--run "),
    "limit in words": (("--limit", "few"), "--limit "),
}
PROBABLY_WRONG = (
    *("", "0.5", "=0.5", "==0.5", "=>0.5", "<=", "<= half", "<=0.5>", "<=1.1", "<-0.1", ">1.5"),
    *("0.8..0.2", "0.2..1.2", "0.2...0.8", "0.2..", "..0.8", "0.2-0.8", "nan..1", "<inf", "<1e-1"),
    *("<0.5\n", "<\u0665", "<=0,5", "x'); DROP TABLE affordance; --", "\x1b[31m", "<" * 10_000),
)


@pytest.mark.parametrize(("args", "says"), USAGE.values(), ids=USAGE.keys())
def test_what_does_not_exist_is_a_usage_error(
    args: tuple[str, ...], says: str, learned: Path
) -> None:
    for command in ("list", "export"):
        assert says in refused(2, "table", command, *args, "--db", learned)


@pytest.mark.parametrize("text", PROBABLY_WRONG)
def test_a_probability_that_is_none_is_bad_input(text: str, learned: Path) -> None:
    if text == "<0.5\n":  # blanks around are no matter
        assert listed(learned, "--probability", text) == []
        return
    line = refused(4, "table", "list", "--probability", text, "--db", learned)
    assert "--probability " in line
    assert "must be like <=0.5, <0.5, >=0.5, >0.5 or 0.2..0.8, with numbers from 0 to 1" in line


def most_tried(database: Path) -> int:
    """Return the row that was tried most often."""
    ((row, _),) = rows(
        database, "SELECT affordance_id, count(*) n FROM step GROUP BY 1 ORDER BY n DESC LIMIT 1"
    )
    return int(row)


def test_a_row_is_shown_in_full(used: Path) -> None:
    row_id = most_tried(used)
    shown = done("table", "show", str(row_id), "--json", "--db", used).result
    (as_listed,) = [row for row in listed(used) if row["id"] == row_id]
    assert shown.items() >= as_listed.items()
    query = f"SELECT * FROM affordance_wide WHERE id = {row_id}"
    (wide,) = done("sql", query, "--json", "--db", used).results
    for moment in ("start", "end"):
        assert shown[moment] == {name: wide[f"{moment}_{name}"] for name in Observation._fields}
    assert shown["binding"] == {"behavior": "grasp", "params": {"grasp_point": 1.0}}
    assert shown["learned"] == {"session": None, "seed": 0, "robot": 0}


def test_the_history_of_a_row_is_every_step_that_tried_it(used: Path) -> None:
    row_id = most_tried(used)
    shown = done("table", "show", str(row_id), "--json", "--db", used).result
    query = f"""SELECT trial_id AS trial, protocol, shape, goal, start, counters, number AS step,
        planner, reasons, regrasped, placing_status, status,
        expected_dx, expected_dy, seen_dx, seen_dy, replicated,
        times_successful_before, times_used_before, times_successful_after, times_used_after,
        died AS excluded, lost
        FROM step JOIN trial ON trial.id = trial_id WHERE affordance_id = {row_id}
        ORDER BY trial_id, number"""
    stored = done("sql", query, "--json", "--db", used).results
    for step in stored:
        step["expected"] = [step.pop("expected_dx"), step.pop("expected_dy")]
        step["seen"] = [step.pop("seen_dx"), step.pop("seen_dy")]
        step["reasons"] = json.loads(step["reasons"])
    assert shown["history"] == stored
    assert len(stored) > 2
    protocols = {step["protocol"] for step in stored}
    assert protocols <= {"extension of reach", "tool adaptation"}
    out = done("table", "show", str(row_id), "--db", used, COLUMNS="120").out
    assert f"\nTried {len(stored)} times\n" in out
    body = out.split("─\n")[-1].splitlines()
    last = stored[-1]
    assert body[len(stored) - 1].split()[:3] == [
        str(last["trial"]),
        last["shape"],
        str(last["step"]),
    ]


def test_the_tries_of_a_verification_explain_the_counters_too(used: Path) -> None:
    """`verify --update` changes stored counters: what changed them stands beside the steps."""
    done("verify", "--tool", "t-hook", "--shape", "stick", "--rows", "30", "--update", "--db", used)
    query = """SELECT affordance_id, number, replicated FROM replication ORDER BY number"""
    for row_id, number, replicated in rows(used, query):
        shown = done("table", "show", str(row_id), "--json", "--db", used).result
        (tried,) = shown["verifications"]
        assert (tried["number"], tried["shape"]) == (number, "stick")
        assert tried["replicated"] == bool(replicated)
        assert tried["after"] == [shown["times_successful"], shown["times_used"]]
    out = done("table", "show", str(row_id), "--db", used).out
    assert "\nTried by verify --update 1 time\n" in out


def test_a_row_names_its_components_as_the_paper_does(used: Path) -> None:
    out = done("table", "show", "1", "--db", used).out
    ((seen,),) = rows(used, "SELECT start_wrist_to_object_y FROM affordance WHERE id = 1")
    lines = {line.split()[0]: line for line in out.splitlines() if line}
    assert [f"o{n}" in lines for n in range(14)] == [False, *[True] * 12, False]
    assert f"{seen:.2f}" in lines["o5"]
    assert lines["o5"].startswith("o5         wrist to object y ")
    assert "step " in lines["learned"]
    assert " of run 1 (seed 0)" in lines["learned"]


def test_a_row_of_a_robot_says_whose_it_is(reproduced: Path) -> None:
    ((row_id, run, robot),) = rows(
        reproduced,
        """SELECT a.id, r.id, robot FROM affordance a JOIN learning_run r
        ON r.id = learning_run_id WHERE robot = 1 LIMIT 1""",
    )
    out = done("table", "show", str(row_id), "--db", reproduced).out
    assert f" of run {run} (seed 0, robot {robot} of session 1)" in out


@pytest.mark.parametrize("columns", [80, 40])
def test_a_row_fits_the_screen(columns: int, used: Path) -> None:
    out = done("table", "show", str(most_tried(used)), "--db", used, COLUMNS=str(columns)).out
    assert max(map(cell_len, out.splitlines())) <= columns


def test_an_excluded_row_is_said_to_be(learned: Path) -> None:
    tamper(learned, "UPDATE affordance SET times_used = 4, times_successful = 2 WHERE id = 1")
    shown = done("table", "show", "1", "--db", learned).out
    assert "successes/uses        2/4, probability 0.5 " in shown
    assert "excluded              yes, at 1/2 or less" in shown
    assert "No stored trial tried it." in shown
    assert [row["id"] for row in listed(learned, "--probability", "<=0.5")] == [1]


SHOWING = (("list", "--all-runs"), ("show", "1"))
WORDS = {
    "affordance": ("tool", "exploratory_behavior", "binding_behavior"),
    "step": ("placing_status", "status"),
    "learning_run": ("started_at",),
}


@pytest.mark.fault(21)
@pytest.mark.parametrize("text", EVIL.values(), ids=EVIL.keys())
def test_whatever_words_stand_in_the_database_they_command_nothing(text: str, used: Path) -> None:
    for table, columns in WORDS.items():
        for column in columns:
            tamper(used, f"UPDATE {table} SET {column} = ?", text)
    tamper(used, "UPDATE trial SET shape = ? || id", text)
    row_id = str(most_tried(used))
    if len(text) > LONGEST_NAME:
        line = refused(3, "table", "list", "--db", used)
        assert "holds a value that affcli did not write; restore a copy" in line
        return
    for args in (("list", "--all-runs", "--limit", "5"), ("show", row_id)):
        for width in ("80", "40"):
            ended = done("table", *args, "--db", used, COLUMNS=width)
            assert all(line.isprintable() for line in ended.out.splitlines())
        assert done("table", *args, "--json", "--db", used).results
    for words in (("list",), ("show", "1")):
        shown = done("runs", *words, "--db", used, COLUMNS="40").out
        assert all(line.isprintable() for line in shown.splitlines())
    (first, *_) = listed(used, "--all-runs")
    assert (first["tool"], first["behavior"]) == (one_line(text, 20_000),) * 2
    assert rows(used, "SELECT count(*) FROM affordance") != [(0,)]


def test_text_that_is_none_is_named(learned: Path) -> None:
    tamper(learned, "UPDATE affordance SET tool = CAST(x'ff' AS TEXT)")
    for args in SHOWING:
        line = refused(3, "table", *args, "--db", learned)
        assert "holds text that is none and that affcli did not write; restore a copy" in line


def test_reading_changes_nothing(used: Path) -> None:
    before = used.read_bytes()
    for args in (*SHOWING, ("export",), ("export", "--what", "steps")):
        done("table", *args, "--db", used)
    assert used.read_bytes() == before
    assert names_in(used.parent) == [used.name]


def test_without_a_command_it_says_which_there_are(tmp_path: Path) -> None:
    ended = affcli("table", cwd=tmp_path)
    assert (ended.code, ended.err) == (0, "")
    assert [line.split()[0] for line in ended.out.split("Commands:\n")[1].splitlines()] == [
        "list",
        "show",
        "export",
    ]
