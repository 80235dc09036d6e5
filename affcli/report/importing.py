"""What a log gives, before and after it is imported."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

from affcli.core.affordance import is_probable
from affcli.core.records import LearningRunInfo
from affcli.logs.reading import Log
from affcli.logs.steps import LoggedRun
from affcli.report.sheet import Sheet
from affcli.report.words import call_words, many


def import_table(runs: Sequence[tuple[LoggedRun, LearningRunInfo | None]]) -> Sheet:
    """Return what each tool and behavior of a log gives.

    Args:
        runs: as they were read, each with what the database holds of it, or is not to hold.
    """
    table = Sheet(
        ("run", "tool", "behavior", "trials", "rows", "alive"),
        title="What the log gives",
        caption="rows: trials that moved the object by more than 0.5 in; alive: of the rows, with "
        "a replication probability over 1/2, by repeats with the same object and behavior",
        left=("tool", "behavior"),
    )
    for run, info in runs:
        for group in _groups(run):
            table.add("-" if info is None else str(info.id), run.spec.tool, *map(str, group))
    return table


def import_json(run: LoggedRun, info: LearningRunInfo | None, log: Log) -> dict[str, Any]:
    """Return what a log gives of one tool as JSON types."""
    return {
        "run": None if info is None else info.id,
        "tool": run.spec.tool,
        "trials": len(run.steps),
        "rows": sum(record.affordance is not None for record, _ in run.steps),
        "groups": [
            dict(zip(("behavior", "trials", "rows", "alive"), group, strict=True))
            for group in _groups(run)
        ],
        "left_out": log.left_out,
        "source": log.map.source,
        "licence": log.map.licence,
        "citation": log.map.citation,
    }


def log_words(log: Log) -> str:
    """Return what was read, in a line."""
    files, trials = many(len(log.files), "file"), many(len(log.trials), "trial")
    left = f", {many(log.left_out, 'line')} left out" if log.left_out else ""
    return f"read {trials} in {files}{left}"


def _groups(run: LoggedRun) -> list[tuple[str, int, int, int]]:
    """Return for each behavior the trials, the rows, and of these the live ones."""
    tried: Counter[str] = Counter()
    rows: Counter[str] = Counter()
    alive: Counter[str] = Counter()
    for record, _ in run.steps:
        name, row = call_words(record.execution.call), record.affordance
        tried[name] += 1
        rows[name] += row is not None
        alive[name] += row is not None and is_probable(row.times_successful, row.times_used)
    return [(name, tried[name], rows[name], alive[name]) for name in tried]
