"""Names that are more than names, given to every option of every command that takes a text."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from affcli.cli.app import program
from tests.cli.program import affcli, names_in, one_printable_line, refused, rows

DROP = "x'); DROP TABLE learning_run; --"
REQUIRED = {"--goal": "1", "--out": "out.csv", "query": "select 1", "row": "1", "number": "1"}
REQUIRED |= {"--robots": "1", "--workers": "1"}  # all else would be done, too, and take its time
REQUIRED |= {"row_id": "1", "--calibration": "none.json", "image": "none.png"}
REQUIRED |= {"run_id": "1", "text": "x", "way": "nearer"}
REQUIRED |= {"files": "none.txt", "--map": "none.toml"}
FREE = "text"
"""An argument that may be any text: a note."""
ELSEWHERE = ("--db", "--out", "--html", "--gif", "--video")
"""Options that name a file to be written: such a file may have any name."""


def commands(
    group: Any = None, path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield every command with the words that call it."""
    for name, command in (group or program).commands.items():
        if hasattr(command, "commands"):
            yield from commands(command, (*path, name))
        else:
            yield (*path, name), command.loaded


def names_of(command: Any) -> list[str]:
    """Return the options and arguments of a command that take a value."""
    return [
        (parameter.opts or [parameter.name])[0]
        for parameter in command.params
        if not getattr(parameter, "is_flag", False)
    ]


def given(command: tuple[str, ...], names: list[str], name: str, value: str) -> list[str]:
    """Return the words of a command with one value, and what it cannot do without."""
    words = list(command)
    for other, text in (
        {key: REQUIRED[key] for key in REQUIRED if key in names} | {name: value}
    ).items():
        words += [other, text] if other.startswith("--") else [text]
    return words


EVERY = [
    pytest.param(path, names, id=" ".join(path))
    for path, command in commands()
    if (names := names_of(command))
]


@pytest.mark.fault(22)
@pytest.mark.parametrize(("command", "names"), EVERY)
def test_sql_is_inert_wherever_it_is_given(
    command: tuple[str, ...], names: list[str], learned: Path, leisurely: Path
) -> None:
    """Where any text is taken, and files may be named so, last."""
    before = learned.read_bytes()
    for name in sorted(names, key=lambda name: (name == FREE, name in ELSEWHERE)):
        words = given(command, names, name, DROP)
        if "--config" in names and name != "--config":
            words += ["--config", str(leisurely)]
        if "--db" in names and name != "--db":
            words += ["--db", str(learned)]
        ended = affcli(*words, cwd=learned.parent)
        assert ended.code in {0, 2, 3, 4}, (name, ended)
        if ended.code:
            one_printable_line(ended.err)
        if name == FREE:
            assert rows(learned, "SELECT note FROM learning_run WHERE id = 1") == [(DROP,)]
            continue
        assert learned.read_bytes() == before, name
        if name not in ELSEWHERE:
            assert ended.code, (name, ended)
            assert names_in(learned.parent) == [learned.name], name


TOOLS = [(path, names_of(command)) for path, command in commands() if "--tool" in names_of(command)]
PATHS = ("../../x", "/etc/passwd", "./stick", "stick/../stick", "link")


@pytest.mark.fault(20)
@pytest.mark.parametrize(("command", "names"), TOOLS, ids=lambda words: words[0])
def test_a_tool_that_is_a_path_is_no_tool(
    command: tuple[str, ...], names: list[str], learned: Path
) -> None:
    """Also one that leads to a file of the name of a tool."""
    folder = learned.parent / "one" / "two"
    folder.mkdir(parents=True)
    (folder / "stick").write_text("a tool")
    (folder / "link").symlink_to("stick")
    for name in PATHS:
        words = given(command, names, "--tool", name)
        if command[0] == "figure":
            words[words.index("--out") + 1] = "out.png"
        assert "did you mean" in refused(2, *words, *_database(names, learned), cwd=folder)
    assert names_in(folder) == ["link", "stick"]
    assert names_in(learned.parent) == [learned.name, "one"]


def _database(names: list[str], database: Path) -> tuple[str, ...]:
    """Return the option that names the database, where there is one."""
    return ("--db", str(database)) if "--db" in names else ()


SEEDED = [
    (path, names_of(command)) for path, command in commands() if "--seed" in names_of(command)
]


@pytest.mark.fault(36)
@pytest.mark.parametrize(("command", "names"), SEEDED, ids=lambda words: words[0])
def test_every_command_with_a_seed_refuses_one_that_is_none(
    command: tuple[str, ...], names: list[str], tmp_path: Path
) -> None:
    for seed in ("-1", str(2**63), str(10**40)):
        words = given(command, names, "--seed", seed)
        if command[0] == "learn":
            words += ["--tool", "stick"]
        if "--out" in words:
            words[words.index("--out") + 1] = "out.png"
        line = refused(4, *words, cwd=tmp_path)
        assert f"--seed {seed[:30]}" in line
        assert line.endswith("must lie in 0 to 2^63 - 1")
    assert names_in(tmp_path) == []
