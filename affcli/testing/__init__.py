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

pytest.register_assert_rewrite(*(f"{__name__}.{suite.name}" for suite in iter_modules(__path__)))
