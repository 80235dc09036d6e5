"""A suite that cannot fail is no suite: each broken part is found, by the tests that it breaks."""

from pathlib import Path

import pytest

from tests.conformance import broken

BROKEN = [name for name in vars(broken) if name.startswith("Test")]


class Outcomes:
    """A plugin that keeps which tests failed, by class and name."""

    def __init__(self) -> None:
        self.failed: set[tuple[str, str]] = set()
        self.passed: set[tuple[str, str]] = set()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        _, suite, test = report.nodeid.split("::")
        key = (suite, test.partition("[")[0])
        if report.failed:
            assert report.when == "call", report.longreprtext
            self.failed.add(key)
        elif report.when == "call" and report.passed:
            self.passed.add(key)


@pytest.fixture(scope="module")
def outcomes() -> Outcomes:
    found = Outcomes()
    file = str(Path(broken.__file__))
    quiet = ["-q", "--no-header", "--no-summary", "-p", "no:cacheprovider"]
    pytest.main([file, "-o", "python_files=broken.py", *quiet], plugins=[found])
    return found


@pytest.mark.parametrize("suite", BROKEN)
def test_a_broken_part_fails_the_tests_that_it_breaks_and_passes_others(
    outcomes: Outcomes, suite: str
) -> None:
    failed = {test for found, test in outcomes.failed if found == suite}
    assert failed == getattr(broken, suite).must_fail
    assert any(found == suite for found, _ in outcomes.passed)
