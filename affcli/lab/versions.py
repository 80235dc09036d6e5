"""What a result was made with: the versions that go into the record."""

import platform
import sqlite3
from importlib.metadata import version

from affcli import __version__
from affcli.core.observation import SensorKind
from affcli.core.world import World


def versions(
    world: World | None = None, sensor: SensorKind = "noisy", *, masks: bool = False
) -> dict[str, str]:
    """Return the versions of affcli and of what decides its numbers.

    Args:
        world: where it took place; None for what was read from a log.
        sensor: through what the robot saw.
        masks: whether the masks of tools decide what it borrows: these a camera saw in any case.
    """
    kinds: tuple[SensorKind, ...] = (sensor, "camera") if masks else (sensor,)
    packages = () if world is None else (name for kind in kinds for name in world.packages(kind))
    return {
        "affcli": __version__,
        "python": platform.python_version(),
        "sqlite": sqlite3.sqlite_version,
        **{name: version(name) for name in packages},
    }
