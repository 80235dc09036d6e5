"""Too little memory from the start of Python on: a command ends by itself, in a line."""

import resource
import subprocess
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from affcli.cli.main import OUT_OF_MEMORY
from tests.cli.program import PATIENCE, PROGRAM, environment, names_in

LITTLE, ENOUGH = 40_000, 240_000
"""Address space (kB) in which Python starts but `learn` cannot, and in which it can."""
STEP, WIDE_STEP = 4_000, 40_000
WORKERS = "2 workers cannot be started"
COMMANDS = (
    ("learn", "--tool", "t-hook", "--behaviors", "60"),
    ("learn", "--tool", "t-hook", "--tool", "stick", "--behaviors", "60", "--workers", "2"),
)


def confine(kilobytes: int) -> None:
    """Let this process have so much address space, and no more."""
    resource.setrlimit(resource.RLIMIT_AS, (1024 * kilobytes, 1024 * kilobytes))


@pytest.mark.fault(46)
@pytest.mark.torture
@pytest.mark.parametrize("args", COMMANDS, ids=("alone", "with workers"))
def test_with_too_little_memory_learn_says_so(
    args: tuple[str, ...], tmp_path: Path, torture: bool, tell: Callable[[str], None]
) -> None:
    """It hung, or OpenBLAS, a traceback or the physics engine ended it."""
    ends: Counter[str] = Counter()
    for kilobytes in range(LITTLE, ENOUGH + 1, STEP if torture else WIDE_STEP):
        ended = subprocess.run(
            [*PROGRAM, *args, "--db", "my.db"],
            cwd=tmp_path,
            env=environment(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            preexec_fn=partial(confine, kilobytes),
            timeout=PATIENCE,
            check=False,
        )
        if ended.returncode == 0:
            ends["learned"] += 1
        else:
            *first, last = ended.stderr.splitlines()
            assert (ended.returncode, last) == (4, f"affcli: {OUT_OF_MEMORY}"), kilobytes
            assert all(WORKERS in line for line in first), (kilobytes, first)
            ends["in a line"] += 1
        assert set(names_in(tmp_path)) <= {"my.db"}, kilobytes
        (tmp_path / "my.db").unlink(missing_ok=True)
    assert ends["in a line"] > ends["learned"] > 0
    tell(f"{ends.total()} limits: {ends['in a line']} ended in a line, {ends['learned']} learned")
