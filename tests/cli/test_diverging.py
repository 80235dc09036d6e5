"""The physics engine gives a number that is not finite: such a trial counts for nothing."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.program import (
    PATIENCE,
    Arg,
    Ended,
    contents,
    done,
    environment,
    one_printable_line,
    rows,
)

DIVERGING = """
import sys
from itertools import count

from affcli.cli.main import main
from affcli.core.geometry import Pose
from affcli.simulation.puck_and_tool import PuckAndTool

nan, after, times = float(sys.argv.pop(1)), int(sys.argv.pop(1)), int(sys.argv.pop(1))
finite, pushes = PuckAndTool.puck_pose, count(1)


def pose(table):
    diverges = after < next(pushes) <= after + times
    return Pose(nan, 20.0, 0.0) if diverges else finite(table)


PuckAndTool.puck_pose = pose
sys.exit(main())
"""
"""The program with an engine that diverges so many times after so many pushes that touch."""


def diverging(number: str, after: int, *args: Arg, times: int = 10**9) -> Ended:
    """Run the program whose engine gives a number that is none."""
    ended = subprocess.run(
        [sys.executable, "-c", DIVERGING, number, str(after), str(times), *args],
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert "Traceback" not in ended.stderr, ended.stderr
    return Ended(ended.returncode, ended.stdout, ended.stderr)


SOLVE = ("solve", "--goal", "2", "--tool", "t-hook")


@pytest.mark.fault(29)
@pytest.mark.parametrize("number", ["nan", "inf", "-inf"])
def test_a_trial_that_diverges_is_invalid_and_no_success(number: str, learned: Path) -> None:
    """Its last behavior counts neither for nor against the row that it used."""
    ended = diverging(number, 2, *SOLVE, "--start", "1", "--db", learned)
    assert ended.code == 4
    assert "invalid (2)" in ended.out
    said, saved = ended.err.splitlines()
    assert said == "trial 1 counts for nothing: the simulation gave a number that is not finite"
    assert saved.startswith("trial 1 saved; to see why each row was chosen: affcli replay 1")
    assert rows(learned, "SELECT outcome, steps FROM trial") == [("invalid", 2)]
    uses = "SELECT sum(times_used - 1), sum(times_successful - 1) FROM affordance"
    assert rows(learned, uses) == rows(learned, "SELECT count(*), sum(replicated) FROM step")
    done("db", "check", "--db", learned)


@pytest.mark.fault(29)
def test_no_report_counts_it(learned: Path) -> None:
    diverging("nan", 0, *SOLVE, "--db", learned)
    assert rows(learned, "SELECT DISTINCT outcome, count(*) FROM trial") == [("invalid", 4)]
    told = done("report", "--json", "--db", learned).result
    assert (told["solved"], told["trials"], told["failures"]) == ([], 0, {})
    assert told["invalid"] == 4
    shown = " ".join(done("report", "--db", learned).out.split())
    assert "4 invalid trials left out: the simulation or a plug-in failed" in shown
    page = learned.with_suffix(".html")
    done("report", "--db", learned, "--html", page)
    assert "no trial of this one counts yet" in page.read_text()
    assert "Invalid trials: 4." in page.read_text()


@pytest.mark.fault(29)
def test_a_robot_of_a_reproduction_goes_on_with_its_other_trials(
    leisurely: Path, tmp_path: Path
) -> None:
    """One push of some trial with the first tool diverges."""
    database = tmp_path / "my.db"
    command = ("reproduce", "--robots", "1", "--workers", "1", "--config", leisurely)
    told = diverging("nan", 40, *command, "--json", "--db", database, times=1).result
    outcomes = "SELECT count(*), sum(outcome = 'solved'), sum(outcome = 'invalid') FROM trial"
    ((trials, solved, invalid),) = rows(database, outcomes)
    assert (trials, invalid, told["invalid"]) == (96, 1, 1)
    assert told["trials"] == 95
    assert round(told["total"]["mean"] + told["broken"]["mean"]) == solved
    assert trials - invalid - solved == sum(told["failures"].values())


@pytest.mark.fault(29)
def test_learning_that_diverges_keeps_what_was_saved_and_goes_on_when_it_is_mended(
    tmp_path: Path,
) -> None:
    database, alone = tmp_path / "my.db", tmp_path / "alone.db"
    learn = ("learn", "--tool", "t-hook", "--behaviors", "1100")
    ended = diverging("nan", 200, *learn, "--db", database)
    assert ended.code == 4
    assert "gave Pose(x=nan" in one_printable_line(ended.err)
    ((kept, status),) = rows(database, "SELECT behaviors, status FROM learning_run")
    assert (kept > 0, status) == (True, "running")
    assert rows(database, "SELECT count(*) FROM behavior") == [(kept,)]
    done(*learn, "--db", database)
    done(*learn, "--db", alone)
    for table in ("behavior", "affordance"):
        assert rows(database, f"SELECT * FROM {table}") == rows(alone, f"SELECT * FROM {table}")


@pytest.mark.fault(29)
def test_a_verification_that_diverges_leaves_the_table_as_it_was(learned: Path) -> None:
    """It is saved whole or not at all."""
    before = contents(learned)
    ended = diverging("nan", 5, "verify", "--update", "--rows", "9", "--db", learned)
    assert ended.code == 4
    assert "gave Pose(x=nan" in one_printable_line(ended.err)
    assert contents(learned) == before
