"""Is everything here that affcli needs? Python, packages, and where the database lies."""

import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from affcli import __version__
from affcli.lab.workers import start_fault
from affcli.store import Fact, State, environment_facts

NEEDED = ("numpy", "scipy", "pymunk", "SQLAlchemy", "alembic", "typer", "rich", "jinja2")
EXTRAS = {
    "the camera": ("camera", ("opencv-python-headless", "pillow")),
    "figures": ("figures", ("matplotlib",)),
    "a cluster": ("cluster", ("distributed",)),
    "parquet files": ("parquet", ("pyarrow",)),
    "Gymnasium": ("gym", ("gymnasium",)),
}
"""What only some need: by what it is for, the name of the extra and its packages."""
SEVERAL = 2
"""Worker processes that are started to see whether they can be."""


def facts(database: Path) -> tuple[Fact, ...]:
    """Return what was found, each with what to do about it where that is needed.

    Args:
        database: the file that would be used.
    """
    return (
        Fact("affcli", "ok", f"{__version__}, Python {platform.python_version()}"),
        _packages("packages", NEEDED, "install affcli again", missing="bad"),
        *(
            _packages(what, names, f"to use it: pip install 'affcli[{extra}]'", missing="look")
            for what, (extra, names) in EXTRAS.items()
        ),
        _workers(),
        *environment_facts(database),
    )


def _workers() -> Fact:
    """Say whether `reproduce` can let several processes work."""
    fault = start_fault(SEVERAL)
    if fault:
        return Fact(*("workers", "look"), f"none can be started: {fault}", "give --workers 1")
    return Fact("workers", "ok", "processes can be started")


def _packages(what: str, names: tuple[str, ...], remedy: str, *, missing: State) -> Fact:
    """Say which versions of some packages are installed."""
    found, lacking = [], []
    for name in names:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            lacking.append(name)
    if lacking:
        return Fact(what, missing, f"missing: {', '.join(lacking)}", remedy)
    return Fact(what, "ok", ", ".join(found))
