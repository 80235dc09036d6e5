"""What the page is made of."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from affcli.analysis.curves import Curve, ToolCurves
from affcli.analysis.experiment import ExperimentResult
from affcli.analysis.prediction import Push
from affcli.analysis.reproduction import Reproduction
from affcli.core.affordance import Affordance
from affcli.core.records import LearningRunInfo, TrialInfo
from affcli.core.replay import Replay
from affcli.core.results import VerificationResult


@dataclass(frozen=True, slots=True)
class LearnedRows:
    """What one learning run left.

    Args:
        run: which; its tool is drawn by its true shape.
        rows: the affordance table by the rows' numbers in the store.
        robot: whose, in words.
        filmed: its trials were done again.
        pushes: fresh ones, with what the table said of each.
        not_asked: why it was not asked what pushes do; empty if it was, or is of another robot.
    """

    run: LearningRunInfo
    rows: Mapping[int, Affordance]
    robot: str = "the robot"
    filmed: bool = True
    pushes: Sequence[Push] = ()
    not_asked: str = ""


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
        tools: what this robot learned, and others to choose from, each in turn.
        replays: its trials, done again.
        others: trials of the other robots, as they are stored.
        curves: how learning went, by learning run.
        bands: the same of all robots of the reproduction, by tool.
        verifications: what tests of these tables found.
        not_shown: how many robots more there are.
        experiments: what they gave.
        drawn: the comparison of an experiment's conditions as SVG, by its name, where it was drawn.
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
    others: Sequence[TrialInfo] = ()
    curves: Mapping[int, Curve] = field(default_factory=dict)
    bands: Mapping[str, ToolCurves] = field(default_factory=dict)
    verifications: Sequence[VerificationResult] = ()
    not_shown: int = 0
    experiments: Sequence[ExperimentResult] = ()
    drawn: Mapping[str, bytes] = field(default_factory=dict)
