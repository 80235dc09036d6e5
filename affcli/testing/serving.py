"""The suites run on one part by its name, for the process at the other end of a pipe.

Not on what stands for a part of another package elsewhere: on the part itself, as it is.
"""

import os
from collections.abc import Callable, Mapping
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import pytest

from affcli import registry
from affcli.child import received
from affcli.core.part import Kind, Part
from affcli.plugins.entry_points import offers
from affcli.plugins.host import loaded
from affcli.testing import rewrite_suites

SUITES_FILE = Path(__file__).with_name("of_part.py")
"""Whose classes are the suites; pytest imports it."""
SUITES: Mapping[Kind, tuple[str, ...]] = {
    "tools": ("TestTool",),
    "bindings": ("TestBinding",),
    "behaviors": ("TestBehaviors",),
    "tasks": ("TestTasks",),
    "planners": ("TestPlanner",),
    "explorers": ("TestExplorer",),
    "sensors": ("TestOwnSensor",),
    "worlds": ("TestWorld", "TestRobot", "TestSensor", "TestExperimenter"),
}
"""Which of its classes are of a kind."""


class Asked:
    """What pytest is told of the part, and tells of the tests.

    Args:
        part: the part itself.
        values: its parameters.
        tell: is told when a test begins, and what came of it.
    """

    def __init__(self, part: Part, values: Mapping[str, Any], tell: Callable[..., None]) -> None:
        self._part, self._values, self._tell = part, values, tell

    @pytest.fixture
    def part(self) -> Part:
        """The part itself."""
        return self._part

    @pytest.fixture
    def build(self) -> Callable[..., Any]:
        """What makes it, its parameters given."""
        return lambda *args: self._part.build(*args, **self._values)

    def pytest_configure(self) -> None:
        """Have the suites say what they compared: this package was imported before pytest ran."""
        rewrite_suites()

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Say that a test begins."""
        self._tell("begun", nodeid)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Say what came of a test, or of what is set up for it."""
        if report.failed or report.when == "call" or report.skipped:
            crash = getattr(report.longrepr, "reprcrash", None)
            why = str(crash.message if crash else report.longrepr) if report.failed else ""
            self._tell("skipped" if report.skipped else report.outcome, report.nodeid, why)


def raw_part(kind: Kind, name: str) -> Part:
    """Return a part as it is: not what stands here for one that runs elsewhere."""
    own = registry.parts(kind).get(name)
    if own is not None:
        return own
    (offer,) = (one for one in offers(kind) if one.name == name)
    return loaded(offer)


def serve(pipe: "Connection[Any, Any]") -> None:
    """Run the suite of the part that is named through a pipe; tell what comes of each test."""
    kind, name, values = received(pipe)()
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"  # what else is installed says nothing here

    def tell(*what: str) -> None:
        pipe.send(what)

    part = raw_part(kind, name)
    suites = [f"{SUITES_FILE}::TestPart", *(f"{SUITES_FILE}::{suite}" for suite in SUITES[kind])]
    quiet = ["-q", "-p", "no:cacheprovider", "-c", os.devnull, "--noconftest"]
    ended = pytest.main(
        [*suites, f"--rootdir={SUITES_FILE.parent}", *quiet], plugins=[Asked(part, values, tell)]
    )
    tell("ended", str(int(ended)))
