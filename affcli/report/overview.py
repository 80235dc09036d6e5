"""What the database holds, in one set of tables (``affcli report``)."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from affcli.report.learning import (
    BehaviorGroup,
    LearnedTool,
    groups_json,
    groups_table,
    learned_table,
    run_json,
)
from affcli.report.paper import BROKEN_TOOL
from affcli.report.reproduction import (
    Reproduction,
    failures_table,
    reproduction_json,
    reproduction_tables,
)
from affcli.report.sheet import Sheet
from affcli.report.trials import counts_table


@dataclass(frozen=True, slots=True)
class ProtocolFigures:
    """Figures of the trials of one protocol in one session.

    Args:
        trials, solved: how many, and how many of them were solved.
        mean_steps: of the solved; None when none was.
        tries_on_lost: tries of rows whose affordance was truly lost.
        rows_excluded: rows that fell to a probability of 1/2 or less in some trial.
    """

    trials: int
    solved: int
    mean_steps: float | None
    tries_on_lost: int
    rows_excluded: int


@dataclass(frozen=True, slots=True)
class Breaking:
    """One session in which a tool broke: the broken tool's trials and the whole one's."""

    session: int
    run: int
    seed: int
    tool: str
    shape: str
    sensor: str
    broken: ProtocolFigures
    whole: ProtocolFigures


@dataclass(frozen=True, slots=True)
class Overview:
    """What a database holds.

    Args:
        learned: learning runs that stand for themselves, each with how its settings differ from the
            defaults, and its behavior groups.
        solved: (solved, tried) by (learning run, tool, sensor, goal), over all ``solve`` sessions.
        breakings: the ``break-tool`` sessions, oldest first; of the same one done again, the last.
        failures: how often each kind of failure occurred in these sessions.
        trials: all trials of these sessions.
        reproductions: the finished ones, oldest first.
    """

    learned: Sequence[tuple[LearnedTool, str, Sequence[BehaviorGroup]]]
    solved: Mapping[tuple[int, str, str, int], tuple[int, int]]
    breakings: Sequence[Breaking]
    failures: Mapping[str, int]
    trials: int
    reproductions: Sequence[Reproduction]


def overview_tables(overview: Overview) -> list[RenderableType]:
    """Return the tables, without those that would be empty."""
    shown: list[RenderableType] = []
    if overview.learned:
        shown.append(learned_table([(run, settings) for run, settings, _ in overview.learned]))
        shown += [groups_table(run, groups) for run, _, groups in overview.learned]
    if overview.solved:
        shown.append(counts_table(overview.solved))
    if overview.breakings:
        shown.append(_breakings_table(overview.breakings))
    if overview.trials:
        shown.append(failures_table(overview.failures, overview.trials))
    for reproduction in overview.reproductions:
        shown += reproduction_tables(reproduction)
    if not shown:
        shown.append(Text("nothing learned yet; first run: affcli learn --tool t-hook"))
    return shown


def _breakings_table(breakings: Sequence[Breaking]) -> Sheet:
    """Return the broken-tool sessions beside the paper."""
    table = Sheet(
        ("run", "tool", "became", "sensor", "broken", "whole", "tries on lost", "excluded"),
        title="Tools that broke",
        caption=f"solved (mean steps of the solved); paper: {BROKEN_TOOL} of 16 both",
        left=("tool", "became", "sensor"),
    )
    for breaking in breakings:
        table.add(
            str(breaking.run),
            breaking.tool,
            breaking.shape,
            breaking.sensor,
            _solved(breaking.broken),
            _solved(breaking.whole),
            str(breaking.broken.tries_on_lost),
            str(breaking.broken.rows_excluded),
        )
    return table


def _solved(figures: ProtocolFigures) -> str:
    """Return successes with the mean steps they took."""
    steps = "-" if figures.mean_steps is None else f"{figures.mean_steps:.1f}"
    return f"{figures.solved}/{figures.trials} ({steps})"


def overview_json(overview: Overview) -> dict[str, Any]:
    """Return what `overview_tables` shows as JSON types."""
    return {
        "learned": [
            {**run_json(run), "settings": settings, "groups": groups_json(groups)}
            for run, settings, groups in overview.learned
        ],
        "solved": [
            {
                "run": run,
                "tool": tool,
                "sensor": sensor,
                "goal": goal,
                "solved": solved,
                "tried": tried,
            }
            for (run, tool, sensor, goal), (solved, tried) in overview.solved.items()
        ],
        "broken": [asdict(breaking) for breaking in overview.breakings],
        "failures": dict(overview.failures),
        "trials": overview.trials,
        "reproductions": [reproduction_json(again) for again in overview.reproductions],
    }
