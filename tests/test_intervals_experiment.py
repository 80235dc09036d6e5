"""The script behind the intervals' README: that it runs, and finds small what it found large."""

import json
import sys
from importlib import import_module
from typing import Any

import pytest

from tests.cli.program import ROOT

INTERVALS = ROOT / "experiments" / "intervals"


@pytest.fixture
def measure(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(INTERVALS)
    yield import_module("measure")
    sys.modules.pop("measure")


def test_few_studies_agree_with_many(measure: Any) -> None:
    found = measure.measured(40, seed=1, sizes=(20,))
    many = json.loads((INTERVALS / "results.json").read_text())
    assert set(found) == set(many)
    for part in ("means", "shares", "alarms"):
        assert set(found[part]["20"]) == set(many[part]["20"])
    assert found["means"]["20"]["total of 80"]["right"] >= 80.0
    assert found["shares"]["20"]["exact, at least"] >= 80.0
    assert found["alarms"]["20"]["conditions swapped"]["any cell"] <= 15.0
    for few, one in zip(found["powers"], many["powers"], strict=True):
        assert abs(few["robots"] - one["robots"]) <= 0.1 * one["robots"] + 1
        assert few["seen"] >= 55.0
