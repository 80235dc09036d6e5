"""The mask of a tool: what its colour covers, on the table and at the height of its top (§4)."""

import math
from dataclasses import replace

import numpy as np
import pytest

from affcli.config import Settings
from affcli.core.geometry import Pose
from affcli.core.mask import Grid, Mask
from affcli.core.scene import Scene
from affcli.core.tool import PUCK_COLOR, Tool, ToolName
from affcli.errors import NotSeenError
from affcli.simulation.sensing import eye_of, mask_through
from affcli.simulation.tools.paper import paper_tools

SETTINGS = Settings()
TOOLS = paper_tools(SETTINGS.workspace.tools)
HOME = Pose(0.0, 14.9)


def seen(tool: Tool, wrist: Pose = HOME, named: str = "") -> Mask:
    """Return the mask of a tool at the wrist, the puck in the corner of the table."""
    scene = Scene(Pose(16.0, 11.8), PUCK_COLOR, wrist, tool, None)
    eye = eye_of(SETTINGS.camera, SETTINGS.workspace, TOOLS[ToolName("t-hook")], 3, 0)
    return mask_through(eye, scene, named or tool.name, np.random.default_rng(7))


@pytest.mark.parametrize("name", TOOLS)
def test_a_mask_is_the_tool_without_its_sides(name: ToolName) -> None:
    """From the wrist's marker on; at its edges it is off by less than a cell."""
    tool = TOOLS[name]
    mask = seen(tool)
    x, y = np.meshgrid(0.1 * np.arange(-80, 80) + 0.05, 0.1 * np.arange(20, 180) + 0.05)

    def inside(by: float) -> Grid:
        """Tell which cells lie in the tool, made larger by so much on all sides (in)."""
        found = np.zeros(x.shape, dtype=bool)
        for left, near, right, far in (outline.bounds for outline in tool.outlines):
            within = (x >= left - by) & (x <= right + by) & (y >= near - by) & (y <= far + by)
            found |= within
        return found.T

    covered = mask.window(-80, 20, 160, 160)
    assert not (covered & ~inside(0.1)).any()
    assert (inside(0.0) & ~covered).sum() * 0.01 < 1.5
    assert math.dist(mask.color, tool.color) < 45.0


def test_a_mask_is_told_from_where_the_wrist_is_seen() -> None:
    """At another place of the table it is the same but for what the camera cannot tell."""
    tool = TOOLS[ToolName("l-hook")]
    one, other = seen(tool), seen(tool, Pose(-4.03, 13.28))
    assert one.overlap(other) > 0.85


def test_what_is_not_there_is_not_seen() -> None:
    stick = TOOLS[ToolName("stick")]
    with pytest.raises(NotSeenError, match="the camera sees no t-hook; bring it into view"):
        seen(stick, named="t-hook")
    parts = tuple(replace(p, outline=p.outline.moved(0.0, 19.0)) for p in stick.parts)
    with pytest.raises(NotSeenError, match="does not see all of the stick"):
        seen(replace(stick, parts=parts))
    assert seen(stick).window(-4, 60, 8, 8).all()
