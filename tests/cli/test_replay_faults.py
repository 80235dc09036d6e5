"""``affcli replay``: what is asked wrongly, and databases that hold what affcli never wrote."""

from pathlib import Path

import pytest

from tests.cli.program import affcli, names_in, refused
from tests.cli.test_replay import SOLVED, altered

LARGEST = str(2**63 - 1)

USAGE = {
    "nothing": ((), "what? give one of TRIAL, --run ID and --all"),
    "trial and run": ((SOLVED, "--run", "1"), "what? give one of TRIAL, --run ID and --all"),
    "trial and all": ((SOLVED, "--all"), "what? give one of"),
    "run and all": (("--run", "1", "--all"), "what? give one of"),
    "all three": ((SOLVED, "--run", "1", "--all"), "what? give one of"),
    "two trials": (("1", "2"), "unexpected extra argument"),
    "trial in words": (("first",), "TRIAL "),
    "half a trial": (("1.5",), "TRIAL "),
    "trial of 5000 digits": (("9" * 5000,), "TRIAL "),
    "run in words": (("--run", "first"), "--run "),
    "unknown trial": (("41",), "no trial 41; they are numbered 1 to 40"),
    "largest trial": ((LARGEST,), f"no trial {LARGEST}; they are numbered 1 to 40"),
    "unknown run": (("--run", "3"), "no learning run 3; they are numbered 1 to 2"),
    "largest run": (("--run", LARGEST), f"no learning run {LARGEST}; they are"),
    "unknown step": ((SOLVED, "--steps", "5"), "no step 5 in trial 5; it has 4"),
    "beyond the steps": ((SOLVED, "--steps", "2-999999999"), "no step 999999999 in trial 5; it"),
    "unknown behavior": (
        ("--run", "1", "--steps", "799-801"),
        "no behavior 801 in run 1; it has 800",
    ),
    "speed in words": ((SOLVED, "--speed", "fast"), "'--speed'"),
    "steps of all": (
        ("--all", "--steps", "1"),
        "--all shows no steps: leave out --steps and --spe",
    ),
    "speed of all": (("--all", "--speed", "1"), "--all shows no steps: leave out"),
    "speed of json": (
        (SOLVED, "--json", "--speed", "1"),
        "--json plays nothing: leave out --speed",
    ),
    "film of a run": (("--run", "1", "--gif", "x.gif"), "--gif is of one trial: give TRIAL"),
    "film of all": (("--all", "--gif", "x.gif"), "--gif is of one trial: give TRIAL"),
}

RANGES = (
    *("5-3", "x", "1e9", "0", "0-2", "-1", "1-", "-", "", "1-2-3", "1,2", " 1", "1\n", "\u0663"),
    *("9" * 10, "9" * 10_000, "\x1b[31m", "[/]", "1.5", "+1", "0x1"),
)
SPEEDS = ("nan", "inf", "-inf", "0", "-1", "0.049", "100.1", "1e308", "1e-320", "-0.0")


@pytest.mark.parametrize(("args", "says"), USAGE.values(), ids=USAGE.keys())
def test_what_does_not_exist_is_a_usage_error(args: tuple[str, ...], says: str, used: Path) -> None:
    before = used.read_bytes()
    assert says in refused(2, "replay", *args, "--db", used, cwd=used.parent)
    assert names_in(used.parent) == [used.name]
    assert used.read_bytes() == before


@pytest.mark.parametrize("number", ["0", "-1", str(-(2**63)), str(2**63), str(10**40)])
def test_numbers_that_no_record_has_are_bad_input(number: str, used: Path) -> None:
    for args in (("--run", number), ("--", number)):
        line = refused(4, "replay", "--db", used, *args)
        assert f" {number[:30]}" in line
        assert line.endswith(f"must lie in 1 to {LARGEST}")


def test_steps_are_a_number_or_two(tmp_path: Path) -> None:
    for steps in RANGES:
        line = refused(4, "replay", "1", f"--steps={steps}", cwd=tmp_path)
        assert line.endswith("must be a number or two, as in 3-5")


def test_a_speed_lies_in_what_can_be_seen(tmp_path: Path) -> None:
    for speed in SPEEDS:
        for what in (("1",), ("--run", "1"), ("1", "--gif", "x.gif")):
            line = refused(4, "replay", *what, "--speed", speed, cwd=tmp_path)
            assert line.endswith("must lie in 0.05 to 100")
    assert names_in(tmp_path) == []


def test_an_empty_database_has_nothing_to_replay(empty: Path) -> None:
    says = {
        "1": "no trial 1; there are none yet",
        "--run=1": "no learning run 1; there are none yet",
        "--all": "no trials yet; first run: affcli solve --goal 1",
    }
    for what, line in says.items():
        assert refused(2, "replay", what, "--db", empty) == f"affcli: {line}"


@pytest.mark.parametrize("what", ["1", "--run=1", "--all"])
def test_without_a_database_there_is_nothing_to_replay(what: str, tmp_path: Path) -> None:
    (tmp_path / "diary.db").write_text("Dear diary,\n" * 500)
    assert "none.db: no database there" in refused(
        3, "replay", what, "--db", "none.db", cwd=tmp_path
    )
    line = refused(3, "replay", what, "--db", "diary.db", cwd=tmp_path)
    assert "not a SQLite database" in line
    assert names_in(tmp_path) == ["diary.db"]


def test_without_where_a_row_was_made_it_is_not_known_whether_it_is_lost(used: Path) -> None:
    altered(used, "delete from behavior")
    line = refused(3, "replay", "21", "--db", used)
    assert "learning run 1 lacks behaviors that made its rows; restore a copy" in line
    assert affcli("replay", SOLVED, "--db", used).code == 0


def test_where_no_trial_can_be_replayed_none_differs(used: Path) -> None:
    """The exit code is that of what prevents it, as for a single trial; each reason comes once."""
    altered(used, """update learning_run set settings = '{"new.flag":1}'""")
    reason = refused(3, "replay", SOLVED, "--db", used).removeprefix("affcli: ")
    none = "0 of 0 replayed trials equal their record in every step; 40 could not be replayed"
    assert refused(3, "replay", "--all", "--db", used) == f"affcli: {none}: {reason}"
    altered(used, "update trial set world = 'table@7' where id in (2, 3)")
    line = refused(3, "replay", "--all", "--db", used)
    numbers = "1, 4, 5, 6, 7, 8, 9, 10, 11, 12 and 28 more"
    assert line.startswith(f"affcli: {none}: {reason} (trials {numbers}), made in version 7 of ")
    assert line.endswith(" (trials 2, 3)")


def test_what_cannot_be_replayed_is_counted_apart_from_what_equals_its_record(used: Path) -> None:
    altered(used, "update trial set shape_key = null where id in (2, 3)")
    ended = affcli("replay", "--all", "--db", used)
    assert ended.code == 1
    reason, says = ended.err.splitlines()
    assert reason.startswith("trials 2, 3 could not be replayed: this affcli does not know what a ")
    assert says == (
        "38 of 38 replayed trials equal their record in every step; 2 could not be replayed"
    )
