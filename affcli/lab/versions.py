"""What a result was made with: the versions that go into the record."""

import platform
import sqlite3
from functools import cache
from importlib.metadata import version

from affcli import __version__


@cache
def versions() -> dict[str, str]:
    """Return the versions of affcli and of what decides its numbers."""
    return {
        "affcli": __version__,
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "pymunk": version("pymunk"),
        "sqlite": sqlite3.sqlite_version,
    }
