"""What all the fuzzing shares: the program, the folder it works in, and the time there is."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import strategies as st

from tests.cli.forked import Forked
from tests.fuzz.budget import fuzz

Fuzz = Callable[..., None]
SECONDS = 30.0
"""After these a command is asked to stop."""
MEMORY = 4 * 2**30
"""Bytes that a command may take beyond what the program has when it is idle."""


@pytest.fixture(scope="session")
def program() -> Iterator[Forked]:
    running = Forked(SECONDS, memory=MEMORY)
    yield running
    running.close()


@pytest.fixture
def fuzzing(torture: bool, tell: Callable[[str], None]) -> Fuzz:
    """Try cases of a kind, and say in the end of the run how many."""

    def run(
        kind: str,
        check: Callable[[Any], None],
        cases: st.SearchStrategy[Any],
        *,
        few: int,
        share: float,
    ) -> None:
        tried = fuzz(kind, check, cases, few=few, share=share if torture else None)
        tell(str(tried))

    return run


@pytest.fixture
def place(furnished: Path, tmp_path: Path) -> Callable[[], Path]:
    """Give a fresh copy of the furnished folder, for each case."""

    def fresh() -> Path:
        outside = tmp_path / "case"
        shutil.rmtree(outside, ignore_errors=True)
        (outside / "temporary").mkdir(parents=True)
        return Path(shutil.copytree(furnished, outside / "home" / "work"))

    return fresh
