"""What the README shows is so: queries run, commands and options exist, files are there."""

import re
from functools import cache
from pathlib import Path

import pytest

from affcli.cli.commands import SECTIONS, Group
from tests.cli.program import done, rows

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
QUERIES = re.findall(r"^```sql\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
LISTED = [entry for section in SECTIONS.values() for entry in section]
GROUPS = {entry.name for entry in LISTED if isinstance(entry, Group)}
QUOTED = re.compile(r"`([^`]+)`")


def table_under(heading: str) -> list[list[str]]:
    """Return the cells of the first table under a heading, without its own headings."""
    section = README.split(f"\n## {heading}\n", 1)[1].split("\n## ", 1)[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    return [
        [cell.strip() for cell in line.strip("|").split(" | ")]
        for line in lines[2:]
        if "---" not in line
    ]


@cache
def help_of(*command: str) -> str:
    """Return what a command says of itself."""
    return done(*command, "--help", COLUMNS="200").out


@pytest.fixture(scope="module")
def database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the README's session leaves, in small."""
    folder = tmp_path_factory.mktemp("readme")
    (folder / "few.toml").write_text("[trial]\nmax_steps = 4\n")
    path = folder / "readme.db"
    learn = ("learn", "--tool", "t-hook", "--behaviors", "600")
    done(*learn, "--config", folder / "few.toml", "--db", path)
    done("solve", "--goal", "2", "--db", path)
    done("break-tool", "--db", path)
    return path


def test_there_are_five_queries_to_try() -> None:
    assert len(QUERIES) >= 5


@pytest.mark.parametrize("number", range(len(QUERIES)))
def test_every_query_runs(number: int, database: Path) -> None:
    """How many rows it finds is up to what the robot did."""
    ended = done("sql", QUERIES[number], "--db", database)
    assert ended.err in {"", "no rows\n"}
    assert isinstance(done("sql", QUERIES[number], "--json", "--db", database).json, list)


def commands() -> list[tuple[str, ...]]:
    """Return the commands of the README's table with the options its row names."""
    found = []
    for command, what in table_under("What you can do"):
        for quoted in QUOTED.findall(command):
            program, *words = quoted.split()
            assert program == "affcli"
            names = [word for word in words if re.fullmatch(r"[a-z-]+", word)]
            options = re.findall(r"--[a-z-]+", f"{quoted} {what}")
            subcommand = names[:2] if names[0] in GROUPS else names[:1]
            found.append((" ".join(subcommand), *dict.fromkeys(options)))
    return found


@pytest.mark.parametrize(("command", "options"), [(c, o) for c, *o in commands()])
def test_every_command_and_option_exists(command: str, options: list[str]) -> None:
    described = help_of(*command.split())
    assert described.startswith(f"Usage: affcli {command} ")
    for option in options:
        assert re.search(rf"^  {option}\b", described, re.MULTILINE), option


def test_every_command_is_in_the_table() -> None:
    shown = {command for command, *_ in commands()}
    for entry in LISTED:
        if isinstance(entry, Group):
            assert {f"{entry.name} {command.name}" for command in entry.commands} <= shown
        else:
            assert entry.name in shown


@pytest.mark.parametrize("option", ["--json", "--db", "--config"])
def test_the_options_that_several_commands_share(option: str) -> None:
    assert f"`{option}" in README
    assert f"  {option}" in help_of("learn")


def named_files() -> list[str]:
    """Return the paths in the README's tables; a bare file name is beside the one before it."""
    found: list[str] = []
    for line in README.splitlines():
        if not line.startswith("|"):
            continue
        folder = ""
        for quoted in QUOTED.findall(line):
            if re.fullmatch(r"(affcli|tests|experiments|migrations)/[\w./-]*", quoted):
                found.append(quoted)
                folder = quoted.rpartition("/")[0]
            elif re.fullmatch(r"\w+\.(py|toml|md)", quoted) and folder:
                found.append(f"{folder}/{quoted}")
    return list(dict.fromkeys(found))


@pytest.mark.parametrize("name", named_files())
def test_every_file_in_a_table_exists(name: str) -> None:
    assert (ROOT / name).is_dir() if name.endswith("/") else (ROOT / name).is_file()


def test_the_map_shows_every_room() -> None:
    section = README.split("\n## The map of the rooms\n", 1)[1]
    drawn = section.split("```", 2)[1]
    shown = {line.split()[0] for line in drawn.splitlines() if line.strip()}
    rooms = {f"{path.name}/" for path in (ROOT / "affcli").iterdir() if any(path.glob("*.py"))}
    assert rooms <= shown
    for name in shown - {"affcli/"}:
        assert (ROOT / "affcli" / name).exists() or (ROOT / name).exists(), name


def test_the_data_dictionary_names_every_table_and_view(database: Path) -> None:
    kinds = "SELECT name FROM sqlite_master WHERE type IN ('table', 'view')"
    for (name,) in rows(database, kinds):
        if name != "alembic_version":
            assert f"`{name}`" in README


def test_nothing_is_left_to_be_filled_in() -> None:
    assert "@@" not in README
