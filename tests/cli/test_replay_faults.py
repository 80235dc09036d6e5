"""``affcli replay``: what is asked wrongly, and databases that hold what affcli never wrote."""

from pathlib import Path

import pytest

from tests.cli.program import affcli, names_in, one_printable_line, refused
from tests.cli.test_replay import SOLVED, altered

LARGEST = str(2**63 - 1)

USAGE = {
    "nothing": ((), "what? give one of TRIAL, --run ID and --all"),
    "trial and run": ((SOLVED, "--run", "1"), "what? give one of TRIAL, --run ID and --all"),
    "trial and all": ((SOLVED, "--all"), "what? give one of"),
    "run and all": (("--run", "1", "--all"), "what? give one of"),
    "all three": ((SOLVED, "--run", "1", "--all"), "what? give one of"),
    "two trials": (("1", "2"), "unexpected extra argument"),
    "trial in words": (("first",), "'TRIAL'"),
    "half a trial": (("1.5",), "'TRIAL'"),
    "trial of 5000 digits": (("9" * 5000,), "'TRIAL'"),
    "run in words": (("--run", "first"), "'--run'"),
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


@pytest.mark.parametrize("steps", RANGES)
def test_steps_are_a_number_or_two(steps: str, used: Path) -> None:
    for what in ((SOLVED,), ("--run", "1")):
        line = refused(4, "replay", *what, f"--steps={steps}", "--db", used)
        assert line.endswith("must be a number or two, as in 3-5")


@pytest.mark.parametrize("speed", SPEEDS)
def test_a_speed_lies_in_what_can_be_seen(speed: str, used: Path) -> None:
    for what in ((SOLVED,), ("--run", "1"), (SOLVED, "--gif", "x.gif")):
        line = refused(4, "replay", *what, "--speed", speed, "--db", used, cwd=used.parent)
        assert line.endswith("must lie in 0.05 to 100")
    assert names_in(used.parent) == [used.name]


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


NEVER_WRITTEN = "holds a value that affcli did not write; restore a copy of the database"
UNKNOWN = "holds a value that affcli did not write; restore a copy of the database"
ROW = UNKNOWN

HOSTILE = {
    "tool": ("trial set tool = '<script>'", 3, UNKNOWN),
    "markup": ("trial set shape = '[/]'", 3, UNKNOWN),
    "escape sequence": ("trial set shape = char(27) || '[31mred'", 3, UNKNOWN),
    "goal 9": ("trial set goal = 9", 3, UNKNOWN),
    "goal 0": ("trial set goal = 0", 3, UNKNOWN),
    "start": ("trial set start = -1", 3, UNKNOWN),
    "seed": ("trial set seed = -1", 3, UNKNOWN),
    "robot": ("trial set robot = -9223372036854775808", 3, UNKNOWN),
    "sensor": ("trial set sensor = '<script>'", 3, NEVER_WRITTEN),
    "protocol": ("trial set protocol = '[/]'", 3, NEVER_WRITTEN),
    "counters": ("trial set counters = ''", 3, NEVER_WRITTEN),
    "outcome": ("trial set outcome = 'won'", 3, NEVER_WRITTEN),
    "no run": ("trial set learning_run_id = 99", 3, NEVER_WRITTEN),
    "no session": ("trial set session_id = 99", 3, NEVER_WRITTEN),
    "versions": ("session set versions = '{'", 3, NEVER_WRITTEN),
    "settings": ("learning_run set settings = '{'", 4, "the stored settings: "),
    "NaN": ('learning_run set settings = \'{"trial":{"max_steps":NaN}}\'', 4, "trial.max_steps"),
    "NaN length": (
        'learning_run set settings = \'{"puck":{"radius":NaN}}\'',
        4,
        "puck.radius = nan must lie in",
    ),
    "a script": (
        "learning_run set settings = '{\"<script>\":1}'",
        4,
        "no section <script>; the sec",
    ),
    "settings of nothing": ("learning_run set settings = 'null'", 4, "no sections in them"),
    "behavior": ("affordance set exploratory_behavior = '<script>'", 3, ROW),
    "no parameter": ("affordance set exploratory_params = '{}'", 3, ROW),
    "NaN parameter": ("affordance set exploratory_params = '{\"offset_distance\":NaN}'", 3, ROW),
    "far parameter": ("affordance set exploratory_params = '{\"offset_distance\":1e300}'", 3, ROW),
    "parameters": ("affordance set exploratory_params = '[]'", 3, NEVER_WRITTEN),
    "infinite place": ("affordance set end_object_x = 9e999", 3, ROW),
    "bright colour": ("affordance set start_tool_red = 1e308 where id = 3", 3, NEVER_WRITTEN),
    "far place": ("affordance set start_wrist_to_object_y = -1e300", 3, ROW),
}


@pytest.mark.fault(21)
@pytest.mark.fault(23)
@pytest.mark.parametrize(("change", "code", "says"), HOSTILE.values(), ids=HOSTILE.keys())
def test_a_trial_that_affcli_did_not_write_is_one_line(
    change: str, code: int, says: str, used: Path
) -> None:
    where = f" where id = {SOLVED}" if change.startswith("trial") else ""
    altered(used, f"update {change}{where}")
    before = used.read_bytes()
    for what in ((SOLVED,), (SOLVED, "--json"), ("--all",)):
        ended = affcli("replay", *what, "--db", used)
        assert (ended.code, ended.out) == (code, "")
        assert says in one_printable_line(ended.err)
    assert used.read_bytes() == before


@pytest.mark.parametrize(
    "change",
    [
        "update behavior set wrist_start_x = 9e999",
        "update behavior set true_start_angle = 1e300",
        "update behavior set change_detected = 0",
        "delete from behavior",
    ],
)
def test_without_where_a_row_was_made_it_is_not_known_whether_it_is_lost(
    change: str, used: Path
) -> None:
    altered(used, change)
    line = refused(3, "replay", "21", "--db", used)
    assert f" of learning run 1 {NEVER_WRITTEN}" in line
    assert affcli("replay", SOLVED, "--db", used).code == 0


RUN = "learning run 1 holds a value that affcli did not write; restore"
HOSTILE_RUNS = {
    "tool": ("tool = '<script>'", 3, RUN),
    "escape sequence": ("tool = char(27) || '[31mred'", 3, RUN),
    "seed": ("seed = -1", 3, RUN),
    "robot": ("robot = -1", 3, RUN),
    "behaviors": ("behaviors = -5", 3, RUN),
    "settings": ('settings = \'{"arm":{"forearm":NaN}}\'', 4, "arm.forearm = nan must lie in"),
    "versions": ("versions = '['", 3, NEVER_WRITTEN),
    "checkpoint": ("checkpoint = '{'", 3, NEVER_WRITTEN),
}


@pytest.mark.parametrize(("change", "code", "says"), HOSTILE_RUNS.values(), ids=HOSTILE_RUNS.keys())
def test_a_run_that_affcli_did_not_write_is_one_line(
    change: str, code: int, says: str, learned: Path
) -> None:
    altered(learned, f"update learning_run set {change} where id = 1")
    for what in ((), ("--json",), ("--steps", "1-2")):
        ended = affcli("replay", "--run", "1", *what, "--db", learned)
        if what == ("--steps", "1-2") and "behaviors" in change:
            assert ended.code == 2
            continue
        assert (ended.code, ended.out) == (code, "")
        assert says in one_printable_line(ended.err)
