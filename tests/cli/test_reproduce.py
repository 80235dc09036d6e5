"""``affcli reproduce``: the same store for any number of workers, and the numbers it promises."""

from collections import defaultdict
from pathlib import Path
from statistics import fmean
from typing import Any

import pytest

from affcli.simulation.tools.paper import TOOL_PARTS
from tests.cli.program import contents, done, ending, rows, started

PAPER = {
    "stick": (0, 2, 4, 4),
    "l-stick": (4, 2, 4, 4),
    "l-hook": (4, 3, 4, 4),
    "t-stick": (3, 3, 4, 4),
    "t-hook": (4, 4, 4, 4),
}
SPREAD = {"paper", "mean", "mean_ci", "low", "high", "inside"}


def reproduce(database: Path, leisurely: Path, *more: str) -> tuple[str | Path, ...]:
    """Return the command that `reproduced` was made with."""
    return ("reproduce", "--robots", "2", "--config", leisurely, "--db", database, *more)


@pytest.fixture
def value(reproduced: Path, leisurely: Path) -> Any:
    """What the command gives as JSON."""
    return done(*reproduce(reproduced, leisurely, "--json")).result


def test_two_workers_make_the_store_that_one_makes(
    reproduced: Path, leisurely: Path, tmp_path: Path
) -> None:
    both = tmp_path / "both.db"
    with started(*reproduce(both, leisurely, "--workers", "2")) as process:
        ended = ending(process)
    assert (ended.code, ended.err) == (0, f"session 1: 2 robots, seed 0, saved in {both}\n")
    assert contents(both) == contents(reproduced)


def test_the_same_command_again_changes_nothing(reproduced: Path, leisurely: Path) -> None:
    before = reproduced.read_bytes()
    for workers in ("1", "2"):
        ended = done(*reproduce(reproduced, leisurely, "--workers", workers))
        assert ended.out.startswith("Extension of reach: paper|mean of 2 robots [range]\n")
        assert reproduced.read_bytes() == before


def test_a_smaller_reproduction_has_the_same_first_robots(
    reproduced: Path, leisurely: Path, tmp_path: Path
) -> None:
    """Robot i is a function of settings, seed and i, whatever the others are."""
    alone = tmp_path / "alone.db"
    done("reproduce", "--robots", "1", "--config", leisurely, "--db", alone)
    trials = "SELECT tool, shape, goal, start, outcome, steps FROM trial WHERE robot = 0 ORDER BY 1"
    assert sorted(rows(alone, trials)) == sorted(rows(reproduced, trials))
    assert rows(alone, "SELECT count(*) FROM trial") == [(96,)]


def test_json_has_the_keys_that_are_promised(value: Any) -> None:
    assert value.keys() >= {"robots", "cells", "total", "broken", "failures"}
    assert value["robots"] == 2
    where = [(cell["tool"], cell["goal"]) for cell in value["cells"]]
    assert where == [(tool, goal) for tool in TOOL_PARTS for goal in "1234"]
    for cell in value["cells"]:
        assert cell.keys() == SPREAD | {"tool", "goal", "p_paper"}
        assert cell["paper"] == PAPER[cell["tool"]][int(cell["goal"]) - 1]
    assert value["total"].keys() == value["broken"].keys() == SPREAD
    assert (value["total"]["paper"], value["broken"]["paper"]) == (69, 16)
    assert set(value["failures"]) <= {"no row left", "attractor out of reach", "step limit"}


def solved_by_robot(database: Path, where: str) -> list[int]:
    """Return the successes of each robot, counted one trial after the other."""
    solved: dict[int, int] = defaultdict(int)
    for robot, outcome in rows(database, f"SELECT robot, outcome FROM trial WHERE {where}"):
        solved[robot] += outcome == "solved"
    return [solved[robot] for robot in range(2)]


def check(spread: dict[str, Any], counts: list[int]) -> None:
    """Check a spread against what its words say, computed as plainly as can be."""

    def smallest(share: float) -> int:
        """Return the smallest k with P(X <= k) >= share."""
        return next(k for k in range(97) if sum(x <= k for x in counts) / 2 >= share)

    assert spread["mean"] == pytest.approx(fmean(counts))
    assert (spread["low"], spread["high"]) == (smallest(0.025), smallest(0.975))
    # Two robots have no interval, and are too few to hold the paper's count against.
    assert (spread["inside"], spread["mean_ci"]) == (None, None)


def test_the_numbers_are_those_of_the_stored_trials(value: Any, reproduced: Path) -> None:
    whole = "protocol = 'extension of reach'"
    for cell in value["cells"]:
        one = f"{whole} AND tool = '{cell['tool']}' AND goal = '{cell['goal']}'"
        counts = solved_by_robot(reproduced, one)
        check(cell, counts)
        assert cell["p_paper"] == pytest.approx(counts.count(cell["paper"]) / 2)
    check(value["total"], solved_by_robot(reproduced, whole))
    check(value["broken"], solved_by_robot(reproduced, "protocol = 'tool adaptation'"))
    kinds = "SELECT outcome, count(*) FROM trial WHERE outcome <> 'solved' GROUP BY 1"
    assert value["failures"] == dict(rows(reproduced, kinds))
    assert value["trials"] == 2 * 96


def test_the_stick_cannot_pull(value: Any) -> None:
    """Goal 1 lies between the attractor and the robot; a stick alone never gets it there."""
    (cell,) = (c for c in value["cells"] if (c["tool"], c["goal"]) == ("stick", "1"))
    assert (cell["mean"], cell["low"], cell["high"], cell["p_paper"]) == (0, 0, 0, 1)


def test_every_life_is_in_the_store(reproduced: Path) -> None:
    """Five tools learned for an hour, 80 + 16 trials from the table as learned."""
    runs = "SELECT robot, count(*), min(robot_seconds) >= 3600, min(status) FROM learning_run "
    assert rows(reproduced, f"{runs} GROUP BY robot") == [(i, 5, 1, "done") for i in range(2)]
    trials = "SELECT robot, protocol, count(*), max(counters) FROM trial GROUP BY 1, 2"
    assert rows(reproduced, trials) == [
        (robot, protocol, count, "as learned")
        for robot in range(2)
        for protocol, count in (("extension of reach", 80), ("tool adaptation", 16))
    ]
    assert rows(reproduced, "SELECT DISTINCT times_used, times_successful FROM affordance") == [
        (1, 1)
    ]
    assert rows(reproduced, "SELECT kind, robots, status FROM session") == [
        ("reproduce", 2, "done")
    ]
