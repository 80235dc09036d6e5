"""The READMEs of the repository, taken apart: sections, tables, blocks of code, commands."""

import re
import shlex
from functools import cache
from pathlib import Path
from typing import NamedTuple

from affcli.cli.commands import SECTIONS, Group

ROOT = Path(__file__).parents[1]
READMES = sorted(
    str(path.relative_to(ROOT))
    for folder in (".", "affcli", "migrations", "tests", "experiments")
    for path in (ROOT.glob("README.md") if folder == "." else (ROOT / folder).rglob("README.md"))
)
QUOTED = re.compile(r"`([^`\n]+)`")
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LISTED = [entry for section in SECTIONS.values() for entry in section]
GROUPS = {entry.name for entry in LISTED if isinstance(entry, Group)}


class Step(NamedTuple):
    """A command of a console block, and the lines that the README shows as its output."""

    command: str
    shown: list[str]


@cache
def text_of(readme: str) -> str:
    """Return a README."""
    return (ROOT / readme).read_text(encoding="utf-8")


def blocks(readme: str, language: str) -> list[str]:
    """Return the blocks of code in a language."""
    return [code for kind, code in BLOCK.findall(text_of(readme)) if kind == language]


def prose(readme: str) -> str:
    """Return a README without its blocks of code."""
    return BLOCK.sub("", text_of(readme))


def steps(console: str) -> list[Step]:
    """Return what a console block runs, in order."""
    found: list[Step] = []
    for line in console.splitlines():
        if line.startswith("$ "):
            found.append(Step(line[2:].partition("  #")[0].strip(), []))
        else:
            found[-1].shown.append(line)
    return found


def quoted_commands(readme: str) -> list[str]:
    """Return the affcli commands in the text of a README, each once."""
    quoted = (code.strip() for code in QUOTED.findall(prose(readme)))
    return list(dict.fromkeys(code for code in quoted if code.startswith("affcli ")))


def all_commands(readme: str) -> list[str]:
    """Return the affcli commands of a README, in its text and in its console blocks."""
    run = [step.command for block in blocks(readme, "console") for step in steps(block)]
    single = [part.strip() for command in run for part in command.split(" && ")]
    return quoted_commands(readme) + [one for one in single if one.startswith("affcli ")]


def words_of(command: str) -> tuple[str, ...]:
    """Return the words that call a command: ``table list`` of ``affcli table list --tool x``."""
    names = shlex.split(command)[1:3]
    if not re.fullmatch(r"[a-z][a-z-]*", "".join(names[:1])):
        return ()
    return tuple(names[:2] if names and names[0] in GROUPS else names[:1])


def table_rows(readme: str) -> list[list[str]]:
    """Return the cells of all tables of a README, row by row."""
    lines = [line for line in prose(readme).splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def anchors(readme: str) -> set[str]:
    """Return what a link within a README can lead to: its headings as GitHub spells them."""
    headings = re.findall(r"^#+ (.+)$", prose(readme), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", one.lower()).replace(" ", "-") for one in headings}
