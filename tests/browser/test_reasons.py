"""What the page says of each step is what the database says of it."""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from tests.browser.opening import Opened, cells, choose, frame, last_frame, puck, step_shown, text
from tests.cli.program import rows

STEPS = """
SELECT s.*, a.exploratory_behavior, a.exploratory_params, t.outcome, t.shape
FROM step s JOIN affordance a ON a.id = s.affordance_id JOIN trial t ON t.id = s.trial_id
WHERE s.trial_id = {} ORDER BY s.number
"""
DRAWN = 0.03
"""Inches: films are rounded to 0.02, and the last frame is some 1/15 s old."""


def steps_of(database: Path, trial: int) -> list[dict[str, Any]]:
    """Return all that the database holds of a trial's steps."""
    query = STEPS.format(trial)
    names = "SELECT name FROM pragma_table_info('step')"
    columns = [name for (name,) in rows(database, names)]
    columns += ["behavior", "params", "outcome", "shape"]
    return [dict(zip(columns, row, strict=True)) for row in rows(database, query)]


def call(step: dict[str, Any]) -> str:
    """Return the behavior as a person writes it."""
    return f"{step['behavior']} {json.loads(step['params'])['offset_distance']:g}"


def moved(dx: float, dy: float) -> str:
    """Return a movement in words."""
    length = math.hypot(dx, dy)
    if length <= 0.5:
        return "none"
    return f"{length:.1f} in at {round(math.degrees(math.atan2(dy, dx))) % 360} deg"


def outcome(step: dict[str, Any]) -> str:
    """Return in words what came of a step."""
    if step["status"] is None:
        verdict = "blocked: the tool would have come down on the puck, counted as a failure"
    elif step["replicated"]:
        verdict = "as expected (within 40 degrees)"
    else:
        verdict = "not as expected"
    expected = moved(step["expected_dx"], step["expected_dy"])
    seen = moved(step["seen_dx"], step["seen_dy"])
    before, after = (
        f"{step[f'times_successful_{when}']}/{step[f'times_used_{when}']}"
        for when in ("before", "after")
    )
    died = ": excluded from now on" if step["died"] else ""
    lost = f" In truth the {step['shape']} cannot do it." if step["lost"] else ""
    return (
        f"Expected {expected}, seen {seen}: {verdict}. Successes/uses {before} before, {after} "
        f"after{died}.{lost}"
    )


def trials_worth_a_look(database: Path) -> list[int]:
    """Return trials in which different things happen: with a broken tool, long, blocked."""
    queries = (
        "shape <> tool ORDER BY steps",
        "outcome = 'solved' AND shape = tool ORDER BY steps DESC",
        "outcome <> 'solved' ORDER BY steps",
        "t.id IN (SELECT trial_id FROM step WHERE status IS NULL)",
    )
    # What `break-tool` did with the whole tool is not shown: `solve` did it before.
    shown = (
        "SELECT t.id FROM trial t JOIN session s ON s.id = session_id "
        "WHERE robot = 0 AND (s.kind <> 'break-tool' OR shape <> tool) AND "
    )
    return [number for query in queries for (number,) in rows(database, shown + query)[:1]]


@pytest.fixture(params=["life", "many"])
def path(request: pytest.FixtureRequest) -> Path:
    """Each page, beside its database."""
    found: Path = request.getfixturevalue(request.param)
    return found


def test_why_a_row_was_chosen_at_every_step(opened: Opened, path: Path) -> None:
    """Rows left by each search, the row chosen, movements and counters (§6.2)."""
    database = path.with_suffix(".db")
    page = opened(path)
    for trial in trials_worth_a_look(database):
        choose(page, trial)
        why = page.locator("#why")
        for step in steps_of(database, trial):
            number = step["number"]
            page.locator("#steps button").nth(number - 1).click()
            assert step_shown(page) == number
            row = step["affordance_id"]
            lead = text(why.locator(".answer"))
            reasons = {one["name"]: one["rows"] for one in json.loads(step["reasons"])}
            assert lead.startswith(f"Row {row}, {call(step)}: of the {reasons['nearest']} row")
            left = [cell[1] for cell in cells(why.locator(".funnel"))]
            names = ("consistent", "probable", "reachable", "nearest")
            assert left == [str(reasons[name]) for name in names] + ["1"]
            assert text(why.locator(".scroll + p")) == outcome(step)
            close = cells(why.locator(".scroll table"))
            probability = f"{step['times_successful_before']}/{step['times_used_before']}"
            assert close[0][:2] == [f"{row} (chosen)", call(step)]
            assert close[0][4] == probability
            assert len(close) == min(5, reasons["nearest"])
            if number == page.locator("#steps button").count():
                assert text(why.locator("> p").last).startswith(
                    f"The trial ended: {step['outcome']}"
                )


def test_why_the_robot_chose_this_row_at_step_3(
    opened: Opened, life: Path, life_database: Path
) -> None:
    """Every number of the sentence: the search for the least re-positioning (§6.2, search 4)."""
    query = "SELECT id FROM trial WHERE steps >= 3 AND shape <> tool AND goal = 1"
    ((trial,), *_) = rows(life_database, query)
    step = steps_of(life_database, trial)[2]
    page = opened(life)
    choose(page, trial)
    page.locator("#steps button").nth(2).click()
    _, _, travels, ends, _ = cells(page.locator("#why .scroll table"))[0]
    lead = text(page.locator("#why .answer"))
    assert f"it needs the least re-positioning, {travels} in." in lead
    assert lead.endswith(f"and should end {ends} in from it.")
    if step["status"] is not None:
        before = steps_of(life_database, trial)[1]
        wrist = [(step[f"wrist_start_{axis}"], before[f"wrist_end_{axis}"]) for axis in "xy"]
        went = math.hypot(*(now - then for now, then in wrist))
        assert float(travels) == pytest.approx(went, abs=0.06)
    others = cells(page.locator("#why .scroll table"))
    distances = [float(row[2]) for row in others]
    assert distances == sorted(distances)


def test_the_puck_ends_each_step_where_it_truly_did(opened: Opened, path: Path) -> None:
    database = path.with_suffix(".db")
    page = opened(path)
    for trial in trials_worth_a_look(database):
        choose(page, trial)
        page.locator("#player").focus()
        steps = steps_of(database, trial)
        for step in steps:
            begins = (step["true_start_x"], step["true_start_y"])
            assert puck(page) == pytest.approx(begins, abs=DRAWN)
            page.keyboard.press("ArrowRight")
            if step["number"] < len(steps):
                page.keyboard.press(",")
            assert puck(page) == pytest.approx(
                (step["true_end_x"], step["true_end_y"]), abs=DRAWN
            ), (trial, step["number"])
            page.keyboard.press(".")
        assert frame(page) == last_frame(page)


def test_the_list_of_steps_says_what_came_of_each(
    opened: Opened, life: Path, life_database: Path
) -> None:
    page = opened(life)
    for trial in trials_worth_a_look(life_database):
        choose(page, trial)
        said = [" ".join(one.split()) for one in page.locator("#steps li").all_text_contents()]
        for step, words in zip(steps_of(life_database, trial), said, strict=True):
            blocked = "blocked" if step["status"] is None else "not as expected"
            verdict = "as expected" if step["replicated"] else blocked
            died = ", row excluded" if step["died"] else ""
            assert words == f"{step['number']}. {call(step)}: {verdict}{died}"


def test_the_table_of_trials_is_that_of_the_database(
    opened: Opened, life: Path, life_database: Path
) -> None:
    """The latest trial of each kind; of `solve` before those that `break-tool` did beside."""
    page = opened(life)
    query = """
    SELECT t.id, t.tool || iif(t.shape = t.tool, '', ', became ' || t.shape), t.goal, t.start,
           t.outcome, t.steps, (SELECT sum(replicated) FROM step WHERE trial_id = t.id)
    FROM trial t JOIN session s ON s.id = t.session_id
    WHERE s.kind = 'solve' OR t.shape <> t.tool ORDER BY t.shape <> t.tool, t.goal, t.start
    """
    wanted = [[str(cell) for cell in row] for row in rows(life_database, query)]
    shown = [[row[0].removeprefix("Replay "), *row[1:]] for row in cells(page.locator("#list"))]
    assert shown == wanted
    assert len(shown) == 32
    assert "the latest: 16 more are in the database." in text(page.locator("#trials"))


def test_what_it_unlearned_is_what_the_database_says(
    opened: Opened, life: Path, life_database: Path
) -> None:
    """§7.2: rows excluded in the 16 trials with the broken tool, and rows truly lost."""
    adapted = "FROM step JOIN trial ON id = trial_id WHERE shape <> tool"
    dead = f"SELECT DISTINCT affordance_id {adapted} AND died"
    lost = f"{dead} AND affordance_id IN (SELECT affordance_id {adapted} AND lost)"
    excluded = {number for (number,) in rows(life_database, dead)}
    page = opened(life)
    drawn = page.locator("#broken .arrow.excluded").evaluate_all(
        "arrows => arrows.map(arrow => Number(arrow.dataset.row))"
    )
    assert sorted(drawn) == sorted(excluded)
    assert excluded
    ((all_rows,),) = rows(life_database, "SELECT count(*) FROM affordance")
    answer = text(page.locator("#broken .answer"))
    assert answer.startswith(f"{len(excluded)} of its {all_rows} rows were excluded in at least")
    sure = len(rows(life_database, lost))
    assert f"and {sure} are truly lost: the l-hook cannot do them." in answer
    table = cells(page.locator("#broken table"))
    assert sum(int(row[1]) for row in table) == len(excluded)
    assert sum(int(row[3]) for row in table) == sure
    assert sum(int(row[4]) for row in table) == all_rows
    assert page.locator("#broken .missing").count() == 2 * page.locator("#broken .panel").count()


def test_where_the_t_hook_affords_pulling(opened: Opened, life: Path, life_database: Path) -> None:
    """The sentence counts as the database does: movements within 45 degrees of straight back."""
    ((pulling, all_rows),) = rows(
        life_database,
        "SELECT sum(direction >= 225 AND direction < 315), count(*) FROM affordance",
    )
    answer = text(opened(life).locator("#tools .answer"))
    assert answer.startswith(f"{pulling} of the {all_rows} rows of the t-hook move the puck toward")
    assert "hook (" in answer
