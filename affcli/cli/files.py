"""Files that commands write where the user asks for them."""

import tempfile
from collections.abc import Collection
from pathlib import Path

from affcli.errors import BadInputError, one_line
from affcli.store.replacing import replacing

STDOUT_NAMES = frozenset({"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"})


def require_new(
    path: Path, *, force: bool, endings: Collection[str] = (), dash: bool = False
) -> None:
    """Refuse to write over something, before any work is done for it.

    Where there is no other folder for temporary files, that of `path` is used from now on.

    Args:
        path: where a command is asked to write.
        force: write over a file that is there.
        endings: one of which the name must have; any will do if empty.
        dash: the command writes to stdout when it is asked for ``-``.

    Raises:
        BadInputError: there is something at `path` and `force` was not given; or it is no file, its
            folder does not exist, or its name has another ending.
    """
    shown = one_line(path)
    if str(path) in STDOUT_NAMES:  # it may be a file to which stdout goes
        remedy = "to write to stdout give --out -" if dash else "name a file"
        raise BadInputError(f"{shown}: not a file that can be written whole; {remedy}")
    try:
        exists, is_file, folder = path.exists(), path.is_file(), path.absolute().parent.is_dir()
    except (OSError, ValueError) as error:
        why = one_line(getattr(error, "strerror", None) or error)
        raise BadInputError(f"{shown}: {why}; name another file") from error
    if exists and not is_file:
        raise BadInputError(f"{shown}: not a file; name another")
    if exists and not force:
        raise BadInputError(f"{shown}: exists already; name another file, or give --force")
    if endings and path.suffix.lower() not in endings:
        wanted = " or ".join(f"*{ending}" for ending in endings)
        raise BadInputError(f"{shown}: name it {wanted}")
    if not folder:
        raise BadInputError(f"{shown}: its folder does not exist; make it, or name another file")
    try:
        tempfile.gettempdir()
    except FileNotFoundError:
        # Libraries want a folder for their caches; this is the only one that can be written.
        tempfile.tempdir = str(path.absolute().parent)


def save(path: Path, data: bytes) -> None:
    """Write a file whole or not at all; what a link points to is written, not the link.

    Raises:
        BadInputError: it cannot be written there; what was there before is kept.
    """
    try:
        with replacing(path) as part:
            part.write_bytes(data)
    except OSError as error:
        raise BadInputError(
            f"{one_line(path)}: cannot be written: {error.strerror}; name another file"
        ) from error
