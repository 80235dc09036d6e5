"""What must hold of a command that ended, whatever it was."""

import json
import os
import signal
import sqlite3
from contextlib import closing
from pathlib import Path

from tests.cli.forked import Finished

LONGEST_LINE = 1100
SPEAKING_FIRST = ("learn", "reproduce", "db upgrade")
"""What these say of finished work may stand before the line of a refusal."""
REPORTING = ("db check", "doctor", "camera calibrate", "camera locate")
"""These tell what is wrong on stdout."""


def check_ending(name: str, ended: Finished) -> None:
    """Check what holds of every command, however it was called.

    Args:
        name: of the command, with blanks between its words.
        ended: what it did.
    """
    assert "Traceback" not in ended.err, ended.err
    if ended.stopped:
        assert ended.code == 128 + signal.SIGTERM, f"does not stop: {ended}"
        return
    assert ended.code in {0, 1, 2, 3, 4}, ended
    lines = ended.err.removesuffix("\n").split("\n")
    if ended.code in {2, 3, 4} and not (ended.code == 2 and "Usage:" in ended.err):
        if not (ended.code == 3 and name in REPORTING and ended.out):
            assert lines[-1].startswith("affcli: "), ended
            assert len(lines[-1]) <= LONGEST_LINE, ended
            assert len(lines) == 1 or name in SPEAKING_FIRST, ended
        assert all(line.isprintable() for line in lines), ended


def check_json(ended: Finished) -> None:
    """Check that stdout is JSON as everyone reads it: without NaN."""

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    json.loads(ended.out, parse_constant=refuse)


def files_in(folder: Path) -> set[str]:
    """Return the files in a folder and below it, by their way from it."""
    return {
        os.path.relpath(os.path.join(place, name), folder)  # noqa: PTH118 names of any bytes
        for place, _, names in os.walk(folder)
        for name in names
    }


def is_sound(database: Path) -> bool:
    """Tell whether SQLite finds nothing wrong in a file."""
    with closing(sqlite3.connect(database)) as driver:
        found: list[tuple[str]] = driver.execute("PRAGMA integrity_check").fetchall()
    return found == [("ok",)]
