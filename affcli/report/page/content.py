"""What the page is made of."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from affcli.analysis.reproduction import Reproduction
from affcli.core.affordance import Affordance
from affcli.core.records import LearningRunInfo
from affcli.core.replay import Replay


@dataclass(frozen=True, slots=True)
class LearnedRows:
    """What one learning run left.

    Args:
        run: which; its tool is drawn by its true shape.
        rows: the affordance table by the rows' numbers in the store.
    """

    run: LearningRunInfo
    rows: Mapping[int, Affordance]


@dataclass(frozen=True, slots=True)
class Broken:
    """A tool that broke.

    Args:
        learned: what was learned before.
        trials: with what is left of the tool, all of which count.
    """

    learned: LearnedRows
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
        not_replayed: its trials that this affcli cannot do again, each with the reason.
        left_out: trials of the same robot that are not shown.
        broken: each tool of its that broke.
        versions: what the records were made with, by package.
    """

    database: str
    robot: str
    reproduction: Reproduction | None
    tools: Sequence[LearnedRows]
    replays: Sequence[Replay]
    not_replayed: Mapping[int, str]
    left_out: int
    broken: Sequence[Broken]
    versions: Mapping[str, str]
