"""The simulated table as the camera's commands see it: pictures, a calibration, what is located."""

from pathlib import Path
from typing import Any

from tests.cli.program import Arg, done

AS_IT_LIES = ("--turn", "180", "--origin", "-12.5,9.2")
"""How the pattern of the simulated table lies."""


def photographed(folder: Path) -> Path:
    """Put pictures of pattern and table, and the calibration, into a folder; return it."""
    done("camera", "view", "--pattern", "--frame", "--out", "pattern.png", cwd=folder)
    done("camera", "view", "--frame", "--out", "table.png", cwd=folder)
    done("camera", "calibrate", "pattern.png", *AS_IT_LIES, "--out", "cal.json", cwd=folder)
    return folder


def linked(shared: Path, folder: Path) -> Path:
    """Let a folder of one test hold the files that several share; return it."""
    for path in shared.iterdir():
        (folder / path.name).symlink_to(path)
    return folder


def located(*args: Arg, cwd: Path) -> dict[str, dict[str, Any]]:
    """Return what ``locate`` finds on the table, by name."""
    ended = done("camera", "locate", "table.png", *args, "--json", cwd=cwd)
    assert ended.err == ""
    return {seen["name"]: seen for seen in ended.results}


def place(seen: dict[str, Any]) -> tuple[float, float]:
    """Return the only place where something is seen."""
    (only,) = seen["places"]
    return only["x_in"], only["y_in"]
