"""An experiment in words and tables: what it will take, what its robots gave."""

from collections.abc import Mapping, Sequence
from statistics import fmean
from typing import Any, NamedTuple

from affcli.analysis.experiment import Tally
from affcli.core.records import FailedRobot
from affcli.report.sheet import Sheet
from affcli.report.words import clock, many

MEGABYTE = 1e6


class ConditionResult(NamedTuple):
    """What the robots of one condition gave: its name and session, and its trials by kind."""

    name: str
    session: int
    tallies: Mapping[str, Tally]


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
    table.add("database, about", f"{cost.whole_bytes / MEGABYTE:,.3g} MB")
    return table


def experiment_json(
    name: str,
    question: str,
    robots: int,
    results: Sequence[ConditionResult],
    failed: Sequence[FailedRobot],
) -> dict[str, Any]:
    """Return what an experiment gave as JSON types."""
    return {
        "experiment": name,
        "question": question,
        "robots": robots,
        "conditions": [
            {
                "condition": one.name,
                "session": one.session,
                "solved": {
                    kind: {
                        "trials": tally.tried,
                        "by_robot": [tally.solved[k] for k in sorted(tally.solved)],
                    }
                    for kind, tally in one.tallies.items()
                },
            }
            for one in results
        ],
        "failed": failed_json(failed),
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


def experiment_tables(
    name: str,
    question: str,
    robots: int,
    results: Sequence[ConditionResult],
    failed: Sequence[FailedRobot],
) -> list[Sheet]:
    """Return the mean of the successes under each condition by kind of trials; who failed."""
    kinds = tuple(dict.fromkeys(kind for one in results for kind in one.tallies))
    columns = ("condition", "session", *kinds)
    table = Sheet(
        columns,
        title=f"{name}: solved, mean of {many(robots, 'robot')}",
        caption=question,
        left=("condition",),
    )
    for one in results:
        cells = (_cell(one.tallies.get(kind)) for kind in kinds)
        table.add(one.name, str(one.session), *cells)
    return [table, *failed_tables(failed)]


def _cell(tally: Tally | None) -> str:
    """Return the mean over robots, and of how many trials of each."""
    if tally is None:
        return "-"
    return f"{fmean(tally.solved.values()):.1f} of {tally.tried / len(tally.solved):g}"
