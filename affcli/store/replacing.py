"""A file written beside its place and then put there: it appears whole or not at all."""

import os
import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from glob import escape
from pathlib import Path

ENDING = ".affcli-part"
"""Of the names of files that are being written."""
OLD = 3600.0
"""Seconds since anything was written to such a file, after which its process was surely killed."""


@contextmanager
def replacing(path: Path, mode: int | None = None) -> Iterator[Path]:
    """Give an empty file to fill; it takes the place of `path` when the block ends well.

    What a link points to is replaced, not the link. What killed processes left behind for the same
    place, an hour ago or more, is removed.

    Args:
        path: where the file will be; what is there is kept until then.
        mode: who may read and write it; None for whoever may now, or else as the umask says.

    Raises:
        OSError: it cannot be written there.
    """
    target = Path(os.path.realpath(path))
    start = f".{target.name[:40]}."
    for left in target.parent.glob(f"{escape(start)}*{ENDING}*"):
        with suppress(OSError):  # another process was faster, or it is not ours
            if time.time() - left.stat().st_mtime > OLD:
                left.unlink()
    if mode is None and target.exists():
        mode = target.stat().st_mode & 0o777
    part = target.with_name(f"{start}{secrets.token_hex(4)}{ENDING}")
    os.close(os.open(part, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666 if mode is None else 0o600))
    try:
        yield part
        if mode is not None:
            part.chmod(mode)
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)
