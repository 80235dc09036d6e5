"""What a result was made with: the versions that go into the record."""

import platform
import sqlite3
from functools import cache
from importlib.metadata import version

from affcli import __version__
from affcli.core.observation import SensorKind


@cache
def versions(sensor: SensorKind = "noisy") -> dict[str, str]:
    """Return the versions of affcli and of what decides its numbers.

    Args:
        sensor: through what the robot sees; a camera adds what makes and reads its pictures.
    """
    seeing = ("opencv-python-headless", "scipy") if sensor == "camera" else ()
    return {
        "affcli": __version__,
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "pymunk": version("pymunk"),
        "sqlite": sqlite3.sqlite_version,
        **{name: version(name) for name in seeing},
    }
