"""``affcli cite``, and shell completion: the two commands that are about affcli itself."""

import json
import re
import shlex
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from affcli import __version__
from affcli.registry import parts
from tests.cli.program import PROGRAM, ROOT, done, environment, names_in, refused

ENTRY = re.compile(r"@(\w+)\{(\w+),\n((?:  \w+ = \{.*\},\n)+)\}\n")


def entries(text: str) -> dict[str, dict[str, str]]:
    """Return the fields of each BibTeX entry by its kind; there is nothing else in the text."""
    assert ENTRY.sub("", text).strip() == ""
    return {
        kind: dict(re.findall(r"^  (\w+) = \{(.*)\},$", fields, re.MULTILINE))
        for kind, _, fields in ENTRY.findall(text)
    }


def test_it_says_of_paper_and_software_what_the_citation_file_says(tmp_path: Path) -> None:
    found = entries(done("cite", cwd=tmp_path).out)
    stated = (ROOT / "CITATION.cff").read_text()
    for line in (
        f'title: "{found["software"]["title"]}"',
        f"version: {found['software']['version']}",
        f"title: {found['incollection']['title']}",
        f"year: {found['incollection']['year']}",
        f"collection-title: {found['incollection']['booktitle']}",
        f"volume-title: {found['incollection']['series']}",
        f'volume: "{found["incollection"]["volume"]}"',
        f"name: {found['incollection']['publisher']}",
        f"name: {found['software']['author'].strip('{}')}",
    ):
        assert line in stated
    family, given = found["incollection"]["author"].split(", ")
    assert f"family-names: {family}\n        given-names: {given}" in stated
    assert found["software"]["version"] == __version__
    assert "note" not in found["software"]
    assert names_in(tmp_path) == []


def test_it_says_what_a_database_was_made_with_each_set_once(used: Path) -> None:
    def note() -> str:
        return entries(done("cite", "--db", used).out)["software"]["note"]

    alone = note()
    assert alone.startswith(f"Results made with affcli {__version__}, python ")
    assert "pymunk 7" in alone
    assert alone.endswith(", world table@2")
    assert "; and with" not in alone
    assert entries(done("cite", AFFCLI_DB=str(used)).out)["software"]["note"] == alone
    hostile = json.dumps({"affcli": "0.0.9", "x}": "\\input{y} %"})
    with closing(sqlite3.connect(used)) as driver, driver:
        driver.execute("UPDATE session SET versions = ? WHERE id = 1", (hostile,))
    both = note()
    assert both.startswith(alone)
    assert both.removeprefix(alone) == "; and with affcli 0.0.9, x   input y   , world table@2"


def test_a_database_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    assert "none.db" in refused(3, "cite", "--db", tmp_path / "none.db")


BASH = shutil.which("bash")
COMPLETED = {
    "affcli le": ["learn"],
    "affcli learn --re": ["--repertoire", "--resume"],
    "affcli db ": ["upgrade", "backup", "merge", "check", "info"],
    "affcli table export --fo": ["--format", "--force"],
    "affcli learn --tool t": ["t-stick", "t-hook"],
    "affcli learn --tool ": list(parts("tools")),
    "affcli solve --goal 2 --planner ": list(parts("planners")),
}


@pytest.mark.skipif(BASH is None, reason="there is no bash here")
@pytest.mark.parametrize("typed", COMPLETED)
def test_bash_completes_commands_options_and_names(typed: str, tmp_path: Path) -> None:
    """A real bash runs the script that affcli shows, as it does at the press of TAB."""
    program = tmp_path / "affcli"
    program.write_text(f'#!/bin/sh\nexec {shlex.join(PROGRAM)} "$@"\n')
    program.chmod(0o755)
    words = typed.split(" ")
    press = (
        f'PATH={shlex.quote(str(tmp_path))}:$PATH; eval "$(affcli --show-completion bash)"\n'
        f"COMP_WORDS=({' '.join(map(shlex.quote, words))}); COMP_CWORD={len(words) - 1}\n"
        "complete -p affcli | grep -q _affcli_completion || exit 9\n"
        '_affcli_completion affcli; printf "%s\\n" "${COMPREPLY[@]}"\n'
    )
    ended = subprocess.run(
        [str(BASH), "--norc", "-c", press],
        env=environment(PYTHONPATH=str(ROOT)),
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ended.returncode, ended.stderr) == (0, ""), ended
    assert ended.stdout.split() == COMPLETED[typed]


@pytest.mark.skipif(BASH is None, reason="there is no bash here")
def test_completion_is_installed_where_bash_reads_it(tmp_path: Path) -> None:
    ended = subprocess.run(
        [sys.executable, "-m", "affcli", "--install-completion", "bash"],
        env=environment(HOME=str(tmp_path), PYTHONPATH=str(ROOT)),
        capture_output=True,
        text=True,
        check=True,
    )
    script = tmp_path / ".bash_completions" / "affcli.sh"
    assert str(script) in ended.stdout
    assert f"source '{script}'" in (tmp_path / ".bashrc").read_text()
    assert "complete -o default -F _affcli_completion affcli" in script.read_text()
