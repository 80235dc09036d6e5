"""What a result was made with: the versions that go into the record."""

import platform
import sqlite3
from importlib.metadata import version

from affcli import __version__
from affcli.core.observation import SensorKind
from affcli.core.world import World


def versions(world: World | None = None, sensor: SensorKind = "noisy") -> dict[str, str]:
    """Return the versions of affcli and of what decides its numbers.

    Args:
        world: where it took place; None for what was read from a log.
        sensor: through what the robot saw.
    """
    packages = () if world is None else world.packages(sensor)
    return {
        "affcli": __version__,
        "python": platform.python_version(),
        "sqlite": sqlite3.sqlite_version,
        **{name: version(name) for name in packages},
    }
