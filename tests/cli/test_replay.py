"""``affcli replay``: on a terminal and away from one, as JSON, and held against the record."""

import json
import signal
import sqlite3
import time
from contextlib import closing
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import pytest
from rich.cells import cell_len

from affcli.lab.learning_run import LearningRun
from affcli.store import open_store
from tests.cli.program import Ended, affcli, done, refused, rows, started, wait_until
from tests.cli.table_rows import tamper
from tests.cli.test_interrupt import handles_signals, stopped
from tests.factories import learning_spec
from tests.lab.quick import NOW

SOLVED = "5"
"""The T-hook brings the attractor over goal 2 from start 1."""
NEXT = "; q: leave > "
WHOLE_RUN = "run 1: the replay equals the record, all 800 behaviors\n"
BRAILLE = range(0x2800, 0x2900)
STOPPED = "affcli: stopped; what was saved is kept"


def altered(database: Path, *statements: str) -> None:
    """Change a database as no affcli would."""
    with closing(sqlite3.connect(database)) as driver, driver:
        for statement in statements:
            driver.execute(statement)


def steps_of(trial: int | str, database: Path) -> int:
    """Return how many steps of a trial are stored."""
    ((count,),) = rows(database, f"SELECT count(*) FROM step WHERE trial_id = {trial}")
    return int(count)


def same(trial: int | str, database: Path) -> str:
    """Return what is said of a trial that is as its record says."""
    ((outcome,),) = rows(database, f"SELECT outcome FROM trial WHERE id = {trial}")
    count = steps_of(trial, database)
    return f"trial {trial} ended: {outcome}; the replay equals the record, all {count} steps\n"


def titles_in(out: str) -> list[int]:
    """Return the numbers of the steps that are shown, in order."""
    titles = [line for line in out.splitlines() if line.startswith("Trial ")]
    return [int(title.split()[3]) for title in titles]


def test_without_a_terminal_each_step_is_shown_as_it_ended(used: Path) -> None:
    stored = used.read_bytes()
    ended = done("replay", SOLVED, "--db", used)
    assert ended.err == same(SOLVED, used)
    taken = rows(
        used, f"SELECT number, affordance_id FROM step WHERE trial_id = {SOLVED} ORDER BY number"
    )
    assert titles_in(ended.out) == [number for number, _ in taken]
    pages = ended.out.split("Trial ")[1:]
    for page, (_, row) in zip(pages, taken, strict=True):
        assert f"row {row}: " in page
        assert "[compare]" in page
        assert "replicated" in page
        assert "next best: row " in page
    assert used.read_bytes() == stored


@pytest.mark.parametrize(
    ("steps", "shown"), [("2", [2]), ("2-3", [2, 3]), ("1-1", [1]), ("03", [3])]
)
def test_some_steps_are_shown_alone(steps: str, shown: list[int], used: Path) -> None:
    ended = done("replay", SOLVED, "--steps", steps, "--db", used)
    assert titles_in(ended.out) == shown
    assert ended.err == same(SOLVED, used)


STEP = """SELECT number, affordance_id, reasons,
expected_dx, expected_dy, seen_dx, seen_dy, replicated, lost,
true_start_x, true_start_y, true_end_x, true_end_y,
times_successful_before, times_used_before
FROM step WHERE trial_id = {} ORDER BY number"""


def as_stored(step: dict[str, Any]) -> tuple[object, ...]:
    """Return a step of the JSON as the columns of STEP."""
    chosen = step["considered"][0]
    return (
        *(step["step"], step["row"], json.dumps(step["reasons"], separators=(",", ":"))),
        *(*step["expected"], *step["seen"]),
        *(step["replicated"], step["lost"], *step["true_start"][:2], *step["true_end"][:2]),
        *(chosen["times_successful"], chosen["times_used"]),
    )


def test_the_json_is_what_sql_says_of_the_steps(used: Path) -> None:
    """Of a trial that was solved, and of those with the broken tool."""
    broken = rows(used, "SELECT id FROM trial WHERE shape <> tool")
    assert len(broken) == 16
    for trial in (SOLVED, *(number for (number,) in broken[:4])):
        ended = done("replay", str(trial), "--json", "--db", used)
        assert ended.err == same(trial, used)
        found = ended.result
        columns = ("tool", "shape", "goal", "start", "outcome")
        (stored,) = rows(used, f"SELECT {', '.join(columns)} FROM trial WHERE id = {trial}")
        assert tuple(found[name] for name in columns) == stored
        assert (found["equal"], found["differences"]) == (True, [])
        assert [as_stored(step) for step in found["steps"]] == rows(used, STEP.format(trial))
        for step in found["steps"]:
            assert step["row"] == step["considered"][0]["row"]
            assert step["frames"] > 0


def test_the_json_of_some_steps_holds_them_alone(used: Path) -> None:
    whole = done("replay", SOLVED, "--json", "--db", used).result
    some = done("replay", SOLVED, "--steps", "2-3", "--json", "--db", used).result
    assert some == {**whole, "steps": whole["steps"][1:3]}


def test_all_trials_are_what_their_record_says(used: Path) -> None:
    """Of solve, whose trials update the stored counters, and of break-tool."""
    says = "40 of 40 trials equal their record in every step\n"
    assert done("replay", "--all", "--db", used) == Ended(0, "", says)
    ended = done("replay", "--all", "--json", "--db", used)
    assert ended.results == [{"trial": n, "equal": True, "why": None} for n in range(1, 41)]
    assert ended.err == says


def test_a_learning_run_is_what_its_record_says(reproduced: Path) -> None:
    """A robot of a reproduction too, whose hour it is that ends it."""
    ((count,),) = rows(reproduced, "SELECT behaviors FROM learning_run WHERE id = 7")
    says = f"run 7: the replay equals the record, all {count} behaviors\n"
    assert done("replay", "--run", "7", "--db", reproduced) == Ended(0, "", says)
    ended = done("replay", "--run", "7", "--json", "--db", reproduced)
    counts = {"run": 7, "borrowed": 0, "behaviors": count}
    assert ended.result == {**counts, "equal": True, "differences": []}


def test_behaviors_of_a_run_are_shown_alone(learned: Path) -> None:
    ended = done("replay", "--run", "1", "--steps", "5-9", "--db", learned)
    assert ended.err == "run 1: the replay equals the record, the first 9 behaviors\n"
    pages = ended.out.split("Run 1, t-hook, 800 behaviors: ")[1:]
    stored = rows(
        learned,
        "SELECT step, exploratory_behavior, change_detected FROM behavior"
        " WHERE learning_run_id = 1 AND step BETWEEN 5 AND 9 ORDER BY step",
    )
    assert {moved for _, _, moved in stored} == {0, 1}
    for page, (step, behavior, moved) in zip(pages, stored, strict=True):
        assert page.startswith(f"behavior {step}\n")
        assert behavior in page
        assert (": a row" in page) == bool(moved)
        assert ("no movement detected: no row" in page) != bool(moved)


@pytest.mark.parametrize("columns", [20, 40, 71, 72, 80])
def test_away_from_a_terminal_nothing_is_wider_than_the_screen(columns: int, used: Path) -> None:
    for what in ((SOLVED,), ("--run", "1", "--steps", "1-9")):
        out = done("replay", *what, "--db", used, COLUMNS=str(columns)).out
        assert max(map(cell_len, out.splitlines())) <= columns
        assert "…" not in out
        if columns >= 40:
            wide = done("replay", *what, "--db", used, COLUMNS="200").out
            words = {word for word in wide.split() if word.isascii()}
            assert words <= set(out.split()), "a word is broken"


def interrupted(database: Path, steps: int) -> int:
    """Leave of a trial what affcli left when it still saved step by step; return its number."""
    affcli("solve", "--goal", "1", "--start", "1", "--run", "1", "--db", database)
    ((number, whole),) = rows(database, "SELECT id, steps FROM trial")
    assert steps < whole
    tamper(database, "DELETE FROM step WHERE trial_id = ? AND number > ?", number, steps)
    tamper(database, "UPDATE trial SET outcome = NULL, steps = NULL, robot_seconds = NULL")
    return int(number)


@pytest.mark.parametrize(("steps", "says"), [(1, "its one step"), (2, "all 2 steps")])
def test_an_interrupted_trial_is_done_as_far_as_it_came(
    steps: int, says: str, learned: Path
) -> None:
    trial = interrupted(learned, steps)
    ended = done("replay", str(trial), "--db", learned)
    assert ended.err == f"trial 1 was interrupted; the replay equals the record, {says}\n"
    assert titles_in(ended.out) == list(range(1, steps + 1))
    assert done("replay", str(trial), "--json", "--db", learned).result["outcome"] is None
    assert done("replay", "--all", "--db", learned).err.startswith("1 of 1 trials equal ")


def test_a_trial_without_steps_shows_the_table(learned: Path) -> None:
    """A robot that learned nothing has no row to choose."""
    done("learn", "--tool", "l-hook", "--behaviors", "1", "--db", learned)
    affcli("solve", "--goal", "1", "--start", "1", "--tool", "l-hook", "--db", learned)
    ended = done("replay", "1", "--db", learned)
    assert ended.err == "trial 1 ended: no row left; the replay equals the record, no steps\n"
    assert ended.out.startswith("Trial 1, no steps: l-hook, goal 1, start 1\n")
    assert any(ord(letter) in BRAILLE for letter in ended.out)
    assert done("replay", "1", "--json", "--db", learned).result["steps"] == []
    line = refused(2, "replay", "1", "--steps", "1", "--db", learned)
    assert line.endswith("no step 1 in trial 1; it has none")


def test_a_run_that_goes_on_is_done_as_far_as_it_came(learned: Path) -> None:
    """Just begun it has nothing to show; later some."""
    run = LearningRun(learning_spec("l-stick", seed=3, hours=1.0))
    with open_store(learned, create=False, write=True) as store:
        info = store.learning.begin(run.spec, {}, NOW)
        says = f"run {info.id}: the replay equals the record, no behaviors\n"
        assert done("replay", "--run", str(info.id), "--db", learned) == Ended(0, "", says)
        asked = ("replay", "--run", str(info.id), "--steps", "1", "--db", learned)
        assert f"no behavior 1 in run {info.id}; it has none" in refused(2, *asked)
        some = list(islice(run.steps(), 12))
        clock = run.setting.robot.clock
        saved = (info.id, 0, some, run.checkpoint(), clock)
        assert store.learning.append(*saved, done=False, now=NOW)
    says = f"run {info.id}: the replay equals the record, all 12 behaviors\n"
    assert done("replay", "--run", str(info.id), "--db", learned) == Ended(0, "", says)


CHANGED = {
    "where the attractor went": (
        f"update step set true_end_x = 1.25 where trial_id = {SOLVED} and number = 2",
        "step 2 (true_end_x)",
    ),
    "a step gone": (
        f"delete from step where trial_id = {SOLVED} and number = 3",
        "step 3 (not in the record)",
    ),
    "a step more": (
        f"update step set number = 9 where trial_id = {SOLVED} and number = 3",
        "step 3 (not in the record), step 9 (not done again)",
    ),
    "the end": (f"update trial set steps = 7 where id = {SOLVED}", "the end (steps)"),
    "reasons of the end": (
        f"update trial set last_reasons = '[]' where id = {SOLVED}",
        "the end (last_reasons)",
    ),
    "the seed": (
        f"update trial set seed = 99 where id = {SOLVED}",
        "step 1 (clock, wrist_start_x, wrist_start_y and ",
    ),
}


@pytest.mark.parametrize(("change", "says"), CHANGED.values(), ids=CHANGED.keys())
def test_a_record_that_was_changed_is_exit_code_1_and_named(
    change: str, says: str, used: Path
) -> None:
    altered(used, change)
    ended = affcli("replay", SOLVED, "--db", used)
    assert ended.code == 1
    (line,) = ended.err.splitlines()
    assert f"; the replay DIFFERS from the record in {says}" in line
    assert len(line) < 400
    found = affcli("replay", SOLVED, "--json", "--db", used)
    assert found.code == 1
    assert found.result["equal"] is False
    assert found.result["differences"][0].keys() == {"number", "column", "stored", "again"}
    every = affcli("replay", "--all", "--db", used)
    assert every.code == 1
    said = every.err.splitlines()
    assert said[0].startswith(f"trial {SOLVED}: the replay DIFFERS from the record in {says}")
    assert said[-1] == f"{41 - len(said)} of 40 trials equal their record in every step"


def test_of_many_that_differ_some_are_named(used: Path) -> None:
    altered(used, "update step set true_end_x = true_end_x + 1")
    ended = affcli("replay", "--all", "--db", used)
    assert ended.code == 1
    said = ended.err.splitlines()
    assert said[20:] == [
        "and 20 more; --json names them all",
        "0 of 40 trials equal their record in every step",
    ]
    found = affcli("replay", "--all", "--json", "--db", used).results
    assert [one["equal"] for one in found] == [False] * 40
    assert all(one["why"].startswith("the replay DIFFERS from the record in ") for one in found)


def test_a_changed_learning_run_is_exit_code_1_and_named(learned: Path) -> None:
    altered(
        learned,
        "update behavior set true_end_y = 2 where learning_run_id = 2 and step = 3",
        "update learning_run set behaviors_limit = 20 where id = 2",
    )
    ended = affcli("replay", "--run", "2", "--steps", "3", "--db", learned)
    assert ended.code == 1
    assert ended.err == "run 2: the replay DIFFERS from the record in behavior 3 (true_end_y)\n"
    ended = affcli("replay", "--run", "2", "--json", "--db", learned)
    assert ended.code == 1
    assert ended.err == (
        "run 2: the replay DIFFERS from the record in behavior 3 (true_end_y), "
        "behavior 21 (not done again)\n"
    )
    assert [d["number"] for d in ended.result["differences"]] == [3, 21]


@pytest.mark.fault(3)
@pytest.mark.parametrize(("signum", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_stopped_away_from_a_terminal_it_is_one_line(
    signum: signal.Signals, code: int, learned: Path
) -> None:
    says = "affcli: stopped; what was saved is kept\n"
    with started("replay", "--run", "1", "--db", learned) as process:
        wait_until(partial(handles_signals, process.pid), process)
        time.sleep(0.5)
        assert stopped(process, signum) in {Ended(code, "", says), Ended(0, "", WHOLE_RUN)}


def test_a_run_that_borrowed_borrows_again_where_the_lenders_are(tmp_path: Path) -> None:
    """Its counters may have changed since: trials use what was borrowed."""
    database = tmp_path / "my.db"
    done("learn", "--tool", "t-hook", "--minutes", "8", "--db", database)
    borrow = ("--transfer-from", "1:each=20", "--minutes", "0")
    done("learn", "--tool", "fork", *borrow, "--db", database)
    ((count,),) = rows(database, "SELECT rows FROM learning_run WHERE id = 2")
    says = f"run 2: the replay equals the record, all {count} borrowed rows, no behaviors\n"
    tamper(database, "UPDATE affordance SET times_used = 3 WHERE learning_run_id = 2")
    assert done("replay", "--run", "2", "--db", database) == Ended(0, "", says)

    tamper(database, "UPDATE affordance SET end_object_x = 9 WHERE step = -1")
    tamper(database, "UPDATE borrowed SET lender_step = lender_step + 1 WHERE step = 0")
    ended = affcli("replay", "--run", "2", "--json", "--db", database)
    assert ended.code == 1
    found = [(d["number"], d["column"]) for d in ended.result["differences"]]
    assert found == [(-1, "end_object_x"), (0, "lender_step")]
    assert ended.err == (
        "run 2: the replay DIFFERS from the record in borrowed row -1 (end_object_x), borrowed row "
        "0 (lender_step)\n"
    )
    tamper(database, "DELETE FROM borrowed WHERE step = 0")
    tamper(database, "DELETE FROM affordance WHERE learning_run_id = 2 AND step = 0")
    ended = affcli("replay", "--run", "2", "--db", database)
    assert ended.err.endswith("borrowed row 0 (not in the record)\n")

    done("runs", "delete", "1", "--yes", "--db", database)
    ended = done("replay", "--run", "2", "--json", "--db", database)
    assert ended.result == {
        "run": 2,
        "borrowed": None,
        "behaviors": 0,
        "equal": True,
        "differences": [],
    }
    assert ended.err == (
        "run 2: the replay equals the record, no behaviors; what it borrowed was not checked, for "
        "a run that lent it is not there any more\n"
    )
