"""What holds for all tests."""

import pytest
from hypothesis import settings

settings.register_profile("unhurried", deadline=None)
settings.load_profile("unhurried")  # no test is about speed, and the machine may be busy


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


@pytest.fixture(scope="session")
def torture(request: pytest.FixtureRequest) -> bool:
    """Tell whether the long tests are to run whole."""
    return bool(request.config.getoption("--torture"))
