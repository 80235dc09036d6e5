"""A real browser, and pages made of real databases."""

import os
import shutil
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.browser.opening import Opened, page_of
from tests.cli.program import done

if TYPE_CHECKING:
    from playwright.sync_api import Browser

NAMES = ("chromium", "chromium-browser", "google-chrome")
"""What a browser is called; the same as in the Makefile."""
QUIET = (
    "--headless",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
REASON = "no browser here: make test-browser installs one"


def program() -> str | None:
    """Return the system's browser; None when there is none, or nothing to drive it with."""
    drivers = (find_spec(name) for name in ("playwright", "axe_playwright_python"))
    return next(filter(None, map(shutil.which, NAMES)), None) if all(drivers) else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Skip the tests of this folder without a browser; with `--browser` they fail."""
    if config.getoption("--browser") or program() is not None:
        return
    for item in items:
        if item.path.is_relative_to(Path(__file__).parent):
            item.add_marker(pytest.mark.skip(reason=REASON))


@pytest.fixture(scope="session")
def browser() -> "Iterator[Browser]":
    """The system's browser."""
    found = program()
    if found is None:
        pytest.fail(REASON)
    from playwright.sync_api import sync_playwright

    # Chromium's sandbox refuses to be run by root.
    flags = [*QUIET, "--no-sandbox"] if os.getuid() == 0 else list(QUIET)
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=found, args=flags)
        yield started
        started.close()


@pytest.fixture
def opened(browser: "Browser") -> Iterator[Opened]:
    """Opens pages; in the end none may have complained, or asked for anything but itself."""
    opening = Opened(browser)
    yield opening
    opening.close()
    assert opening.complaints == []
    assert set(opening.requests) <= set(opening.addresses)


@pytest.fixture(scope="session")
def life_database(browser: "Browser", tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One robot that learned the T-hook, tried all tasks with it, and went on when it broke."""
    path = tmp_path_factory.mktemp("browser") / "life.db"
    done("learn", "--tool", "t-hook", "--db", path)
    for goal in ("1", "2", "3", "4"):
        done("solve", "--goal", goal, "--db", path)
    done("break-tool", "--db", path)
    return path


@pytest.fixture(scope="session")
def life(life_database: Path) -> Path:
    """The page of that robot."""
    return page_of(life_database)


@pytest.fixture(scope="session")
def many_database(browser: "Browser", tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A reproduction with one robot: five tools, 96 trials."""
    path = tmp_path_factory.mktemp("browser") / "many.db"
    # Its trials end in every way that trials usually do.
    done("reproduce", "--robots", "1", "--seed", "1000", "--db", path)
    return path


@pytest.fixture(scope="session")
def robots(browser: "Browser", tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a reproduction with two robots."""
    path = tmp_path_factory.mktemp("browser") / "robots.db"
    done("reproduce", "--robots", "2", "--db", path)
    return page_of(path)


@pytest.fixture(scope="session")
def many(many_database: Path) -> Path:
    """The page of that reproduction."""
    return page_of(many_database)
