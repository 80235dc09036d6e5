"""What the database holds, in one set of tables (``affcli report``)."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from affcli.analysis.experiment import ExperimentResult
from affcli.analysis.overview import Breaking, Overview, ProtocolCounts
from affcli.analysis.paper import BROKEN, PLANNER, TASK_SET
from affcli.report.experiment import experiment_json, experiment_tables
from affcli.report.learning import groups_json, groups_table, learned_table, run_json
from affcli.report.paired import comparison_json, comparison_tables
from affcli.report.reproduction import failures_table, reproduction_json, reproduction_tables
from affcli.report.sheet import Sheet
from affcli.report.trials import counts_tables
from affcli.report.words import experiment_words


def overview_tables(overview: Overview) -> list[RenderableType]:
    """Return the tables, without those that would be empty."""
    shown: list[RenderableType] = []
    runs = {run.id: run for run, _ in overview.learned}
    if overview.learned:
        shown.append(learned_table(list(runs.values())))
        shown += [
            groups_table(run, groups) for run, groups in overview.learned if not run.only_borrowed
        ]
    shown += counts_tables(overview.solved, runs)
    if overview.breakings:
        shown.append(_breakings_table(overview.breakings))
    if overview.trials or overview.invalid:
        shown.append(failures_table(overview.failures, overview.trials, overview.invalid))
    for reproduction in overview.reproductions:
        shown += reproduction_tables(reproduction)
    for one in overview.experiments:
        shown += [Text(experiment_words(one)), *experiment_sheets(one)]
    if not shown:
        shown.append(Text("nothing learned yet; first run: affcli learn --tool t-hook"))
    return shown


def experiment_sheets(one: ExperimentResult) -> list[Sheet]:
    """Return what an experiment gave under each condition, and the conditions compared."""
    compared = comparison_tables(one.comparison) if one.comparison else []
    return [*experiment_tables(one), *compared]


def _breakings_table(breakings: Sequence[Breaking]) -> Sheet:
    """Return the broken-tool sessions."""
    named = {
        "planner": [one.planner for one in breakings],
        "tasks": [one.task_set for one in breakings],
    }
    usual = {"planner": PLANNER, "tasks": TASK_SET}
    more = {name: values for name, values in named.items() if set(values) != {usual[name]}}
    papers = [one for one in breakings if one.papers]
    by = "".join(f", {usual[name]}" for name in more)
    beside = f"; paper, {papers[0].tool} that became {papers[0].shape}{by}: " if papers else ""
    which = ("run", "tool", "became", "sensor")
    table = Sheet(
        (*which, *more, "broken", "whole", "tries on lost", "excluded"),
        title="Tools that broke",
        caption="solved (mean steps of the solved)"
        + (f"{beside}{BROKEN} of 16 both" if papers else ""),
        left=("tool", "became", "sensor", *more),
    )
    for number, breaking in enumerate(breakings):
        table.add(
            str(breaking.run),
            breaking.tool,
            f"{breaking.shape}{' (grew)' * breaking.grew}{_unfinished(breaking)}",
            breaking.sensor,
            *(values[number] for values in more.values()),
            _solved(breaking.broken),
            _solved(breaking.whole),
            str(breaking.broken.tries_on_lost),
            str(breaking.broken.rows_excluded),
        )
    return table


def _unfinished(breaking: Breaking) -> str:
    """Return that not all trials were done; empty where they were."""
    return "" if breaking.finished else " (unfinished)"


def _solved(counts: ProtocolCounts) -> str:
    """Return successes with the mean steps they took."""
    steps = "-" if counts.mean_steps is None else f"{counts.mean_steps:.1f}"
    return f"{counts.solved}/{counts.trials} ({steps})"


def overview_json(overview: Overview) -> dict[str, Any]:
    """Return what `overview_tables` shows as JSON types."""
    return {
        "learned": [
            {
                **run_json(run),
                "groups": groups_json(groups),
            }
            for run, groups in overview.learned
        ],
        "solved": [
            {
                **one.by._asdict(),
                "goal": goal,
                "solved": solved,
                "tried": tried,
                "paper": one.paper(goal),
            }
            for one in overview.solved
            for goal, (solved, tried) in one.goals.items()
        ],
        "broken": [asdict(breaking) for breaking in overview.breakings],
        "failures": dict(overview.failures),
        "trials": overview.trials,
        "invalid": overview.invalid,
        "reproductions": [reproduction_json(again) for again in overview.reproductions],
        "experiments": [
            {
                **experiment_json(one),
                "learning_runs": one.learning_runs,
                "comparison": one.comparison and comparison_json(one.comparison),
            }
            for one in overview.experiments
        ],
    }
