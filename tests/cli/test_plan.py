"""Plans as they are kept and shown: explained, replayed, drawn; and with each command."""

import shutil
from pathlib import Path

import pytest

from tests.cli.program import affcli, done, refused, rows

AHEAD = ("--planner", "lookahead:depth=2")


@pytest.fixture
def planned(learned: Path) -> Path:
    """A database with a trial of a planner that looks ahead, and then one of the paper's."""
    done("solve", "--goal", "3", "--start", "4", "--tool", "t-hook", *AHEAD, "--db", learned)
    done("solve", "--goal", "3", "--start", "all", "--tool", "t-hook", "--db", learned)
    return learned


def test_the_plan_of_each_step_is_kept_and_replayed_to_the_bit(planned: Path) -> None:
    plans = rows(planned, "SELECT json_extract(reasons, '$[3].moves') FROM step WHERE trial_id = 1")
    assert plans
    assert all("extend arm" in text or "arm" in text for (text,) in plans)
    again = done("replay", "1", "--db", planned)
    assert "plan" in again.out
    assert "the replay equals the record" in again.err


def test_a_plan_is_drawn_and_said(planned: Path, tmp_path: Path) -> None:
    out = tmp_path / "plan.svg"
    said = done("figure", "plan", "1", "1", "--db", planned, "--out", out).err
    assert said.startswith("Trial 1: T-hook, goal 3, start 4, step 1; plan")
    assert out.read_bytes().startswith(b"<?xml")


@pytest.mark.parametrize(
    ("asked", "code", "says"),
    [
        (("2", "1"), 2, "step 1 of trial 2 has no plan: its planner does not look ahead"),
        (("1", "99"), 2, "no step 99 in trial 1"),
        (("9", "1"), 2, "no trial 9"),
        (("1", "0"), 4, "STEP 0: must lie in 1 to"),
    ],
)
def test_a_plan_that_is_not_there(
    planned: Path, tmp_path: Path, asked: tuple[str, ...], code: int, says: str
) -> None:
    out = tmp_path / "plan.svg"
    assert says in refused(code, "figure", "plan", *asked, "--db", planned, "--out", out)
    assert not out.exists()


def test_a_broken_tool_is_used_with_a_planner_of_its_own(learned: Path) -> None:
    (result,) = done("break-tool", *AHEAD, "--json", "--db", learned).results
    assert result["planner"] == "lookahead"
    assert rows(learned, "SELECT DISTINCT planner FROM trial") == [("lookahead",)]


WITHOUT = Path(__file__).parents[1] / "store" / "databases" / "no_plan_0009.db"
"""A stick of five minutes whose lookahead found no plan, made when that was told as no row left."""


def test_a_trial_in_which_no_plan_is_found_is_a_failure_of_its_own_kind(tmp_path: Path) -> None:
    """Whatever lists failures names it; what stands there from before keeps its name."""
    path = Path(shutil.copy(WITHOUT, tmp_path / "my.db"))
    path.chmod(0o644)
    done("db", "upgrade", "--db", path)
    one = (
        "--tool",
        "stick",
        "--goal",
        "4",
        "--start",
        "1",
        "--seed",
        "1",
        "--planner",
        "lookahead",
    )
    ended = affcli("solve", *one, "--explain", "--db", path, COLUMNS="100")
    assert ended.code == 1
    assert "stick, goal 4, start 1, planner lookahead: no plan found (18 steps)" in ended.out
    assert "  rows left: 7 consistent, 7 probable, 3 reachable, 0 expected to move the" in ended.out
    (trial,) = affcli("solve", *one, "--explain", "--json", "--db", path).results
    assert trial["outcome"] == "no plan found"
    assert [reason["rows"] for reason in trial["reasons_at_end"]] == [7, 7, 3, 0]
    (told,) = done("report", "--json", "--db", path).results
    assert told["failures"] == {"no row left": 2, "no plan found": 2}
    assert done("replay", "3", "--db", path).err.endswith(
        "trial 3 ended: no plan found; the replay equals the record, all 18 steps\n"
    )
    assert done("replay", "1", "--db", path).err.endswith(
        "trial 1 ended: no row left; the replay equals the record, all 18 steps\n"
    )
    assert done("replay", "--all", "--db", path).err == (
        "4 of 4 trials equal their record in every step\n"
    )
