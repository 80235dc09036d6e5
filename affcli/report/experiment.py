"""An experiment in words and tables: what it will take, what its robots gave."""

from collections.abc import Sequence
from statistics import fmean
from typing import Any, NamedTuple

from affcli.analysis.experiment import ConditionResult, ExperimentResult, Tally
from affcli.core.records import FailedRobot
from affcli.core.trial import Outcome
from affcli.errors import one_line
from affcli.report.sheet import Sheet
from affcli.report.words import clock, many

MEGABYTE = 1e6


class Cost(NamedTuple):
    """What an experiment takes: counts in all, and what one robot took that has just lived."""

    robots: int
    learning_runs: int
    trials: int
    robot_hours: float
    seconds: float
    bytes: int
    workers: int

    @property
    def whole_seconds(self) -> float:
        """Return how long all robots take on so many workers."""
        return self.robots * self.seconds / max(min(self.workers, self.robots), 1)

    @property
    def whole_bytes(self) -> int:
        """Return how large the database of all robots is."""
        return self.robots * self.bytes


def cost_json(conditions: Sequence[str], cost: Cost) -> dict[str, Any]:
    """Return what an experiment will take as JSON types."""
    return {
        "conditions": list(conditions),
        "robots": cost.robots,
        "robot_hours": cost.robot_hours,
        "learning_runs": cost.learning_runs,
        "trials": cost.trials,
        "workers": cost.workers,
        "estimated_seconds": cost.whole_seconds,
        "estimated_bytes": cost.whole_bytes,
        "measured": {"robots": 1, "seconds": cost.seconds, "bytes": cost.bytes},
    }


def cost_table(name: str, conditions: Sequence[str], cost: Cost) -> Sheet:
    """Return what an experiment will take."""
    table = Sheet(
        ("what", "how much"),
        title=f"{name}: {many(len(conditions), 'condition')}",
        caption=f"Estimated from robot 0, which has just lived: {cost.seconds:.1f} s on one core, "
        f"{cost.bytes / MEGABYTE:.2f} MB. Nothing is saved.",
        left=("what",),
    )
    table.add("robots", f"{cost.robots:,}")
    table.add("robot hours of learning", f"{cost.robot_hours:,.6g}")
    table.add("learning runs", f"{cost.learning_runs:,}")
    table.add("trials", f"{cost.trials:,}")
    table.add(f"time on {many(cost.workers, 'worker')}, about", clock(cost.whole_seconds))
    table.add("database, about", f"{cost.whole_bytes / MEGABYTE:,.1f} MB")
    return table


def experiment_json(one: ExperimentResult) -> dict[str, Any]:
    """Return what an experiment gave as JSON types."""
    return {
        "experiment": one.name,
        "question": one.question,
        "robots": one.robots,
        "conditions": [
            {
                "condition": condition.name,
                "session": condition.session,
                "solved": {
                    kind: {
                        "trials": tally.tried,
                        "by_robot": [tally.solved[k] for k in sorted(tally.solved)],
                    }
                    for kind, tally in condition.tallies.items()
                },
                "invalid": condition.invalid.trials,
                "why_invalid": condition.invalid.why,
                "failures": dict(condition.failures),
            }
            for condition in one.results
        ],
        "failed": failed_json(one.failed),
    }


def failed_json(failed: Sequence[FailedRobot]) -> list[dict[str, Any]]:
    """Return the robots that failed as JSON types."""
    return [
        {"robot": one.robot, "kind": one.kind, "message": one.message, "tries": one.tries}
        for one in failed
    ]


def failed_tables(failed: Sequence[FailedRobot]) -> list[Sheet]:
    """Return a table of the robots that failed; none when none did."""
    table = Sheet(
        ("robot", "failed", "tries", "with"),
        title="Robots that failed",
        caption="the same command tries them again",
        left=("failed", "with"),
    )
    for one in failed:
        table.add(str(one.robot), one.kind, str(one.tries), one.message)
    return [table] if failed else []


def invalid_words(condition: ConditionResult) -> str:
    """Return how many trials of a condition count for nothing, and why; empty if all count."""
    trials, why = condition.invalid
    if not trials:
        return ""
    which = many(trials, "trial") if condition.tallies else f"all {many(trials, 'trial')}"
    verb = "counts" if trials == 1 else "count"
    return one_line(f"{condition.name}: {which} {verb} for nothing: {why}", 500)


def experiment_tables(one: ExperimentResult) -> list[Sheet]:
    """Return the mean of the successes under each condition by kind of trials; how trials failed,
    and which robots.
    """
    kinds = tuple(dict.fromkeys(kind for condition in one.results for kind in condition.tallies))
    invalid = [words for condition in one.results if (words := invalid_words(condition))]
    table = Sheet(
        ("condition", "session", *kinds, *(("invalid",) if invalid else ())),
        title=f"{one.name}: solved, mean of {many(one.robots, 'robot')}",
        caption="\n".join((one.question, *invalid)),
        left=("condition",),
    )
    for condition in one.results:
        cells = [_cell(condition.tallies.get(kind)) for kind in kinds]
        beside = (str(condition.invalid.trials),) if invalid else ()
        table.add(condition.name, str(condition.session), *cells, *beside)
    return [table, *_failures_tables(one.results), *failed_tables(one.failed)]


def _failures_tables(conditions: Sequence[ConditionResult]) -> list[Sheet]:
    """Return a table of how trials failed under each condition; none where none did."""
    kinds = [kind for kind in Outcome if any(kind in one.failures for one in conditions)]
    table = Sheet(
        ("condition", *kinds),
        title="Failures by kind",
        caption="trials of all robots",
        left=("condition",),
    )
    for one in conditions:
        table.add(one.name, *(str(one.failures.get(kind, 0)) for kind in kinds))
    return [table] if kinds else []


def _cell(tally: Tally | None) -> str:
    """Return the mean over robots, and of how many trials of each."""
    if tally is None:
        return "-"
    return f"{fmean(tally.solved.values()):.1f} of {tally.tried / len(tally.solved):g}"
