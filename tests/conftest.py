"""What holds for all tests."""

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Know `--browser`."""
    parser.addoption(
        "--browser",
        action="store_true",
        help="the tests in a real browser must run: no browser is a failure, no skip",
    )
