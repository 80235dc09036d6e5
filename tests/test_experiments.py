"""Each experiment of ``experiments/`` that is a file runs: here with two short robots."""

import json
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from affcli.config import toml_file
from affcli.core.specs import LIVES
from affcli.lab.conducting import begin, run
from affcli.lab.definition import experiment_file, experiment_of
from affcli.lab.experiment import ADAPTATION
from affcli.lab.run_parts import tasks_of
from affcli.store import open_store
from tests.lab.quick import now
from tests.readmes import ROOT

FILES = sorted(
    path for path in (ROOT / "experiments").rglob("*.toml") if "[experiment]" in path.read_text()
)
"""The others are tools and tasks that these name."""
SHORT = {"minutes": 2, "settings": {"trial": {"max_steps": 3}}}
FOLDERS = {
    *(
        "better_robot",
        "camera",
        "carrying_over",
        "exploration",
        "extension_of_reach",
        "grasps",
        "inventing",
    ),
    "lookahead",
    *("planners", "tool_adaptation"),
}
SHORTER = 30.0
"""So many times shorter are the times that conditions have of their own."""


def shortened(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return what a file says, of robots that learn and try for a short time; where there are
    several conditions, with one tool.
    """
    conditions = [
        {key: _shorter(key, value) for key, value in one.items()}
        for one in tables.get("condition", [])
    ]
    base = {**tables.get("base", {}), **SHORT}
    if "tasks" in base:
        base["tasks"] = [re.sub(r"n=\d+", "n=1", text) for text in base["tasks"]]
    if conditions:
        return {**tables, "base": {**base, "tools": ["t-hook"]}, "condition": conditions}
    return {**tables, "base": base}


def _shorter(key: str, value: Any) -> Any:
    """Return what a condition says, with its times shorter."""
    if key == "transfer":
        return re.sub(r"minutes=\d+", "minutes=2", value)
    return value / SHORTER if key == "minutes" else value


def test_each_folder_with_robots_has_its_file() -> None:
    whole = {path.parent.name for path in FILES if path.name == "experiment.toml"}
    assert whole == FOLDERS


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_two_short_robots_live(path: Path, tmp_path: Path) -> None:
    whole, tables = experiment_file(path), toml_file(path, "")
    short = experiment_of(shortened(tables), "a test", path.parent)
    assert [c.name for c in short.conditions] == [c.name for c in whole.conditions]
    with open_store(tmp_path / "short.db", create=True, write=True) as store:
        info = begin(store, replace(short, robots=2), now)
        assert list(run(store, replace(short, robots=2), info, 1, now)) == [0, 1, 2]
        assert store.experiments.named(whole.name).status == "done"
        for condition, (name, session) in zip(short.conditions, info.conditions, strict=True):
            trials = store.trials.trials(session_id=session)
            sets = [text for text in condition.tasks if text != ADAPTATION]
            tasks = sum(len(tasks_of(condition.world, text, 0)) for text in sets)
            broken = 16 * (ADAPTATION in condition.tasks)
            assert len(trials) == 2 * (tasks * len(condition.tools) + broken), name
            assert {trial.spec.robot for trial in trials} == {0, 1}
        assert len(store.sessions.all(*LIVES)) == len(info.conditions)


@pytest.mark.parametrize(
    ("path", "condition", "numbers"),
    [
        ("extension_of_reach/experiment", "base", "extension_of_reach/results"),
        ("extension_of_reach/friction", "half", "extension_of_reach/half_friction"),
        ("extension_of_reach/friction", "double", "extension_of_reach/double_friction"),
        ("camera/experiment", "camera", "camera/results"),
    ],
)
def test_the_numbers_beside_a_file_are_of_its_robots(
    path: str, condition: str, numbers: str
) -> None:
    what = experiment_file(ROOT / "experiments" / f"{path}.toml")
    (own,) = (one for one in what.definition["condition"] if one["name"] == condition)
    settings = ", ".join(f"{k} = {v}" for k, v in own["settings"].items()) or "defaults"
    measured = json.loads((ROOT / "experiments" / f"{numbers}.json").read_text())
    ours = {"robots": what.robots, "seed": what.seed, "sensor": own["sensor"], "settings": settings}
    assert {key: measured[key] for key in ours} == ours
