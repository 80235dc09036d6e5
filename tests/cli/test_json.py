"""``--json``: every command answers in the shape, and with the keys, that the README documents."""

import json
from pathlib import Path

import pytest

from affcli.cli.terminal import JSON_FORMAT
from affcli.store import open_store
from tests.cli.program import affcli, done
from tests.cli.test_every_option import commands
from tests.readmes import QUOTED, blocks, table_rows
from tests.states.commands import LOG, MAP
from tests.store.conditions import stored_conditions

COMMANDS = "affcli/cli/README.md"
(SHAPE,) = map(json.loads, blocks(COMMANDS, "json"))
DOCUMENTED = {
    row[0].strip("`"): QUOTED.findall(row[2])
    for row in table_rows(COMMANDS)
    if len(row) == 3 and row[1].startswith("a ") and not row[0].startswith("`affcli")
}
"""The keys of each result, by the command that gives it."""
ANSWERING = [
    " ".join(words)
    for words, command in commands()
    if any("--json" in parameter.opts for parameter in command.params)
]
GIVEN = {
    "learn": "--tool t-hook --behaviors 20",
    "invent": "--tool stick --minutes 6",
    "solve": "--goal 2",
    "verify": "--rows 10",
    "predict": "--pushes 10",
    "replay TRIAL": "5",
    "replay --run": "1",
    "table show": "17",
    "runs show": "1",
    "which": "nearer",
}
"""What a command needs to answer, or to answer soon."""


EXPERIMENT = """
[experiment]
name = "one"
question = "?"
robots = 1
[base]
minutes = 3
tools = ["t-hook"]
trial.max_steps = 2
"""


def called(documented: str) -> str:
    """Return the words that call a command."""
    return " ".join(word for word in documented.split() if word.islower() and word[0] != "-")


def test_every_command_that_answers_in_json_is_documented() -> None:
    assert {called(one) for one in DOCUMENTED} == set(ANSWERING)


def test_the_shape_that_is_documented_is_that_of_this_format() -> None:
    assert list(SHAPE) == ["command", "format", "results"]
    assert SHAPE["format"] == JSON_FORMAT
    assert list(SHAPE["results"][0]) == DOCUMENTED[SHAPE["command"]]


def answer(documented: str, database: Path | None, *more: str | Path) -> list[dict[str, object]]:
    """Return the results of a command, which says its name."""
    words = [word for word in documented.split() if word.islower()]
    named = () if database is None else ("--db", database)
    ended = done(*words, *GIVEN.get(documented, "").split(), *more, "--json", *named)
    assert ended.json["command"] == called(documented)
    assert ended.results
    return ended.results


def keys_of(documented: str) -> list[str]:
    """Return the keys of each result: those that are named, after or without those of others."""
    keys = DOCUMENTED[documented]
    if not keys or keys[0] not in DOCUMENTED:
        return keys
    others, dropped = keys_of(keys[0]), [key for key in keys[1:] if key in keys_of(keys[0])]
    return [key for key in (*others, *keys[1:]) if key not in dropped]


OF_NO_USED_DATABASE = {"camera", "list", "settings", "sql", "compare", "power", "experiment"}
OF_NO_USED_DATABASE |= {"check", "import"}
OF_A_DATABASE = [one for one in DOCUMENTED if one.split()[0] not in OF_NO_USED_DATABASE]


@pytest.mark.parametrize("documented", OF_A_DATABASE)
def test_results_have_the_keys_that_are_documented(
    documented: str, used: Path, reproduced: Path, leisurely: Path
) -> None:
    if documented == "reproduce":
        few = ("--robots", "2", "--workers", "1", "--config", leisurely)
        results = answer(documented, reproduced, *few)
    else:
        results = answer(documented, used)
    assert {tuple(result) for result in results} == {tuple(keys_of(documented))}


@pytest.mark.parametrize("documented", ["compare", "power"])
def test_what_is_said_of_conditions_has_its_keys(documented: str, tmp_path: Path) -> None:
    with open_store(tmp_path / "conditions.db", create=True, write=True) as store:
        first, second, _ = stored_conditions(store)
    named = (f"--session={first}", f"--session={second}")
    (result,) = answer(documented, tmp_path / "conditions.db", *named)
    assert list(result) == DOCUMENTED[documented]


@pytest.mark.parametrize("documented", ["experiment --dry-run", "experiment FILE.toml"])
def test_an_experiment_has_its_keys(documented: str, tmp_path: Path) -> None:
    file = tmp_path / "one.toml"
    file.write_text(EXPERIMENT)
    (result,) = answer(documented, tmp_path / "one.db", file, "--workers", "1")
    assert list(result) == DOCUMENTED[documented]


def test_what_is_said_of_a_file_has_its_keys(tmp_path: Path) -> None:
    file = tmp_path / "one.toml"
    file.write_text(EXPERIMENT)
    (result,) = answer("check", None, file)
    assert list(result) == DOCUMENTED["check"]


def test_what_is_said_of_a_log_has_its_keys(tmp_path: Path) -> None:
    file, how = tmp_path / "log.txt", tmp_path / "map.toml"
    file.write_text(LOG)
    how.write_text(MAP)
    results = answer("import", tmp_path / "log.db", file, "--map", how)
    assert {tuple(result) for result in results} == {tuple(DOCUMENTED["import"])}


@pytest.mark.parametrize("documented", ["list", "settings"])
def test_what_needs_no_database_has_its_keys_too(documented: str) -> None:
    results = answer(documented, None)
    assert {tuple(result) for result in results} == {tuple(DOCUMENTED[documented])}


def test_a_query_answers_with_its_columns(learned: Path) -> None:
    (result,) = answer("sql", learned, "select 1 as one, 2 as x, 3 as x")
    assert result == {"one": 1, "x": 2, "x 2": 3}


def test_an_error_is_a_line_on_stderr_and_an_exit_code(learned: Path) -> None:
    ended = affcli("verify", "--tool", "l-hook", "--json", "--db", learned)
    assert (ended.code, ended.out) == (2, "")
    assert ended.err.startswith("affcli: nothing learned with the l-hook")
