"""Files that commands write where the user asks for them."""

import os
import tempfile
from collections.abc import Collection
from pathlib import Path

from affcli.errors import BadInputError, one_line


def require_new(path: Path, *, force: bool, endings: Collection[str] = ()) -> None:
    """Refuse to write over something, before any work is done for it.

    Args:
        path: where a command is asked to write.
        force: write over a file that is there.
        endings: one of which the name must have; any will do if empty.

    Raises:
        BadInputError: there is something at `path` and `force` was not given; or it is no file, its
            folder does not exist, or its name has another ending.
    """
    shown = one_line(path)
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


def save(path: Path, data: bytes) -> None:
    """Write a file whole or not at all.

    Raises:
        BadInputError: it cannot be written there; what was there before is kept.
    """
    try:
        handle, name = tempfile.mkstemp(dir=path.absolute().parent, prefix=f".{path.name[:40]}.")
        temporary = Path(name)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            temporary.chmod(0o644)
            temporary.replace(path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise BadInputError(
            f"{one_line(path)}: cannot be written: {error.strerror}; name another file"
        ) from error
