"""What a person types wrong: exit 2 or 4, one line that says what to do, and no file made."""

from pathlib import Path

import pytest

from tests.cli.program import affcli, names_in, refused

TOOLS = (
    "stick or l-stick or l-hook or t-stick or t-hook or mirrored-hook or garden-rake or fork or "
)
TOOLS += "longer-handle or wide-hook"

USAGE = {
    "unknown command": (("lern",), "'lern'. Did you mean 'learn'?"),
    "unknown option": (("learn", "--tol", "stick"), "No such option: --tol"),
    "missing option": (("solve",), "Missing option '--goal'"),
    "missing argument": (("sql",), "Missing argument 'QUERY'"),
    "option without its value": (("learn", "--tool"), "'--tool' requires an argument"),
    "too many arguments": (("report", "extra"), "unexpected extra argument"),
    "option before its command": (("--db", "x.db", "report"), "No such option: --db"),
    "unknown subcommand": (("db", "upgrad"), "Did you mean 'upgrade'?"),
    "no tool": (("learn",), "give --tool stick|l-stick|l-hook|t-stick|t-hook|mirrored-hook|"),
    "unknown tool": (("learn", "--tool", "t-hok"), "no tool 't-hok'; did you mean t-hook or "),
    "far from any tool": (("learn", "--tool", "zzz"), f"did you mean {TOOLS}?"),
    "no name at all": (("learn", "--tool", ""), f"no tool ''; did you mean {TOOLS}?"),
    "one of several tools": (("learn", "--tool", "stick,hook"), "no tool 'hook'; did you mean "),
    "tool and all tools": (("learn", "--all-tools", "--tool", "stick"), "not both"),
    "hours and behaviors": (
        ("learn", "--tool", "stick", "--hours", "1", "--behaviors", "5"),
        "give one of --hours, --minutes and --behaviors",
    ),
    "hours and minutes": (
        ("learn", "--tool", "stick", "--hours", "1", "--minutes", "5"),
        "give one of --hours, --minutes and --behaviors",
    ),
    "hours in words": (("learn", "--tool", "stick", "--hours", "one"), "'--hours'"),
    "behaviors in words": (
        ("learn", "--tool", "stick", "--behaviors", "x"),
        "--behaviors x: must be a",
    ),
    "seed in words": (("learn", "--tool", "stick", "--seed", "abc"), "--seed abc: must be a whole"),
    "seeds from to": (("learn", "--tool", "stick", "--seed", "0-9"), "--seed 0-9: must be a whole"),
    "broken seed": (("learn", "--tool", "stick", "--seed", "1.5"), "--seed 1.5: must be a whole"),
    "robots in words": (("reproduce", "--robots", "many"), "--robots many: must be a whole number"),
    "nothing to replay": (("replay",), "what? give one of TRIAL, --run ID and --all"),
    "trial in words": (("replay", "first"), "TRIAL first: must be a whole number"),
    "unknown option of replay": (("replay", "1", "--step", "2"), "No such option: --step"),
}

LOOKED_UP = {
    "unknown tool": (("solve", "--goal", "1", "--tool", "T-Hook"), "did you mean t-hook"),
    "goal 0": (("solve", "--goal", "0"), "no goal '0'; did you mean 1 or 2 or 3 or 4?"),
    "goal in words": (("solve", "--goal", "near"), "no goal 'near'"),
    "start 5": (("solve", "--goal", "1", "--start", "5"), "did you mean 1 or 2 or 3 or 4 or all?"),
    "start in words": (("solve", "--goal", "1", "--start", "al"), "did you mean all?"),
    "unknown tool to break": (("break-tool", "--tool", "spoon"), "no tool 'spoon'"),
    "unknown broken tool": (("break-tool", "--becomes", "l-hoo"), "did you mean l-hook"),
    "same tool": (("break-tool", "--becomes", "t-hook"), "must be another tool than it was"),
    "unknown shape": (("verify", "--shape", "[/]"), "no tool '[/]'"),
    "unknown tool to predict": (("predict", "--tool", "spoon"), "no tool 'spoon'"),
    "unknown run": (("verify", "--run", "9"), "no learning run 9; they are numbered 1 to 2"),
    "run of another tool": (("predict", "--run", "1", "--tool", "stick"), "is of the t-hook"),
}
"""Names that are looked up among what was learned, and then among what there is."""

BAD_NUMBERS = {
    "hours 0": ("learn", "--tool", "stick", "--hours", "0"),
    "negative hours": ("learn", "--tool", "stick", "--hours", "-1"),
    "negative hours, joined": ("learn", "--tool", "stick", "--hours=-0.5"),
    "hours not a number": ("learn", "--tool", "stick", "--hours", "nan"),
    "infinite hours": ("learn", "--tool", "stick", "--hours", "inf"),
    "hours minus infinity": ("learn", "--tool", "stick", "--hours", "-inf"),
    "hours past the limit": ("learn", "--tool", "stick", "--hours", "10000.1"),
    "minutes 0": ("learn", "--tool", "stick", "--minutes", "0"),
    "minutes past the limit": ("learn", "--tool", "stick", "--minutes", "600000.1"),
    "absurd hours": ("learn", "--tool", "stick", "--hours", "1e308"),
    "behaviors 0": ("learn", "--tool", "stick", "--behaviors", "0"),
    "negative behaviors": ("learn", "--tool", "stick", "--behaviors", "-5"),
    "absurd behaviors": ("learn", "--tool", "stick", "--behaviors", "1" + "0" * 30),
    "robots 0": ("reproduce", "--robots", "0"),
    "negative robots": ("reproduce", "--robots", "-3"),
    "absurd robots": ("reproduce", "--robots", "1" + "0" * 30),
    "workers 0": ("reproduce", "--workers", "0"),
    "absurd workers": ("reproduce", "--workers", "100000"),
    "run 0": ("replay", "--run", "0"),
    "absurd run": ("replay", "--run", "1" + "0" * 30),
    "speed 0": ("replay", "1", "--speed", "0"),
    "speed not a number": ("replay", "1", "--speed", "nan"),
    "steps backwards": ("replay", "1", "--steps", "5-3"),
}


@pytest.mark.parametrize(("args", "says"), USAGE.values(), ids=USAGE.keys())
def test_what_does_not_exist_is_a_usage_error(
    args: tuple[str, ...], says: str, tmp_path: Path
) -> None:
    assert says in refused(2, *args, cwd=tmp_path)
    assert names_in(tmp_path) == []


@pytest.mark.parametrize(("args", "says"), LOOKED_UP.values(), ids=LOOKED_UP.keys())
def test_a_name_that_nothing_has_is_a_usage_error(
    args: tuple[str, ...], says: str, learned: Path
) -> None:
    before = learned.read_bytes()
    assert says in refused(2, *args, "--db", learned)
    assert learned.read_bytes() == before


@pytest.mark.parametrize("args", BAD_NUMBERS.values(), ids=BAD_NUMBERS.keys())
def test_a_number_out_of_range_is_bad_input(args: tuple[str, ...], tmp_path: Path) -> None:
    line = refused(4, *args, cwd=tmp_path)
    option = next(arg.partition("=")[0] for arg in args if arg.startswith("--") and arg != "--tool")
    assert option in line
    assert "must " in line
    assert names_in(tmp_path) == []


def test_a_seed_of_5000_digits_is_refused(tmp_path: Path) -> None:
    assert "--seed" in refused(2, "learn", "--tool", "stick", "--seed", "9" * 5000, cwd=tmp_path)


STRANGE = {
    "markup": "[/]",
    "escape sequence": "\x1b[31mred\x1b[0m",
    "carriage return": "t-hook\r\nall is well",
    "no character at all": b"\xff\xfe",
    "right to left": "\u202et-hook",
    "10 kB": "x" * 10_000,
    "SQL": "x'); DROP TABLE learning_run; --",
    "a path": "../../etc/passwd",
    "an option": "--",
}


@pytest.mark.fault(20)
@pytest.mark.fault(21)
@pytest.mark.fault(22)
@pytest.mark.parametrize("name", STRANGE.values(), ids=STRANGE.keys())
def test_a_strange_name_is_one_printable_line(name: str | bytes, learned: Path) -> None:
    """As a tool, a start, a goal, a number, a command, an option."""
    strange = (("solve", "--goal", "1", "--start", name), ("solve", "--goal", name))
    for args in (*strange, ("learn", "--tool", name), ("replay", name), ("replay", "--run", name)):
        refused(2, *args, "--db", learned)
    as_bytes = name if isinstance(name, bytes) else name.encode()
    refused(2, "report", b"--no" + as_bytes, "--db", learned)
    if name != "--":
        refused(2, name)
    assert names_in(learned.parent) == [learned.name]


@pytest.mark.parametrize("args", [(), ("db",)], ids=["affcli", "affcli db"])
def test_without_a_command_it_shows_its_help(args: tuple[str, ...], tmp_path: Path) -> None:
    ended = affcli(*args, cwd=tmp_path)
    assert (ended.code, ended.err) == (0, "")
    assert ended.out.startswith("Usage: affcli ")
    assert ended.out == affcli(*args, "--help", cwd=tmp_path).out


def test_help_and_version_are_results(tmp_path: Path) -> None:
    for args in (("--help",), ("learn", "--help"), ("replay", "--help"), ("db", "info", "--help")):
        ended = affcli(*args, cwd=tmp_path)
        assert (ended.code, ended.err) == (0, "")
        assert ended.out.startswith("Usage: ")
    ended = affcli("--version", cwd=tmp_path)
    assert (ended.code, ended.err) == (0, "")
    assert ended.out.startswith("affcli ")
    assert names_in(tmp_path) == []
