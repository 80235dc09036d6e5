"""What holds for all tests."""

import gc
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from hypothesis import settings

from affcli.cli.main import OBJECTS_BETWEEN_COLLECTIONS

DONE = "done"
"""Under this name a test's report says what it did."""

# Python searches for cycles among all objects again and again, and thousands of collected tests are
# many: rarely while they are made, as the program does, and never among those that are there then.
gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)

# No test is about speed, and the machine may be busy. A property is tried on the same examples each
# time, so that a change that breaks nothing cannot fail; `--torture` looks for new ones, and for
# twice as many.
settings.register_profile("same examples", deadline=None, derandomize=True, max_examples=50)
settings.register_profile("new examples", deadline=None)
settings.load_profile("same examples")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Know `--browser` and `--torture`."""
    parser.addoption(
        "--browser",
        action="store_true",
        help="the tests in a real browser must run: no browser is a failure, no skip",
    )
    parser.addoption(
        "--torture",
        action="store_true",
        help="what is bounded in a normal run runs whole: a hundred kills, readers for a minute",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Look for new examples where there is time for it."""
    if config.getoption("--torture"):
        settings.load_profile("new examples")


def pytest_collection_finish() -> None:
    """Leave what was collected out of every later search for cycles."""
    gc.freeze()


@pytest.fixture
def tell(record_property: Callable[[str, object], None]) -> Callable[[str], None]:
    """Give what a test that did much uses to say how much; `--torture` shows it at the end."""
    return partial(record_property, DONE)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Show what the long tests did."""
    if not terminalreporter.config.getoption("--torture"):
        return
    terminalreporter.section("what was done")
    for reports in terminalreporter.stats.values():
        for report in reports:
            if isinstance(report, pytest.TestReport) and report.when == "call":
                for name, what in report.user_properties:
                    if name == DONE:
                        terminalreporter.line(f"{report.nodeid} ({report.duration:.0f} s): {what}")


@pytest.fixture(scope="session")
def furnished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one of everything that commands read; each test works on a copy of its own."""
    from tests.fuzz.places import furnish

    folder = tmp_path_factory.mktemp("furnished")
    furnish(folder)
    return folder


@pytest.fixture(scope="session")
def torture(request: pytest.FixtureRequest) -> bool:
    """Tell whether the long tests are to run whole."""
    return bool(request.config.getoption("--torture"))
