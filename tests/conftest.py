"""What holds for all tests."""

import pytest
from hypothesis import settings

settings.register_profile("unhurried", deadline=None)
settings.load_profile("unhurried")  # no test is about speed, and the machine may be busy


def pytest_addoption(parser: pytest.Parser) -> None:
    """Know `--browser`."""
    parser.addoption(
        "--browser",
        action="store_true",
        help="the tests in a real browser must run: no browser is a failure, no skip",
    )
