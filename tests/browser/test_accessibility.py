"""axe-core finds nothing to complain of, whatever the page looks like."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.browser.opening import PHONE, Opened

if TYPE_CHECKING:
    from playwright.sync_api import Page

VISITORS: dict[str, dict[str, Any]] = {
    "light": {"color_scheme": "light"},
    "dark": {"color_scheme": "dark"},
    "phone": {"viewport": PHONE},
    "dark phone": {"viewport": PHONE, "color_scheme": "dark"},
    "forced colours": {"forced_colors": "active"},
}


def violations(page: "Page") -> list[str]:
    """Return what axe-core finds, one line each."""
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(page).response["violations"]
    return [
        f"{one['id']}: {one['help']}: {node['html'][:200]} {node.get('failureSummary', '')}"
        for one in found
        for node in one["nodes"]
    ]


@pytest.fixture(params=["life", "many"])
def path(request: pytest.FixtureRequest) -> Path:
    """Each page."""
    found: Path = request.getfixturevalue(request.param)
    return found


@pytest.mark.parametrize("visitor", VISITORS)
def test_the_page_as_it_opens(opened: Opened, path: Path, visitor: str) -> None:
    page = opened(path, bypass_csp=True, **VISITORS[visitor])
    page.locator("details.tool").evaluate_all("all => all.forEach(one => { one.open = true; })")
    assert violations(page) == []


@pytest.mark.parametrize("visitor", ["light", "dark phone"])
def test_the_page_after_some_playing(opened: Opened, life: Path, visitor: str) -> None:
    """In the middle of a trial, sorted, with one sector of arrows alone."""
    page = opened(life, clock=True, bypass_csp=True, **VISITORS[visitor])
    page.locator("#play").click()
    page.clock.run_for(4000)
    page.locator("#play").click()
    page.locator("#list thead button").first.click()
    page.locator("#sectors input[value=toward]").check()
    page.clock.resume()
    assert violations(page) == []


def test_the_page_at_the_end_of_a_trial_and_after_following_a_row(
    opened: Opened, life: Path
) -> None:
    page = opened(life, bypass_csp=True)
    page.locator("#player").focus()
    page.keyboard.press("End")
    page.locator("#why .scroll a").first.click()
    assert violations(page) == []
