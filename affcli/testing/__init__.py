"""Suites that hold any part, ours or another's, to the contract of its port (`affcli.core.ports`).

Inherit from a suite and give the fixtures that its docstring names; pytest does the rest::

    from affcli.testing.planner import PlannerContract

    class TestMyPlanner(PlannerContract):
        @pytest.fixture
        def planner(self) -> Planner:
            return MyPlanner()

The suites need pytest; nothing else in affcli does.
"""

import pytest

pytest.register_assert_rewrite(
    *(
        f"{__name__}.{port}"
        for port in ("experimenter", "explorer", "goal", "planner", "robot", "sensor", "world")
    )
)
