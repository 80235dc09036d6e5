"""A file or folder that cannot be written (fault 16): reading goes on, writing is refused."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cli.program import ROOT, Ended, environment, names_in, one_printable_line

READING = (
    *(("report",), ("sql", "select count(*) from affordance"), ("db", "info")),
    *(("table", "list"), ("table", "show", "1"), ("table", "export"), ("runs", "list")),
    *(
        ("verify", "--rows", "9"),
        ("predict", "--pushes", "9"),
        ("replay", "--run", "1", "--steps", "1-3"),
    ),
)
WRITING = (
    ("learn", "--tool", "stick", "--behaviors", "5"),
    ("solve", "--goal", "2"),
    ("break-tool",),
    ("verify", "--update"),
    ("runs", "note", "1", "x"),
    ("runs", "delete", "1", "--yes"),
    ("reproduce", "--robots", "1"),
    ("db", "upgrade"),
)


@pytest.fixture
def public(learned: Path) -> Iterator[Path]:
    """`learned` in a folder that everybody may enter; pytest's own are for their owner alone."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "kept.db"
        path.write_bytes(learned.read_bytes())
        yield path
        path.parent.chmod(0o755)


def as_nobody(*commands: tuple[str, ...]) -> list[Ended]:
    """Run commands, one after the other, as somebody who may not write."""
    ended = subprocess.run(
        [sys.executable, "-m", "tests.cli.unprivileged", json.dumps(commands)],
        cwd=ROOT,
        env=environment(),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (ended.returncode, ended.stderr) == (0, "")
    results = [Ended(*json.loads(line)) for line in ended.stdout.splitlines()]
    assert len(results) == len(commands)
    return results


@pytest.mark.fault(16)
@pytest.mark.parametrize("what", ["file", "folder"])
def test_reading_works_and_writing_is_refused(what: str, public: Path) -> None:
    public.chmod(0o444 if what == "file" else 0o666)
    public.parent.chmod(0o777 if what == "file" else 0o555)
    before = public.read_bytes()
    results = as_nobody(*((*args, "--db", str(public)) for args in (*READING, *WRITING)))
    for ended in results[: len(READING)]:
        assert ended.code == 0
        assert "affcli: " not in ended.err
        assert ended.out
    for ended in results[len(READING) :]:
        assert (ended.code, ended.out) == (3, "")
        line = one_printable_line(ended.err)
        assert "the file or its folder is read-only; allow yourself to write there" in line
    assert public.read_bytes() == before
    assert names_in(public.parent) == [public.name]


@pytest.mark.fault(16)
@pytest.mark.skipif(os.getuid() != 0, reason="only root can make a file that is another's")
def test_what_may_not_be_read_is_named(public: Path) -> None:
    """A database is exit 3, settings are exit 4."""
    public.chmod(0o000)
    databases = [(*args, "--db", str(public)) for args in (*READING, WRITING[0])]
    settings = (*WRITING[0], "--config", str(public))
    *results, last = as_nobody(*databases, settings)
    for ended in results:
        assert (ended.code, ended.out) == (3, "")
        assert "denied" in one_printable_line(ended.err)
    assert (last.code, last.out) == (4, "")
    assert "Permission denied; give a TOML file that can be read" in one_printable_line(last.err)
