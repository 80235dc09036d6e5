"""A page made of a hostile database executes nothing and shows what it was given as text."""

import json
import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from tests.browser.opening import Opened, page_of, text

TEXTS = [
    "<script>alert(1)</script>",
    "</script><script>alert(1)</script>",
    "<!--<script>",
    "{{7*7}} {% for x in y %} ${7*7}",
    "\"><img src=x onerror=alert(1)> ' onclick='alert(1)",
    "javascript:alert(1)",
    "\ud800 half a character",
]


@pytest.fixture(scope="module")
def hostile(life_database: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A robot's database with a bad name and bad words in it, and few trials."""
    folder = tmp_path_factory.mktemp("hostile")
    path = folder / "<script>alert(1)<'script>&lt;{{7*7}}\".db"
    shutil.copy(life_database, path)
    versions = json.dumps({TEXTS[0]: "1", **{f"no. {n}": words for n, words in enumerate(TEXTS)}})
    with closing(sqlite3.connect(path)) as driver, driver:
        driver.execute("DELETE FROM trial WHERE goal <> 2 OR start <> 3")
        driver.execute("DELETE FROM step WHERE trial_id NOT IN (SELECT id FROM trial)")
        driver.execute("UPDATE learning_run SET versions = ?", (versions,))
        driver.execute("UPDATE affordance SET tool = ?", (TEXTS[1],))
    return path


@pytest.mark.fault(31)
@pytest.mark.parametrize("javascript", [True, False])
def test_what_it_was_given_is_text(opened: Opened, hostile: Path, javascript: bool) -> None:
    """That nothing was executed and nothing asked for `opened` sees to."""
    page = opened(_page_of(hostile), java_script_enabled=javascript)
    page.wait_for_load_state("networkidle")
    made = text(page.locator("#made"))
    for words in TEXTS:
        shown = words.replace("\ud800", "\\ud800")
        assert " ".join(shown.split()) in made
    assert "49" not in made.split("Made with")[1].split("this page")[0].replace("7*7", "")
    assert hostile.name in text(page.locator("#made dd").first)
    assert page.title() == f"What the robot learned: {hostile.name}"
    # Nothing but what the template holds.
    assert page.locator("img, iframe, object, embed, link, base, form").count() == 0
    assert page.locator("script").count() == 3
    assert page.locator("[onclick], [onerror], [onload]").count() == 0


def test_it_plays_all_the_same(opened: Opened, hostile: Path) -> None:
    page = opened(_page_of(hostile), clock=True)
    page.locator("#play").click()
    page.clock.run_for(3000)
    page.locator("#list .choose").first.click()
    assert text(page.locator("#why h3")) == "Step 1: why this row?"


@pytest.mark.fault(31)
def test_the_page_allows_itself_nothing_from_outside(opened: Opened, hostile: Path) -> None:
    """Even if something got into it: no connection, no picture, no eval."""
    page = opened(_page_of(hostile))
    blocked = page.evaluate(
        """async () => {
            let refused = 0;
            document.addEventListener('securitypolicyviolation', () => { refused += 1; });
            await fetch('http://127.0.0.1:9/').catch(() => {});
            const picture = new Image();
            picture.src = 'http://127.0.0.1:9/x.png';
            await new Promise((done) => { picture.onerror = done; });
            return refused;
        }"""
    )
    assert blocked == 2
    # What the browser said of it was what this test is about.
    assert len(opened.complaints) >= 2
    assert all("Content Security Policy" in words for words in opened.complaints)
    opened.complaints.clear()
    opened.requests[:] = [one for one in opened.requests if "127.0.0.1" not in one]


def _page_of(database: Path) -> Path:
    """Return the page of a database, made once."""
    page = database.with_suffix(".html")
    return page if page.exists() else page_of(database)
