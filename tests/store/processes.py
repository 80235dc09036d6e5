"""Starting the functions of ``children`` as processes."""

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[2]


@contextmanager
def child(what: str, path: Path, *more: str, wait: bool = True) -> Iterator[subprocess.Popen[str]]:
    """Run a function of ``children`` beside the test; kill it at the end if it still runs.

    Args:
        what: the function.
        path: the database.
        more: what else the function is told.
        wait: go on only when it says that it is ready.
    """
    command = [sys.executable, "-m", "tests.store.children", what, str(path), *more]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, cwd=ROOT, stdin=pipe, stdout=pipe, stderr=pipe, text=True
    ) as process:
        try:
            if wait:
                assert process.stdout is not None
                line = process.stdout.readline()
                assert line == "ready\n", process.communicate()
            yield process
        finally:
            process.kill()


def finished(what: str, path: Path, *more: str) -> tuple[int, str, str]:
    """Run a function of ``children`` to its end; return exit code, stdout and stderr."""
    with child(what, path, *more, wait=False) as process:
        out, err = process.communicate(timeout=300)
    return process.returncode, out, err
