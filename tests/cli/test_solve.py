"""``affcli solve``: trials, exit codes, what --explain says, and the counters in the store."""

import math
import shutil
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from affcli.simulation.tools.paper import TOOL_PARTS
from tests.cli.program import affcli, contents, done, refused, rows
from tests.cli.table_rows import tamper

COUNTERS = "SELECT id, times_used, times_successful FROM affordance ORDER BY id"


def test_all_starts_and_all_learned_tools_by_default(learned: Path) -> None:
    trials = done("solve", "--goal", "2", "--json", "--db", learned).results
    tools = [tool for tool in TOOL_PARTS if tool in {"stick", "t-hook"}]
    assert [(trial["tool"], trial["goal"], trial["start"]) for trial in trials] == [
        (tool, "2", start) for tool in tools for start in "1234"
    ]
    for trial in trials:
        which = {"trial", "run", "sensor", "planner", "tool", "goal", "start"}
        assert trial.keys() == {*which, "outcome", "steps", "robot_seconds"}
    columns = "learning_run_id, sensor, planner, tool, goal, start"
    stored = f"SELECT {columns}, outcome, steps, robot_seconds FROM trial ORDER BY id"
    assert [tuple(trial.values())[1:] for trial in trials] == rows(learned, stored)
    assert [trial["trial"] for trial in trials] == list(range(1, len(trials) + 1))
    assert rows(learned, "SELECT kind, status FROM session") == [("solve", "done")]


def test_the_table_says_how_each_trial_ended(learned: Path) -> None:
    ended = done("solve", "--goal", "1", "--tool", "stick", "--db", learned)
    replay = f"affcli replay 4 --db {learned}"
    saved = f"trials 1 to 4 saved; to see why each row was chosen: {replay}"
    assert ended.err.strip() == saved
    title, headings, _, *table = ended.out.splitlines()
    caption = " ".join(table[1:])
    assert title == "Goal 1: outcome (steps) by start"
    starts = [word for number in "1234" for word in ("start", number)]
    assert headings.split() == ["tool", *starts, "solved", "paper"]
    assert table[0].split()[0] == "stick"
    assert table[0].split()[-2:] == ["0/4", "0/4"]
    assert "counters of the rows used were updated" in caption


def test_a_single_start_that_fails_is_exit_1(learned: Path) -> None:
    """The stick cannot pull, so it never brings the attractor to goal 1, nearer to the robot."""
    ended = affcli("solve", "--goal", "1", "--tool", "stick", "--start", "1", "--db", learned)
    replay = f"affcli replay 1 --db {learned}"
    saved = f"trial 1 saved; to see why each row was chosen: {replay}\n"
    assert (ended.code, ended.err) == (1, saved)
    assert "0/1" in ended.out
    assert done("solve", "--goal", "1", "--tool", "stick", "--db", learned).out.count("0/4") == 2


def test_a_single_start_that_is_solved_is_exit_0(tmp_path: Path) -> None:
    """With a goal region as large as the table the attractor is over it from the beginning."""
    (tmp_path / "large.toml").write_text("[layout]\ngoal_half_width = 100.0\n")
    learn = ("learn", "--tool", "stick", "--behaviors", "5", "--config", "large.toml")
    done(*learn, cwd=tmp_path)
    solve = ("solve", "--goal", "1", "--start", "3", "--json")
    (trial,) = done(*solve, cwd=tmp_path).results
    assert (trial["outcome"], trial["steps"]) == ("solved", 0)


def test_explain_says_what_each_search_left(learned: Path) -> None:
    """The nested searches only ever leave fewer rows; the last cut is ceil(0.2 n), at least 1."""
    args = ("solve", "--goal", "2", "--explain", "--json", "--db", learned)
    trials = done(*args).results
    assert any(trial["explain"] for trial in trials)
    for trial in trials:
        assert [step["step"] for step in trial["explain"]] == list(range(1, trial["steps"] + 1))
        for step in trial["explain"]:
            left = {reason["name"]: reason["rows"] for reason in step["reasons"]}
            assert left["consistent"] >= left["probable"] >= left["reachable"] > 0
            assert left["nearest"] == max(1, math.ceil(0.2 * left["reachable"] - 1e-9))
            used_before, used_after = step["probability_before"], step["probability_after"]
            assert used_before > 0.5
            assert (used_after >= used_before) == step["replicated"]
            assert len(step["expected"]) == len(step["seen"]) == 2
        no_row = trial["outcome"] == "no row left"
        assert (trial["reasons_at_end"] is not None) == no_row
        assert not no_row or trial["reasons_at_end"][-1]["rows"] == 0


def test_explain_says_it_in_words(learned: Path, tmp_path: Path) -> None:
    copy = Path(shutil.copy(learned, tmp_path / "copy.db"))
    args = ("solve", "--goal", "1", "--tool", "stick", "--start", "2", "--explain")
    (trial,) = affcli(*args, "--json", "--db", copy).results
    text = affcli(*args, "--db", learned, COLUMNS="200").out
    head, *lines = text.partition("\n\n")[0].splitlines()
    steps = trial["steps"]
    many = "s" if steps != 1 else ""
    assert head == f"stick, goal 1, start 2: {trial['outcome']} ({steps} step{many})"
    for number, step in enumerate(trial["explain"]):
        chosen, seen, left, why, movement, probability = lines[6 * number : 6 * number + 6]
        assert chosen == f"  step {step['step']}: row {step['row']}, {step['behavior']}"
        assert seen.endswith(f" {step['distance_to_goal']:.1f} in from the goal's centre")
        assert f" {step['repositioning']:.1f} in; " in why
        assert f" {step['expected_distance_to_goal']:.1f} in from the centre" in why
        rows_left = {reason["name"]: reason["rows"] for reason in step["reasons"]}
        assert left.split() == words_of(rows_left)
        assert movement.startswith("    expected ")
        assert ", seen " in movement
        assert ("not replicated" in movement or "counted as a failure" in movement) == (
            not step["replicated"]
        )
        before, after = (eval_share(share) for share in probability.split()[1::2])
        assert (before, after) == (step["probability_before"], step["probability_after"])


def words_of(left: dict[str, int]) -> list[str]:
    """Return what --explain says of the rows left, word by word."""
    return (
        f"rows left: {left['consistent']} consistent, {left['probable']} probable, "
        f"{left['reachable']} reachable, {left['nearest']} nearest, 1 chosen"
    ).split()


def eval_share(share: str) -> float:
    """Return the value of a share written as 3/4."""
    over, _, under = share.partition("/")
    return int(over) / int(under)


def test_the_stored_counters_change_with_the_steps(learned: Path) -> None:
    """Each step is one use of one row, and they are saved together (§3.2)."""
    before = {row: counters for row, *counters in rows(learned, COUNTERS)}
    assert set(map(tuple, before.values())) == {(1, 1)}
    for goal in ("1", "3"):
        done("solve", "--goal", goal, "--db", learned)
    uses: Counter[int] = Counter()
    successes: Counter[int] = Counter()
    for row, replicated in rows(learned, "SELECT affordance_id, replicated FROM step"):
        uses[row] += 1
        successes[row] += replicated
    assert uses.total() > 0
    for row, used, successful in rows(learned, COUNTERS):
        assert (used, successful) == (1 + uses[row], 1 + successes[row])
    assert rows(learned, "SELECT DISTINCT counters FROM trial") == [("stored",)]


def test_the_same_trials_from_the_same_table_are_the_same(learned: Path, tmp_path: Path) -> None:
    copy = Path(shutil.copy(learned, tmp_path / "copy.db"))
    results: list[Any] = []
    for database in (learned, copy):
        args = ("solve", "--goal", "3", "--seed", "7", "--explain", "--json", "--db", database)
        results.append(done(*args).results)
    assert results[0] == results[1]
    assert contents(learned) == contents(copy)


@pytest.mark.parametrize(
    ("args", "says"),
    [
        (("solve", "--goal", "2"), "affcli learn --tool t-hook"),
        (("solve", "--goal", "2", "--tool", "l-stick"), "affcli learn --tool l-stick"),
        (("break-tool",), "affcli learn --tool t-hook"),
        (("break-tool", "--tool", "t-stick"), "affcli learn --tool t-stick"),
    ],
)
def test_nothing_learned_names_the_command_to_run(
    args: tuple[str, ...], says: str, empty: Path
) -> None:
    before = empty.read_bytes()
    line = refused(2, *args, "--db", empty)
    assert "nothing learned with the " in line
    assert f"first run: {says} --db {empty}" in line
    assert empty.read_bytes() == before


def test_with_another_tool_it_names_those_that_were_learned(learned: Path) -> None:
    line = refused(2, "solve", "--goal", "2", "--tool", "l-hook", "--db", learned)
    assert line.strip().endswith("; or name what was learned with: --tool stick or t-hook")


def test_an_unfinished_run_is_not_learned(empty: Path) -> None:
    """A table that is half full would make another robot of it."""
    done("learn", "--tool", "stick", "--behaviors", "5", "--db", empty)
    assert "nothing learned with the t-hook" in refused(
        2, "solve", "--goal", "1", "--tool", "t-hook", "--db", empty
    )


def test_a_tool_whose_only_run_is_unfinished_is_gone_on_with(learned: Path) -> None:
    tamper(learned, "UPDATE learning_run SET status = 'running' WHERE tool = 'stick'")
    goes_on = f"is not finished; go on with it first: affcli learn --resume --db {learned}"
    for command in (("solve", "--goal", "1"), ("verify",), ("table", "list")):
        said = refused(2, *command, "--tool", "stick", "--db", learned)
        assert f"run 2 with the stick {goes_on}" in said
    assert "no tool '" in refused(2, "solve", "--goal", "1", "--tool", b"\xff", "--db", learned)
    tamper(learned, "UPDATE learning_run SET status = 'running'")
    assert goes_on in refused(2, "solve", "--goal", "1", "--db", learned)


def test_random_tasks_are_the_same_for_every_planner_and_say_what_they_came_to(
    learned: Path,
) -> None:
    asked = ("solve", "--task", "anywhere:half_width=1", "--n", "3", "--tool", "t-hook")
    one, ahead = (
        done(*asked, "--planner", planner, "--json", "--db", learned).results
        for planner in ("one-step", "lookahead:depth=2")
    )
    assert [trial["start_at"] for trial in one] == [trial["start_at"] for trial in ahead]
    assert [trial["goal_at"] for trial in one] == [trial["goal_at"] for trial in ahead]
    for trial in (*one, *ahead):
        assert trial["tasks"] == "anywhere:half_width=1,n=3"
        assert len(trial["errors"]) == trial["steps"]
        assert trial["final_distance"] <= math.sqrt(2.0) or trial["outcome"] != "solved"
    table = done(*asked, "--db", learned).out
    assert table.startswith("anywhere:half_width=1,n=3: 3 trials, planner nested-query")


@pytest.mark.parametrize(
    ("asked", "code", "says"),
    [
        (("--task", "anywhere", "--n", "0"), 4, "--n 0: must lie in 1 to"),
        (("--goal", "1", "--n", "3"), 2, "--n is of random tasks, not of extension-of-reach"),
        (("--task", "anywhere:half_width=99"), 4, "half_width = 99 must lie in [0.1, 10] (in)"),
        (("--task", "anywhere", "--goal", "21"), 2, "no goal '21'"),
        (("--goal", "1", "--planner", "lookahead:depth=9"), 4, "depth = 9 must lie in [1, 8]"),
    ],
)
def test_tasks_and_plans_that_cannot_be(
    learned: Path, asked: tuple[str, ...], code: int, says: str
) -> None:
    assert says in refused(code, "solve", *asked, "--db", learned)
