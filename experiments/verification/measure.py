"""Does a robot that tests its table judge rightly, and how well does the table predict?

    .venv/bin/python experiments/verification/measure.py [--robots N] [--seed N] [--json FILE]

Each robot learns the five tools for an hour of its time. Then it tries every row of each table
again once, with the tool as it was and with other shapes in its colour; and each table is asked
what pushes will do that it has never seen.
"""

import argparse
import json
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from statistics import fmean, median, stdev
from typing import Any, NamedTuple

from affcli.analysis.prediction import STAGES, Push, Score
from affcli.analysis.regions import region_of
from affcli.analysis.statistics import exact_interval, quantile
from affcli.config import Settings, with_sensor
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.observation import SensorKind
from affcli.core.specs import LearningSpec, VerificationSpec
from affcli.core.verification import Evidence, Verdict
from affcli.lab.learning_run import LearningRun
from affcli.lab.predicting import StagedTable, fresh_pushes
from affcli.lab.run_parts import RunParts, tool_of
from affcli.lab.verifying import replications
from affcli.report.prediction import PREDICTORS
from affcli.simulation.tools.paper import TOOL_PARTS

INTACT = tuple((str(tool), str(tool)) for tool in TOOL_PARTS)
CHANGED = (
    ("t-hook", "l-hook"),
    ("t-hook", "t-stick"),
    ("l-hook", "l-stick"),
    ("t-stick", "l-stick"),
    ("l-stick", "stick"),
    ("l-hook", "t-hook"),
    ("stick", "l-stick"),
)
"""What a tool becomes: the paper's broken T-hook; other parts lost; parts gained."""
PUSHES = 400
"""Of each robot with each tool, to predict."""


class Tried(NamedTuple):
    """One try of a row that was never tried before, and so is live."""

    replicated: bool
    blocked: bool
    region: str


@dataclass
class Life:
    """What one robot gives.

    Attributes:
        tried: for each tool and shape what each try gave, in order.
        pushes: for each tool what was predicted of its pushes, and what was seen.
    """

    tried: dict[tuple[str, str], list[Tried]] = field(default_factory=dict)
    pushes: dict[str, list[Push]] = field(default_factory=dict)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--robots", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--sensor", default="noisy", choices=("noisy", "exact", "camera"))
    parser.add_argument("--json", type=Path, help="write the figures there too")
    args = parser.parse_args()
    lived = lives(args.robots, args.seed, args.sensor, args.workers)
    result: dict[str, Any] = {
        **{name: getattr(args, name) for name in ("robots", "seed", "sensor")},
        "verification": {
            f"{tool} held as {shape}": verification([life.tried[tool, shape] for life in lived])
            for tool, shape in (*INTACT, *CHANGED)
        },
        "regions": {
            f"{tool} held as {shape}": regions([life.tried[tool, shape] for life in lived])
            for tool, shape in (("t-hook", "t-hook"), ("t-hook", "l-hook"))
        },
        "prediction": {
            tool: prediction([life.pushes[tool] for life in lived]) for tool in TOOL_PARTS
        },
    }
    show(result)
    if args.json:
        args.json.write_text(as_text(result), encoding="utf-8")


def lives(robots: int, seed: int, sensor: SensorKind, workers: int) -> list[Life]:
    """Return what robots of a seed give."""
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(partial(live, seed=seed, sensor=sensor), range(robots), chunksize=4))


def live(robot: int, seed: int, sensor: SensorKind) -> Life:
    """Have one robot learn the five tools, test each table, and be asked what pushes will do."""
    life = Life()
    runs = {str(tool): hour_of(tool, seed, robot, sensor) for tool in TOOL_PARTS}
    rows = {tool: learned(run) for tool, run in runs.items()}
    for tool, shape in (*INTACT, *CHANGED):
        run, table = runs[tool], AffordanceTable(rows[tool])
        life.tried[tool, shape] = [
            Tried(record.replicated, record.execution is None, region_of(run.held, record.row))
            for record, _ in replications(tested(run, shape, len(table)), run, table)
        ]
    for tool, run in runs.items():
        staged = StagedTable(rows[tool])
        pushes = fresh_pushes(tested(run, tool, PUSHES), run)
        life.pushes[tool] = [staged.push(record) for record in pushes]
    return life


def hour_of(tool: str, seed: int, robot: int, sensor: SensorKind) -> LearningSpec:
    """Return a robot's hour with a tool."""
    parts = RunParts.chosen(with_sensor(Settings(), sensor))
    return parts.spec(tool, seed, robot, 1.0)


def tested(run: LearningSpec, shape: str, tries: int) -> VerificationSpec:
    """Return so many tries of what a run learned, with another shape held or the same."""
    held = tool_of(run, shape)
    return VerificationSpec(
        *(run.tool, held, run.seed, run.robot, run.sensor, tries), until_verdict=False
    )


def learned(run: LearningSpec) -> list[Affordance]:
    """Return the rows that an hour of babbling gives."""
    return [r.affordance for r, _ in LearningRun(run).steps() if r.affordance is not None]


def verification(tried: Sequence[Sequence[Tried]]) -> dict[str, Any]:
    """Return how often the verdict was which, and after how many tries it came."""
    whole, first, tries = Counter[str](), Counter[str](), []
    for robot in tried:
        whole[evidence_of(robot).verdict.value] += 1
        verdict, number = first_verdict(robot)
        first[verdict.value] += 1
        if verdict is not Verdict.UNDECIDED:
            tries.append(number)
    failed = [fmean(not one.replicated for one in robot) for robot in tried]
    return {
        "robots": len(tried),
        "rows": mean(len(robot) for robot in tried),
        "failed": {**mean(failed), "low": quantile(failed, 0.025), "high": quantile(failed, 0.975)},
        "blocked": fmean(one.blocked for robot in tried for one in robot),
        "until_verdict": rates(first, len(tried)),
        "tries_until_verdict": {
            "median": quantile(tries, 0.5),
            "low": quantile(tries, 0.025),
            "high": quantile(tries, 0.975),
            "max": max(tries),
        },
        "each_row_once": rates(whole, len(tried)),
    }


def evidence_of(tried: Sequence[Tried]) -> Evidence:
    """Return what some tries say of the table."""
    return Evidence(len(tried), sum(not one.replicated for one in tried))


def first_verdict(tried: Sequence[Tried]) -> tuple[Verdict, int]:
    """Return the first verdict, with which a robot in a hurry stops, and after which try it came.

    Undecided, after all of them, when there was none.
    """
    for number in range(1, len(tried) + 1):
        verdict = evidence_of(tried[:number]).verdict
        if verdict is not Verdict.UNDECIDED:
            return verdict, number
    return Verdict.UNDECIDED, len(tried)


def rates(verdicts: Counter[str], robots: int) -> dict[str, Any]:
    """Return how many robots came to each verdict, with the interval of the share."""
    return {
        verdict.value: {
            "robots": verdicts[verdict.value],
            "share_95": exact_interval(verdicts[verdict.value], robots),
        }
        for verdict in Verdict
    }


def regions(tried: Sequence[Sequence[Tried]]) -> dict[str, Any]:
    """Return how often rows replicated, by region of the tool as it was learned."""
    seen: dict[str, list[float]] = {}
    count: Counter[str] = Counter()
    for robot in tried:
        mine: dict[str, list[bool]] = {}
        for one in robot:
            mine.setdefault(one.region, []).append(one.replicated)
        for region, some in mine.items():
            seen.setdefault(region, []).append(fmean(some))
            count[region] += len(some)
    return {
        region: {"tries": count[region], **mean(shares)} for region, shares in sorted(seen.items())
    }


def prediction(pushes: Sequence[Sequence[Push]]) -> dict[str, Any]:
    """Return how well tables predict that were learned from so many rows; means over robots."""
    stages: dict[str, list[Score]] = {str(rows): [] for rows in STAGES}
    stages["all"] = []
    for robot in pushes:
        known = sorted(robot[0].predicted)
        for rows in known:
            stages["all" if rows == known[-1] else str(rows)].append(Score.of(robot, rows))
    return {name: summary(scores) for name, scores in stages.items() if scores}


def summary(scores: Sequence[Score]) -> dict[str, Any]:
    """Return the means over robots of what their tables were worth."""
    errors = {
        f"{predictor}_{kind}": mean(
            getattr(getattr(score, predictor), kind) for score in scores if score.hits
        )
        for predictor in PREDICTORS
        for kind in ("degrees", "degrees_95", "inches", "inches_95")
    }
    return {
        "robots": len(scores),
        "rows": median(score.rows for score in scores),
        "moved": fmean(score.moved / (score.moved + score.still) for score in scores),
        "hits": mean(score.hits / score.moved for score in scores),
        "false_alarms": mean(score.false_alarms / score.still for score in scores),
        **errors,
    }


def mean(values: Iterable[float]) -> dict[str, float]:
    """Return the mean over robots and its 95 % interval (normal)."""
    all_of_them = list(values)
    middle = fmean(all_of_them)
    half = 1.96 * stdev(all_of_them) / math.sqrt(len(all_of_them)) if len(all_of_them) > 1 else 0.0
    return {"mean": middle, "from": middle - half, "to": middle + half}


def as_text(result: dict[str, Any]) -> str:
    """Return the figures as JSON, one line a cell, numbers to five places."""
    lines = []
    for section, cells in rounded(result).items():
        text = json.dumps(cells)
        if isinstance(cells, dict):
            inner = (f"  {json.dumps(name)}: {json.dumps(cell)}" for name, cell in cells.items())
            text = "{\n" + ",\n".join(inner) + "\n }"
        lines.append(f" {json.dumps(section)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def rounded(value: Any) -> Any:
    """Return JSON types with their numbers rounded."""
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [rounded(item) for item in value]
    return round(value, 5) if isinstance(value, float) else value


def show(result: dict[str, Any]) -> None:
    """Print the figures."""
    print(f"{result['robots']} robots of seed {result['seed']}, sensor {result['sensor']}")
    for name, cell in result["verification"].items():
        failed, tries = cell["failed"], cell["tries_until_verdict"]
        print(
            f"{name:24} {cell['rows']['mean']:5.0f} rows, failed {failed['mean']:.4f} "
            f"[{failed['low']:.3f}, {failed['high']:.3f}], "
            f"{in_words(cell['until_verdict'])}, after {tries['median']} "
            f"[{tries['low']}, {tries['high']}], at most {tries['max']}; "
            f"each row once: {in_words(cell['each_row_once'])}"
        )
    for name, found in result["regions"].items():
        shares = (f"{region} {one['mean']:.3f}" for region, one in found.items())
        print(f"{name}: replicated {', '.join(shares)}")
    for tool, stages in result["prediction"].items():
        for rows, cell in stages.items():
            errors = " ".join(
                f"{p} {cell[f'{p}_degrees']['mean']:.1f}/{cell[f'{p}_degrees_95']['mean']:.0f} deg "
                f"{cell[f'{p}_inches']['mean']:.2f}/{cell[f'{p}_inches_95']['mean']:.2f} in;"
                for p in PREDICTORS
            )
            print(
                f"{tool:8} {rows:>3} rows: hits {interval(cell['hits'])}, false alarms "
                f"{interval(cell['false_alarms'])}, {errors}"
            )


def in_words(verdicts: dict[str, Any]) -> str:
    """Return how many robots came to each verdict."""
    return " ".join(f"{verdict} {one['robots']}" for verdict, one in verdicts.items())


def interval(cell: dict[str, float]) -> str:
    """Return a mean with its interval."""
    return f"{cell['mean']:.3f} ({cell['from']:.3f} to {cell['to']:.3f})"


if __name__ == "__main__":
    main()
