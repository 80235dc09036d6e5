"""Pipes, narrow terminals, no terminal, no colours, closed streams (fault 35)."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from rich.cells import cell_len

from affcli.cli.terminal import NARROWEST
from tests.cli.program import PROGRAM, Ended, affcli, done, environment, executed
from tests.cli.pseudo_terminal import COLOR, ESCAPE, on_terminal

LEARN = ("learn", "--tool", "stick", "--behaviors", "1200")
SHOWING = {
    "report": ("report",),
    "learn": ("learn", "--tool", "stick", "--behaviors", "5"),
    "solve": ("solve", "--goal", "2"),
    "explain": ("solve", "--goal", "2", "--explain"),
    "break-tool": ("break-tool",),
    "replay": ("replay", "5"),
    "replay of a run": ("replay", "--run", "1", "--steps", "5-6"),
    "verify": ("verify", "--rows", "9"),
    "predict": ("predict", "--pushes", "9"),
    "doctor": ("doctor",),
    "db info": ("db", "info"),
    "db check": ("db", "check"),
    "table list": ("table", "list"),
    "table show": ("table", "show", "1"),
    "sql": ("sql", "select * from affordance_wide limit 3"),
}


def shell(command: str, database: Path) -> Ended:
    """Run a pipe of the shell in which ``affcli`` is the program; the code is the program's own."""
    program = " ".join((*PROGRAM, "$@"))
    script = f"affcli() {{ {program}; }}; set -o pipefail; {command.replace('FILE', str(database))}"
    script = script.replace("$@", '"$@"')
    ended = subprocess.run(
        ["/bin/bash", "-c", script],
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert "Traceback" not in ended.stderr, ended.stderr
    return Ended(ended.returncode, ended.stdout, ended.stderr)


@pytest.mark.fault(35)
@pytest.mark.parametrize(
    "command",
    [
        "affcli report --db FILE | head -1",
        "affcli sql 'select * from affordance_wide' --json --db FILE | head -1",
        "affcli table export --db FILE | head -1",
        "affcli solve --goal 1 --explain --db FILE 2>&- | head -1",
        "affcli learn --tool stick --behaviors 5 --db FILE 2>&1 | true",
        "affcli replay 5 --db FILE 2>&- | head -1",
        "affcli replay --run 1 --steps 1-9 --db FILE 2>&- | head -1",
        "affcli replay 5 --json --db FILE 2>&1 | true",
    ],
)
def test_a_reader_who_has_seen_enough_is_no_failure(command: str, used: Path) -> None:
    ended = shell(command, used)
    assert (ended.code, ended.err) == (0, "")
    assert len(ended.out.splitlines()) <= 1


@pytest.mark.fault(35)
def test_trials_are_done_to_the_end_though_nobody_reads(learned: Path) -> None:
    shell("affcli solve --goal 1 --explain --db FILE | true", learned)
    report = done("report", "--json", "--db", learned).result
    assert sum(cell["tried"] for cell in report["solved"]) == 8


@pytest.mark.fault(35)
def test_closed_streams_are_written_to_in_vain(used: Path) -> None:
    ended = shell("affcli report --db FILE >&-", used)
    assert (ended.code, ended.out, ended.err) == (0, "", "")
    assert shell("affcli replay 5 --db FILE >&- 2>&- <&-", used) == Ended(0, "", "")
    ended = shell("affcli learn --tool stick --behaviors 5 --db FILE 2>&- >/dev/null", used)
    assert ended.code == 0
    assert shell("affcli report --db none.db 2>&-", used) == Ended(3, "", "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
def test_an_output_that_cannot_be_written_is_one_line(used: Path) -> None:
    says = "affcli: the output cannot be written: No space left on device; write it elsewhere\n"
    for command in (
        "report --db FILE",
        "sql 'select 1' --json --db FILE",
        "replay 5 --db FILE",
        "--version",
    ):
        assert shell(f"affcli {command} > /dev/full", used) == Ended(1, "", says)


@pytest.mark.parametrize("encoding", ["ascii", "latin-1"])
def test_what_an_encoding_lacks_is_shown_escaped(encoding: str, used: Path) -> None:
    query = "select 'Čapek 机' as robot"
    ended = executed("sql", query, "--db", used, PYTHONIOENCODING=encoding)
    assert (ended.code, ended.err) == (0, "")
    assert r"\u010capek \u673a" in ended.out
    assert executed("report", "--db", used, PYTHONIOENCODING=encoding).code == 0


@pytest.mark.fault(35)
@pytest.mark.parametrize("columns", [80, 40])
@pytest.mark.parametrize("args", SHOWING.values(), ids=SHOWING.keys())
def test_nothing_is_wider_than_the_screen_or_cut_off(
    args: tuple[str, ...], columns: int, used: Path
) -> None:
    ended = done(*args, "--db", used, COLUMNS=str(columns))
    assert ended.out
    assert max(map(cell_len, ended.out.splitlines())) <= columns
    assert "…" not in ended.out
    assert all(line.isprintable() for line in ended.out.splitlines())


def test_a_reproduction_fits_too(reproduced: Path) -> None:
    for columns in (80, 40):
        out = done("report", "--db", reproduced, COLUMNS=str(columns)).out
        assert max(map(cell_len, out.splitlines())) <= columns
        assert "…" not in out


@pytest.mark.parametrize("columns", ["0", "1", "many", "-5", "999999"])
def test_an_absurd_width_is_no_trouble(columns: str, used: Path) -> None:
    out = done("report", "--db", used, COLUMNS=columns).out
    if columns in {"0", "1"}:
        assert max(map(len, out.splitlines())) <= NARROWEST


@pytest.mark.fault(35)
def test_without_a_terminal_there_are_no_escapes(used: Path) -> None:
    for args in SHOWING.values():
        ended = affcli(*args, "--db", used, TERM="xterm-256color")
        assert "\x1b" not in ended.out + ended.err


def test_progress_is_for_terminals_only(tmp_path: Path) -> None:
    """With one, a bar that names the robot clock, behaviors, rows and resets; else one line."""
    code, shown = on_terminal(*LEARN, "--db", tmp_path / "a.db")
    assert code == 0
    plain = ESCAPE.sub("", shown)
    clock = r"(\d+ h )?\d+ min( \d+ s)?"
    assert re.search(rf"\rstick ━\S* {clock}, \d+ behaviors, \d+ rows?, \d+ resets?", plain)
    ended = executed(*LEARN, "--db", tmp_path / "b.db")
    assert "━" not in ended.err
    assert len(ended.err.splitlines()) == 1
    assert ended.err.strip() in plain


def test_results_go_to_stdout_alone(tmp_path: Path) -> None:
    """On a terminal too: what is piped away is the table or the JSON, nothing else."""
    results = tmp_path / "results.json"
    args = (*LEARN, "--json", "--db", tmp_path / "a.db")
    code, shown = on_terminal(*args, results_to=results)
    assert code == 0
    assert "stick ━" in ESCAPE.sub("", shown)
    (run,) = json.loads(results.read_text())["results"]
    assert run["behaviors"] == 1200


@pytest.mark.parametrize("columns", [40, 80])
def test_no_message_is_broken_inside_a_word(columns: int, used: Path) -> None:
    """On a terminal; for other programs it stays one line."""
    solve = ("solve", "--goal", "2", "--tool", "t-hook", "--start", "1", "--db", used)
    for args in (
        solve,
        ("runs", "delete", "1", "--db", used),
        ("solve", "--goal", "9", *solve[3:]),
    ):
        results = used.with_name("out.txt")
        _, shown = on_terminal(*args, columns=columns, results_to=results)
        lines = ESCAPE.sub("", shown).splitlines()
        said = executed(*args).err
        assert len(said.splitlines()) == 1
        whole = {word for word in said.split() if not word.isdigit()}
        assert whole <= {word for line in lines for word in line.split()}
        assert all(len(line) <= columns or " " not in line for line in lines)


def test_bars_have_a_line_for_each_tool_and_break_no_word(tmp_path: Path) -> None:
    tools = ("--tool", "stick", "--tool", "l-stick", "--behaviors", "1200")
    for columns in (40, 80):
        database = tmp_path / f"{columns}.db"
        _, shown = on_terminal("learn", *tools, "--db", database, columns=columns)
        bars = ESCAPE.sub("", shown)
        assert re.search(r"\rstick   .*\d+ min \d\d s, 500 behaviors[^…]*\nl-stick ", bars)
        assert "…" not in bars


@pytest.mark.fault(35)
def test_colors_are_for_those_who_want_them(used: Path) -> None:
    explain = ("solve", "--goal", "1", "--tool", "stick", "--start", "1", "--explain", "--db", used)
    code, shown = on_terminal(*explain)
    assert code == 1
    assert COLOR.search(shown)
    code, shown = on_terminal(*explain, NO_COLOR="1")
    assert code == 1
    assert not COLOR.search(shown)
    code, shown = on_terminal(*explain, TERM="dumb")
    assert code == 1
    assert not ESCAPE.search(shown)


def test_a_dumb_terminal_gets_no_bar(tmp_path: Path) -> None:
    code, shown = on_terminal(*LEARN, "--db", tmp_path / "a.db", TERM="dumb")
    assert code == 0
    assert not ESCAPE.search(shown)
    assert "Run 1: what the stick affords, by behavior\n" in shown


@pytest.mark.fault(21)
def test_markup_in_names_is_only_text(tmp_path: Path) -> None:
    name = "[bold red]x[].db"
    done("learn", "--tool", "stick", "--behaviors", "5", "--db", name, cwd=tmp_path)
    assert name in done("db", "info", "--db", name, cwd=tmp_path).out
    shown = done("sql", "select '[/]' as '[red]'", "--db", name, cwd=tmp_path).out
    assert shown.split()[0] == "[red]"
    assert shown.split()[-1] == "[/]"


def test_the_program_is_found_by_its_name() -> None:
    script = Path(sys.executable).with_name("affcli")
    shown = subprocess.run([script, "--version"], capture_output=True, text=True, check=True)
    assert shown.stdout == done("--version").out
