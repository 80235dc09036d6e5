"""What the page is made of."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from affcli.core.affordance import Affordance
from affcli.core.replay import Replay
from affcli.core.tool import Tool
from affcli.report.reproduction import Reproduction


@dataclass(frozen=True, slots=True)
class LearnedRows:
    """What one learning run left.

    Args:
        run: its number in the store.
        tool: the tool held, by its true shape: for the drawings.
        seed, robot: whose run it is.
        behaviors, resets: how many were executed; how often the attractor was put back by hand.
        robot_seconds: how long it took.
        settings: how its settings differ from the defaults, in words.
        rows: the affordance table by the rows' numbers in the store.
    """

    run: int
    tool: Tool
    seed: int
    robot: int
    behaviors: int
    resets: int
    robot_seconds: float
    settings: str
    rows: Mapping[int, Affordance]


@dataclass(frozen=True, slots=True)
class Broken:
    """A tool that broke.

    Args:
        tool, shape: what was learned, and what is left of it.
        missing_side: x of the middle of what is missing, in the tool frame (in).
        rows: the affordance table as learned, by the rows' numbers in the store.
        trials: with the broken tool, all of which ended.
    """

    tool: Tool
    shape: Tool
    missing_side: float
    rows: Mapping[int, Affordance]
    trials: Sequence[Replay]


@dataclass(frozen=True, slots=True)
class Content:
    """All that the page shows.

    Args:
        database: name of the file.
        robot: whose tools and trials these are, in words.
        reproduction: what many robots gave; None when there is none.
        tools: what the robot learned.
        replays: its trials, done again.
        left_out: trials of the same robot that are not shown.
        broken: each tool of its that broke.
        versions: what the records were made with, by package.
    """

    database: str
    robot: str
    reproduction: Reproduction | None
    tools: Sequence[LearnedRows]
    replays: Sequence[Replay]
    left_out: int
    broken: Sequence[Broken]
    versions: Mapping[str, str]
