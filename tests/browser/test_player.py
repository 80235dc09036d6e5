"""The replays: they play, stop, and go where they are sent (§7)."""

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.browser.opening import (
    PATIENCE,
    Opened,
    choose,
    frame,
    last_frame,
    lit,
    puck,
    step_shown,
    text,
)
from tests.cli.program import rows

if TYPE_CHECKING:
    from playwright.sync_api import Page

THINKING = 7 * 140
"""Milliseconds for which a row is chosen, at 4x: seven boxes are lit in turn."""
SEARCHES = ["observe", "over", "reach", "s1", "s2", "s2", "s3", "s4"]


@pytest.fixture
def page(opened: Opened, life: Path) -> "Page":
    """The page of one robot, at a trial of at least three steps; time stands still."""
    page = opened(life, clock=True)
    page.locator("#player").focus()
    assert page.locator("#steps button").count() >= 3
    return page


def test_a_page_opens_without_complaint_or_request(opened: Opened, life: Path, many: Path) -> None:
    """What `opened` notes is judged when the test is over."""
    for path in (life, many):
        page = opened(path)
        page.wait_for_load_state("networkidle")
        assert page.title() == f"What the robot learned: {path.stem}.db"
    assert sorted(opened.requests) == sorted([life.as_uri(), many.as_uri()])


def test_every_trial_can_be_chosen(opened: Opened, many: Path, many_database: Path) -> None:
    page = opened(many)
    query = "SELECT id, outcome, steps FROM trial WHERE robot = 0 ORDER BY id"
    trials = rows(many_database, query)
    assert len(trials) == 96
    for trial, outcome, steps in trials:
        choose(page, trial)
        said = text(page.locator("#which"))
        assert said.startswith(f"Trial {trial}: ")
        assert said.endswith(f": {outcome} after {steps} step{'' if steps == 1 else 's'}.")
        assert page.locator("#steps button").count() == steps
        assert frame(page) == 0
        assert page.locator("#list tr.chosen").count() == 1


def test_it_plays_to_the_end_and_stops_there(opened: Opened, life: Path) -> None:
    """In real time: the shortest trial, fast."""
    page = opened(life)
    steps = page.locator("#list tbody tr td:nth-child(6)").all_text_contents()
    page.locator("#list .choose").nth(min(range(len(steps)), key=lambda i: int(steps[i]))).click()
    page.locator("#speed").select_option("10")
    page.locator("#play").click()
    assert text(page.locator("#play")) == "Pause"
    page.locator("#play", has_text="Play").wait_for()
    assert frame(page) == last_frame(page) > 15
    assert "the end: solved" in text(page.locator("#now"))
    page.locator("#play").click()
    assert text(page.locator("#play")) == "Pause"
    assert frame(page) < last_frame(page)


@pytest.mark.parametrize("speed", [1, 2, 4, 10])
def test_it_plays_as_fast_as_it_is_asked_to(page: "Page", speed: int) -> None:
    """15 frames a robot second, after a row has been chosen."""
    page.locator("#speed").select_option(str(speed))
    page.locator("#play").click()
    page.clock.run_for(int(THINKING * min(2, 4 / speed)) + 50)
    before = frame(page)
    page.clock.run_for(1000 // speed)
    assert frame(page) - before == pytest.approx(15, abs=2)


def test_pausing_holds_the_frame(page: "Page") -> None:
    page.locator("#play").click()
    page.clock.run_for(THINKING + 500)
    page.locator("#play").click()
    held = frame(page)
    assert 0 < held < last_frame(page)
    assert text(page.locator("#play")) == "Play"
    page.clock.run_for(3000)
    assert frame(page) == held
    page.locator("#play").click()
    page.clock.run_for(500)
    assert frame(page) > held


def test_choosing_another_trial_stops_the_one_that_plays(page: "Page") -> None:
    page.locator("#play").click()
    page.clock.run_for(THINKING + 500)
    page.locator("#list .choose").first.click()
    assert text(page.locator("#play")) == "Play"
    page.clock.run_for(3000)
    assert frame(page) == 0


def test_the_slider_goes_to_any_moment(page: "Page") -> None:
    for wanted in (last_frame(page) // 2, last_frame(page), 0, 17):
        page.locator("#scrub").fill(str(wanted))
        assert frame(page) == wanted
    page.locator("#scrub").focus()
    page.keyboard.press("ArrowRight")
    assert frame(page) == 18


def test_the_buttons_go_by_steps(page: "Page") -> None:
    page.locator("#on").click()
    page.locator("#on").click()
    assert step_shown(page) == 3
    third = frame(page)
    page.locator("#back").click()
    assert step_shown(page) == 2
    page.locator("#on").click()
    assert frame(page) == third
    page.locator("#scrub").fill(str(third + 5))
    page.locator("#back").click()
    assert frame(page) == third
    for _ in range(page.locator("#steps button").count()):
        page.locator("#on").click()
    assert frame(page) == last_frame(page)


def test_the_list_goes_to_a_step(page: "Page") -> None:
    page.locator("#steps button").nth(2).click()
    assert step_shown(page) == 3
    chosen = page.locator("#steps button[aria-current=step]")
    assert text(chosen).startswith("3. ")


def test_the_list_keeps_the_step_in_sight(page: "Page") -> None:
    """A long list is scrolled along, and only the list."""
    page.evaluate("scrollTo(0, 0)")
    page.locator("#player").evaluate("box => box.focus({preventScroll: true})")
    page.keyboard.press("End")
    assert page.evaluate("scrollY") == 0
    inside = """() => {
        const list = document.getElementById('steps').getBoundingClientRect();
        const step = document.querySelector('#steps [aria-current]').getBoundingClientRect();
        return step.top >= list.top - 1 && step.bottom <= list.bottom + 1;
    }"""
    assert page.evaluate(inside)


def test_the_keyboard_does_it_all(page: "Page") -> None:
    press = page.keyboard.press
    press("ArrowRight")
    press("ArrowRight")
    assert step_shown(page) == 3
    press("ArrowLeft")
    assert step_shown(page) == 2
    second = frame(page)
    press(".")
    press(".")
    press(",")
    assert frame(page) == second + 1
    press("End")
    assert frame(page) == last_frame(page)
    press(".")
    assert frame(page) == last_frame(page)
    press("Home")
    assert frame(page) == 0
    press(",")
    assert frame(page) == 0
    press("Space")
    assert text(page.locator("#play")) == "Pause"
    page.clock.run_for(THINKING + 500)
    press("Space")
    assert text(page.locator("#play")) == "Play"
    assert frame(page) > 0


def test_keys_that_mean_something_else_are_left_alone(page: "Page") -> None:
    """Shortcuts of the browser; the choice of a speed; space on a button presses it, once."""
    page.keyboard.press("Control+ArrowRight")
    assert frame(page) == 0
    page.locator("#speed").focus()
    page.keyboard.press("ArrowRight")
    assert frame(page) == 0
    page.locator("#on").focus()
    page.keyboard.press("Space")
    assert step_shown(page) == 2
    assert text(page.locator("#play")) == "Play"


def test_the_procedure_lights_what_is_being_done(page: "Page") -> None:
    """Fig. 7: observe, ask, search four times, position, act, compare."""
    assert lit(page) == SEARCHES
    page.keyboard.press(".")
    assert lit(page) == ["place"]
    page.keyboard.press("ArrowRight")
    page.keyboard.press(",")
    assert lit(page) == ["compare"]
    page.keyboard.press(",")
    assert lit(page) == ["explore"]
    page.keyboard.press("End")
    assert lit(page) == ["over", "compare"]
    assert page.locator("#flow [aria-current=step]").count() == 2


def test_while_a_row_is_chosen_each_search_is_lit_in_turn(page: "Page") -> None:
    page.locator("#play").click()
    seen: dict[str, None] = {}
    for _ in range(THINKING // 20 + 10):
        page.clock.run_for(20)
        seen |= dict.fromkeys(lit(page))
    assert list(seen) == [*dict.fromkeys(SEARCHES), "place"]


def test_at_the_end_of_a_step_it_waits_at_the_comparison(page: "Page") -> None:
    page.keyboard.press("ArrowRight")
    for _ in range(4):
        page.keyboard.press(",")
    page.locator("#play").click()
    page.clock.run_for(200)
    assert lit(page) == ["compare"]
    held = frame(page)
    page.clock.run_for(300)
    assert (frame(page), lit(page)) == (held, ["compare"])
    page.clock.run_for(500)
    assert step_shown(page) == 2


def test_the_procedure_ends_where_the_trial_did(
    opened: Opened, many: Path, many_database: Path
) -> None:
    """Over the goal, out of reach, without a row; a robot that ran out of steps is in no box."""
    boxes = {"solved": ["over"], "attractor out of reach": ["reach"], "no row left": ["s4"]}
    boxes["no plan found"] = ["choose"]
    query = "SELECT outcome, min(id) FROM trial WHERE robot = 0 GROUP BY outcome"
    found = rows(many_database, query)
    assert len(found) >= 2
    page = opened(many)
    for outcome, trial in found:
        choose(page, trial)
        page.locator("#player").focus()
        page.keyboard.press("End")
        assert lit(page) == [*boxes.get(outcome, []), "compare"]
        assert text(page.locator("#why > p").last).startswith(f"The trial ended: {outcome}")


def test_the_puck_moves_only_while_a_behavior_runs(page: "Page") -> None:
    """While the wrist is positioned the tool is lifted: it touches nothing."""
    before = puck(page)
    while lit(page) != ["explore"]:
        page.keyboard.press(".")
        if lit(page) == ["place"]:
            assert puck(page) == before


def test_playing_goes_on_for_as_long_as_it_must(opened: Opened, life: Path) -> None:
    """A trial of many steps, played from a step in the middle, ends where the trial ends."""
    page = opened(life, clock=True)
    page.locator("#steps button").last.click()
    page.locator("#play").click()
    page.clock.run_for(PATIENCE)
    assert frame(page) == last_frame(page)
    assert text(page.locator("#play")) == "Play"
