"""Suites that hold any part, ours or another's, to the contract of its port (`affcli.core.ports`).

Inherit from a suite and give the fixtures that its docstring names; pytest does the rest::

    from affcli.testing.planner import PlannerContract

    class TestMyPlanner(PlannerContract):
        @pytest.fixture
        def planner(self) -> Planner:
            return MyPlanner()

The suites need pytest; nothing else in affcli does.
"""

from pkgutil import iter_modules

import pytest


def rewrite_suites() -> None:
    """Have pytest rewrite the asserts of the suites, so that they say what they compared."""
    pytest.register_assert_rewrite(
        *(f"{__name__}.{suite.name}" for suite in iter_modules(__path__))
    )


rewrite_suites()
