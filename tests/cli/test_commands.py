"""The list of commands: what the help says of each is so, and each is found where it says."""

import inspect
import subprocess
import sys
from importlib import import_module

import pytest

from affcli.cli.app import program
from affcli.cli.commands import SECTIONS, Command, Group, goes_on, how_it_goes_on
from tests.cli.program import affcli, done
from tests.readmes import table_rows, words_of

README = "affcli/cli/README.md"

LISTED = [entry for section in SECTIONS.values() for entry in section]
GROUPS = [entry for entry in LISTED if isinstance(entry, Group)]
COMMANDS = [
    *(((entry.name,), entry) for entry in LISTED if isinstance(entry, Command)),
    *(((group.name, entry.name), entry) for group in GROUPS for entry in group.commands),
]
"""Every command with the words that call it."""


@pytest.mark.parametrize(("words", "command"), COMMANDS, ids=lambda given: str(given[0]))
def test_the_list_says_what_the_command_says(words: tuple[str, ...], command: Command) -> None:
    module, _, name = command.home.partition(":")
    function = getattr(import_module(f"affcli.cli.{module}"), name)
    documented = (inspect.getdoc(function) or "").splitlines()[0]
    assert command.help == documented
    assert command.help.endswith((".", "?"))


@pytest.mark.parametrize("columns", ["40", "80", "200"])
@pytest.mark.parametrize("group", [None, *GROUPS], ids=lambda group: group and group.name)
def test_no_sentence_of_the_help_is_cut(group: Group | None, columns: str) -> None:
    entries = LISTED if group is None else group.commands
    shown = done(*([] if group is None else [group.name]), "--help", COLUMNS=columns).out
    as_one_line = " ".join(shown.split())
    for entry in entries:
        assert f" {entry.name} {entry.help}" in as_one_line


EVERY_HELP = [(), *((group.name,) for group in GROUPS), *(words for words, _ in COMMANDS)]


@pytest.mark.parametrize("words", EVERY_HELP, ids=" ".join)
def test_help_is_no_wider_than_the_terminal_and_loses_no_word(words: tuple[str, ...]) -> None:
    narrow, wide = (done(*words, "--help", COLUMNS=columns).out for columns in ("40", "80"))
    assert max(map(len, narrow.splitlines())) <= 40
    assert "".join(narrow.split()) == "".join(wide.split())


@pytest.mark.parametrize(("words", "command"), COMMANDS, ids=lambda given: str(given[0]))
def test_the_help_ends_with_the_example_of_the_readme(
    words: tuple[str, ...], command: Command
) -> None:
    shown = done(*words, "--help").out.splitlines()
    assert shown[-2:] == ["Example:", f"  {command.example}"]
    first = (row[0].strip("`") for row in table_rows(README) if len(row) == 3)
    examples = {words_of(one): one for one in first if one.startswith("affcli ")}
    assert examples[words] == command.example


def test_the_help_lists_commands_under_headings() -> None:
    shown = done("--help").out
    headings = [line[:-1] for line in shown.splitlines() if line.endswith(":") and line[0] != " "]
    assert headings == ["Options", *SECTIONS]


@pytest.mark.parametrize("words", [(), ("db",), ("learn",), ("db", "check")], ids=" ".join)
def test_h_is_short_for_help(words: tuple[str, ...]) -> None:
    shown = done(*words, "-h").out
    assert shown.startswith("Usage: affcli ")
    assert "-h, --help" in shown
    assert shown == done(*words, "--help").out


@pytest.mark.parametrize(
    ("typed", "nearest"),
    [(("lern",), "learn"), (("break",), "break-tool"), (("table", "exprt"), "export")],
)
def test_a_mistyped_command_gets_the_nearest(typed: tuple[str, ...], nearest: str) -> None:
    ended = affcli(*typed)
    assert (ended.code, ended.out) == (2, "")
    assert ended.err.endswith(f"No such command {typed[-1]!r}. Did you mean {nearest!r}?\n")


def test_a_command_imports_no_other_command() -> None:
    """One command's module, and what several share."""
    run = "import sys; from affcli.cli.main import main; main(); print(*sys.modules, sep='\\n')"
    ended = subprocess.run(
        [sys.executable, "-c", run, "solve", "--help"], capture_output=True, text=True, check=True
    )
    homes = {f"affcli.cli.{command.home.partition(':')[0]}" for _, command in COMMANDS}
    assert homes & set(ended.stdout.splitlines()) == {"affcli.cli.solve"}


def test_the_commands_that_go_on_when_given_again() -> None:
    assert [name for name in program.commands if goes_on(name)] == [
        "learn",
        "invent",
        "reproduce",
        "experiment",
    ]
    assert not goes_on("")
    assert not goes_on("figure")


def test_resume_alone_is_offered_only_where_it_does_the_same() -> None:
    same = ", and the same command goes on from there"
    for words, told in (
        (["experiment", "a.toml"], f"{same} (or: --resume)"),
        (["experiment", "a.toml", "--shard", "1/2"], same),
        (["experiment", "--keep=rows", "a.toml"], same),
        (["invent", "--tool", "stick"], f"{same} (or: affcli learn --resume)"),
        (["invent", "--db", "a.db"], f"{same} (or: affcli learn --resume with the same --db)"),
        (["figure", "curve"], ""),
        ([], ""),
    ):
        assert how_it_goes_on(words) == told
