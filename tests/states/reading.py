"""Giving commands that read, in a state that a kill left."""

from pathlib import Path

from tests.cli.program import Ended, affcli, one_printable_line
from tests.states.commands import DATABASE, Numbers, called


def asked(line: str, folder: Path, looked_at: Path) -> Ended:
    """Give a command that reads in a folder; an error must be one line.

    Args:
        line: with ``{table}`` for the latest number of a table.
        folder: where.
        looked_at: a copy of it: to look for a number in the file itself would set it right.
    """
    words = called(line.format_map(Numbers(looked_at / DATABASE)))
    ended = affcli(*words, cwd=folder)
    if ended.code not in {0, 1}:
        assert ended.code in {2, 3, 4}, (words, ended)
        # These tell what is wrong as their result.
        if not (words[0] == "doctor" and ended.out):
            one_printable_line(ended.err)
    return ended
