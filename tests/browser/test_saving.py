"""What can be taken away from the page: pictures that stand alone, and data as CSV and JSON."""

import csv
import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.browser.opening import Opened
from tests.cli.program import rows

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page


@pytest.fixture
def page(opened: Opened, life: Path) -> "Page":
    """The page of one robot, in the dark."""
    return opened(life, color_scheme="dark")


def saved(page: "Page", button: "Locator") -> tuple[str, str]:
    """Return name and text of what a button saves."""
    with page.expect_download() as started:
        button.click()
    path = started.value.path()
    with path.open(newline="", encoding="utf-8") as file:
        return started.value.suggested_filename, file.read()


def data(page: "Page", words: str) -> "Locator":
    """Return the button under \"Data to take away\"."""
    return page.locator("#taken").get_by_role("button", name=words, exact=True)


def test_the_rows_are_those_of_the_database(page: "Page", life_database: Path) -> None:
    name, text = saved(page, data(page, "Rows (CSV)"))
    assert name == "life-rows.csv"
    found = {int(row["row"]): row for row in csv.DictReader(text.splitlines())}
    stored = rows(
        life_database,
        "SELECT id, start_wrist_to_object_x, start_wrist_to_object_y, expected_dx, expected_dy, "
        "times_successful, times_used, run, exploratory_behavior FROM affordance_wide",
    )
    assert sorted(found) == sorted(row[0] for row in stored)
    for number, x, y, dx, dy, successful, used, run, behavior in stored:
        row = found[number]
        shown = [float(row[key]) for key in ("x_in", "y_in", "dx_in", "dy_in")]
        assert shown == pytest.approx([x, y, dx, dy], abs=0.0051)
        assert (row["times_successful"], row["times_used"]) == (str(successful), str(used))
        assert (row["run"], row["robot"], row["tool"]) == (str(run), "seed 0", "t-hook")
        assert row["behavior"].startswith(behavior)
        assert row["nearest_part"] in {
            *("handle", "left bar", "right bar", "left hook", "right hook"),
        }


def test_the_steps_are_those_of_the_database(page: "Page", life_database: Path) -> None:
    name, text = saved(page, data(page, "Steps (CSV)"))
    assert name == "life-steps.csv"
    found = {
        (int(row["trial"]), int(row["step"])): row for row in csv.DictReader(text.splitlines())
    }
    stored = rows(
        life_database,
        "SELECT trial_id, number, affordance_id, replicated, died, seen_dx, times_used_after "
        "FROM step",
    )
    known = {(trial, number): rest for trial, number, *rest in stored}
    trials = page.locator("#list tbody tr").count()
    assert len({trial for trial, _ in found}) == trials == 32
    for step, row in found.items():
        affordance, replicated, died, seen, used = known[step]
        assert row["row"] == str(affordance)
        assert (row["replicated"], row["excluded"]) == (str(replicated), str(died))
        assert float(row["seen_dx_in"]) == pytest.approx(seen, abs=0.0051)
        assert row["used_after"] == str(used)


def test_a_table_is_saved_as_it_is_shown(page: "Page") -> None:
    name, text = saved(page, data(page, "Trials (CSV)"))
    assert name == "life-trials.csv"
    head, *lines = csv.reader(text.splitlines())
    assert head == ["trial", "tool", "goal", "start", "outcome", "steps", "replicated"]
    assert len(lines) == 32
    assert all(line[0].isdecimal() for line in lines)


def test_everything_can_be_had_as_json(page: "Page") -> None:
    _, text = saved(page, data(page, "Rows, trials, steps and films (JSON)"))
    value = json.loads(text)
    assert {"rows", "trials", "worlds"} <= set(value)
    assert len(value["trials"]) == 32


@pytest.mark.parametrize(
    ("button", "name", "panels"),
    [
        ("#tools .save", "life-run-1-affordances.svg", 8),
        ("#worth .save", "life-learning.svg", 1),
        ("#broken .save", "life-broken-1.svg", 8),
        ("#player .save", "life-moment.svg", 1),
    ],
)
def test_a_picture_stands_alone_and_is_dark_on_light(
    opened: Opened, page: "Page", tmp_path: Path, button: str, name: str, panels: int
) -> None:
    """It needs no style sheet, and every marker that it names is in it."""
    given, text = saved(page, page.locator(button).first)
    assert given == name
    assert "var(" not in text
    assert "<use" not in text
    assert "class=" not in text
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    again = opened(path)
    assert again.locator("svg > svg").count() == panels
    ink = "all => all.map(one => getComputedStyle(one).fill.match(/\\d+/g).map(Number))"
    for colour in again.locator("text").evaluate_all(ink):
        assert sum(colour[:3]) < 400
    marked = "all => all.map(one => getComputedStyle(one).markerEnd).filter(end => end !== 'none')"
    for end in set(again.locator("path").evaluate_all(marked)):
        named = end.split("#")[1].rstrip('")')
        assert again.locator(f"[id={named}]").count() == 1
