"""What is around the program, and meant for others, decides nothing: variables, caches, folders."""

import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest

from tests.cli.program import ROOT, Ended, contents, done, environment, names_in, refused

NOWHERE = """
import sys, tempfile
tempfile._candidate_tempdir_list = lambda: ["/proc"]
from affcli.cli.main import main
sys.exit(main())
"""
"""A program that finds no folder for temporary files."""


def drawn(folder: Path, *python: str, **changes: str) -> Ended:
    """Draw a figure as a shell does, with other variables."""
    ended = subprocess.run(
        [sys.executable, *python, "figure", "tools", "--out", str(folder / "a.pdf")],
        cwd=ROOT,
        env=environment(**changes),
        capture_output=True,
        text=True,
        check=False,
    )
    return Ended(ended.returncode, ended.stdout, ended.stderr)


def said(folder: Path) -> Ended:
    """Return how a figure ends that nothing disturbs."""
    return Ended(
        0,
        "",
        f"The tools, to scale; T-hook that became L-hook; default settings: {folder / 'a.pdf'}\n",
    )


@pytest.mark.parametrize(
    "backend", ["module://matplotlib_inline.backend_inline", "QtAgg", "nonsense"]
)
def test_a_notebooks_backend_does_not_matter(backend: str, tmp_path: Path) -> None:
    """Every notebook exports one, to programs that it starts too."""
    assert drawn(tmp_path, "-m", "affcli", MPLBACKEND=backend) == said(tmp_path)


def test_nothing_but_the_folder_of_the_figure_can_be_written(tmp_path: Path) -> None:
    """No home, no cache, no folder for temporary files: the figure, and not a word of that."""
    home = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "TMPDIR"), "/proc/none")
    assert drawn(tmp_path, "-c", NOWHERE, **home) == said(tmp_path)
    assert names_in(tmp_path) == ["a.pdf"]


def test_a_cache_that_cannot_be_made_is_not_spoken_of(tmp_path: Path) -> None:
    ended = drawn(tmp_path, "-m", "affcli", MPLCONFIGDIR="/proc/none", TMPDIR=str(tmp_path))
    assert ended == said(tmp_path)
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    assert names_in(tmp_path) == ["a.pdf"]


@pytest.mark.fault(46)
@pytest.mark.parametrize(
    "error",
    [
        *(MemoryError(), ValueError("what came of it"), OSError(12, "Cannot allocate memory")),
        ImportError("x.so: failed to map segment from shared object"),
        SystemError("error return without exception set"),
        SystemError("<function f> returned NULL without setting an exception"),
    ],
    ids=repr,
)
def test_too_little_memory_is_one_line(
    error: Exception, empty: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ask(*_: object, **__: object) -> None:
        if isinstance(error, ValueError):
            try:
                bytes(1 << 62)
            except MemoryError:
                raise error  # noqa: B904  # as libraries do while they close what is open
        raise error

    monkeypatch.setattr("affcli.store.health.one_state", ask)
    assert "memory ran out; what was saved is kept; ask for less" in refused(
        4, "db", "info", "--db", empty
    )


USED = (
    *("learn --tool t-hook --behaviors 40 --set trial.max_steps=3", "solve --goal 2"),
    *("verify --update --rows 3", "report", "report --html new.html --force", "replay --all"),
    *("figure results --out new.svg --force", "db backup --force", "db check", "cite"),
)


@pytest.mark.fault(43)
@pytest.mark.parametrize("years", [(1901,), (2600,), (9999, 2001, 1969)])
def test_the_clock_decides_nothing(
    years: tuple[int, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It stands in another century, or goes back between two commands."""
    for line in USED:
        done(*line.split(), "--db", "usual.db", cwd=tmp_path)

    class Clock(datetime):
        @classmethod
        def now(cls, tz: object = None) -> "Clock":
            return cls(years[number % len(years)], 1, 2, tzinfo=UTC)

    monkeypatch.setattr("affcli.lab.clock.datetime", Clock)
    for number, line in enumerate(USED):  # noqa: B007 the clock asks for it
        done(*line.split(), "--db", "other.db", cwd=tmp_path)
    assert contents(tmp_path / "other.db") == contents(tmp_path / "usual.db")
