"""A made-up log of the form that a humanoid's lab published: blanks, no header, metres, numbers."""

import math
from pathlib import Path

import numpy as np

from affcli.logs.mapping import LogMap, log_map

MAP = """
[log]
source = "made up for a test"
licence = "CC0"
citation = "Nobody, A log (2026)"
[columns]
tool = 1
object = 2
behavior = 3
start_x = 4
start_y = 5
end_x = 8
end_y = 9
[units]
length = "m"
[axes]
right = "y"
away = "-x"
[names.behavior]
1 = "tap from right"
2 = "tap from left"
3 = "draw"
4 = "push"
"""
"""x of the log runs toward the robot, y to its right."""
TOOLS = {"stick": 0.0, "hook": 0.08, "rake": 0.11}
"""How far each draws an object nearer (m)."""
OBJECTS = ("ball", "cup")
REPEATS = 6
ACTIONS = {1: (0.0, -0.06), 2: (0.0, 0.06), 4: (-0.07, 0.0)}
"""How far the others move it (m, axes of the log)."""


def lines(seed: int = 0) -> dict[str, list[str]]:
    """Return the lines of each file, by its name."""
    rng = np.random.default_rng(seed)
    files: dict[str, list[str]] = {}
    for tool, drawn in TOOLS.items():
        for thing in OBJECTS:
            for action in (1, 2, 3, 4):
                dx, dy = ACTIONS.get(action, (drawn, 0.0))
                rows = files.setdefault(f"{tool}/{thing}/{action}.txt", [])
                for _ in range(REPEATS):
                    x, y = rng.uniform(-0.6, -0.5), rng.uniform(-0.2, 0.2)
                    turn = rng.normal(0.0, 0.2)
                    ex = x + dx * math.cos(turn) - dy * math.sin(turn)
                    ey = y + dx * math.sin(turn) + dy * math.cos(turn)
                    rows.append(
                        f"{tool} {thing} {action} {x:.6f} {y:.6f} 9 9 {ex:.6f} {ey:.6f} 8 8"
                    )
    return files


def written(folder: Path, *, bad: int = 0) -> Path:
    """Write the log and its map into a folder; so many lines of the first file are bad."""
    for name, rows in lines().items():
        path = folder / "log" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(["stick ball 9 oops"] * bad + rows) + "\n")
        bad = 0
    (folder / "map.toml").write_text(MAP)
    return folder


def mapped(folder: Path, text: str) -> LogMap:
    """Return the map that a text is."""
    path = folder / "map.toml"
    path.write_text(text)
    return log_map(path)
