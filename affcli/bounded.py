"""What comes from outside is small and shallow before it is parsed: files, and texts in them.

A megabyte can make a parser take gigabytes, or hours. Who reads a file or a stored value reads it
through here, and then looks at what is in it.
"""

import json
import re
import tomllib
from itertools import accumulate
from pathlib import Path
from typing import Any, BinaryIO

from affcli.errors import BadInputError

LARGEST_FILE = 1_000_000
"""Bytes of a file of settings or of a calibration; affcli writes some 6,000."""
PIECE = 65_536
"""Bytes that are read at first of what does not say how many it has."""
LARGEST_VALUE = 100_000
"""Bytes of one value or one row of a database; affcli writes some 3,000. Inside a function SQLite
looks at no clock, and instr() takes 11 s on 1 MB, 0.1 s on 100 kB."""
DEEPEST = 20
"""Lists and objects in one another in JSON; affcli writes some 6."""
DEEPEST_TOML = 4
"""Dots in a key, and lists and tables in one another, in a file of settings; two would do."""

_JSON_TEXT = re.compile(r'"(?:\\.|[^"\\])*+"?', re.DOTALL)
_TOML_TEXT_OR_REMARK = re.compile(
    r'"""(?:\\.|[^"\\]|"(?!""))*+(?:""")?|'
    r"'''(?:[^']|'(?!''))*+(?:''')?|"
    r'"(?:\\.|[^"\\\n])*+"?|'
    r"'[^'\n]*+'?|"
    r"#[^\n]*+",
    re.DOTALL,
)
_LONG_KEY = re.compile(r"\.(?:[ \t]*+[\w-]*+[ \t]*+\.){" + str(DEEPEST_TOML) + "}")


def file_bytes(path: Path, shown: str, remedy: str, largest: int = LARGEST_FILE) -> bytes:
    """Return what a file holds.

    Args:
        path: the file.
        shown: what it is, for the message.
        remedy: what to give instead.
        largest: bytes that it may have.

    Raises:
        BadInputError: it cannot be read, or is larger.
    """
    try:
        size = path.stat().st_size  # 0 of what is no file
        with path.open("rb") as file:
            data = _read(file, size, largest) if size <= largest else b""
    except OSError as error:
        raise BadInputError(f"{shown}: {error.strerror}; {remedy}") from error
    if max(size, len(data)) > largest:
        raise BadInputError(f"{shown}: more than {largest} bytes; {remedy}")
    return data


def _read(file: BinaryIO, size: int, largest: int) -> bytes:
    """Return what a file holds, at most one byte more than `largest`.

    A read takes as much memory as it asks for, however little there is: so first that is asked for
    which the file says that it has, and more of what says nothing, like a pipe.
    """
    data, asked = b"", size + 1
    while part := file.read(min(asked, largest + 1 - len(data))):
        data += part
        asked = max(len(data), PIECE)
    return data


def json_value(text: str | bytes) -> Any:
    """Return what JSON text stands for; ValueError when it is none, or nested too deep."""
    if isinstance(text, bytes):
        text = text.decode(json.detect_encoding(text))
    if text.count("[") + text.count("{") > DEEPEST:  # it may be deep
        _require_shallow(_JSON_TEXT.sub("_", text), DEEPEST)
    return json.loads(text)


def toml_value(text: str) -> dict[str, Any]:
    """Return what TOML text stands for; ValueError when it is none, or nested too deep.

    tomllib takes memory as the square of the dots in one key.
    """
    plain = _TOML_TEXT_OR_REMARK.sub("_", text)
    _require_shallow(plain, DEEPEST_TOML)
    if _LONG_KEY.search(plain):
        raise ValueError(f"more than {DEEPEST_TOML} dots in a key")
    return tomllib.loads(text)


def _require_shallow(plain: str, deepest: int) -> None:
    """Refuse a text, without what is quoted in it, that is nested deeper: ValueError."""
    steps = (1 if bracket in "[{" else -1 for bracket in re.findall(r"[\[{\]}]", plain))
    if max(accumulate(steps), default=0) > deepest:
        raise ValueError(f"nested too deeply: more than {deepest} lists in one another")
