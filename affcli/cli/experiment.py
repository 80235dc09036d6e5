"""``affcli experiment``: many robots under several conditions, as a TOML file says (§6, §7)."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from affcli import lab
from affcli import store as stores
from affcli.cli.database import opened, say_beyond_reach, say_failed
from affcli.cli.options import AsJson, Database, Resume, Scheduler, Workers, checked_pool
from affcli.cli.terminal import progress, say, show_either
from affcli.core.names import one_of
from affcli.core.specs import Keep
from affcli.errors import BadInputError, PartFailedError, UsageError, one_line
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.experiment import (
    Cost,
    cost_json,
    cost_table,
    experiment_json,
    experiment_tables,
    invalid_words,
)
from affcli.report.words import many


@dataclass(frozen=True, slots=True)
class Shard:
    """One of several parts of the robots: every Nth, from the Kth on."""

    part: int = 1
    parts: int = 1

    def of(self, robots: int) -> range:
        """Return the numbers of its robots."""
        return range(self.part - 1, robots, self.parts)


def checked_shard(text: str) -> Shard:
    """Return the part that ``K/N`` names; BadInputError when K does not lie in 1 to N."""
    found = re.fullmatch(r"([0-9]{1,6})/([0-9]{1,6})", text)
    part, parts = (int(found[1]), int(found[2])) if found else (0, 0)
    if not 1 <= part <= parts:
        raise BadInputError(f"--shard {one_line(text, 40)}: must be K/N, the Kth of N, as in 3/10")
    return Shard(part, parts)


def checked_keep(text: str) -> Keep:
    """Return how much of a life is kept; UsageError when there is no such measure."""
    return one_of("measure of what to keep", text, Keep)


def experiment(
    *,
    file: Annotated[
        Path | None,
        typer.Argument(
            help="What is to be done: a TOML file.", metavar="FILE.toml", readable=False
        ),
    ] = None,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say what it will take; do nothing.")
    ] = False,
    resume: Resume = False,
    shard: Annotated[
        Shard | None,
        typer.Option(
            "--shard",
            help="Of N machines the Kth: let every Nth robot live.",
            metavar="K/N",
            parser=checked_shard,
        ),
    ] = None,
    keep: Annotated[
        Keep | None,
        typer.Option(
            "--keep",
            help="all, the usual; rows: no behaviors; trials: only how runs and trials ended.",
            metavar="WHAT",
            parser=checked_keep,
        ),
    ] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> int:
    """Let many robots live under several conditions, as a file says.

    Conditions are paired robot by robot: what they share is learned once. The result is the same
    for any number of workers. An interrupted experiment goes on when the same command is given
    again, as does the latest one with --resume alone, but for its --shard. A robot that fails three
    times is named, and the others go on (exit code 4); the same command tries it again. Exit code 4
    also when no trial of a condition counts, because a part failed.
    """
    pool = checked_pool(workers, scheduler)
    if file is None and (dry_run or not resume):
        raise UsageError("which experiment? give a TOML file, or --resume")
    wanted = None if file is None else lab.definition.experiment_file(file)
    if dry_run and wanted is not None:
        _say_cost(wanted, shard or Shard(), pool, keep or Keep.ALL, as_json=as_json)
        return 0
    with opened(database, create=wanted is not None, write=True) as store:
        what = wanted or _interrupted(store, database)
        info = lab.conducting.begin(store, what, now, keep)
        for one in what.conditions:
            own = [tasks for tasks in one.tasks if not isinstance(tasks, str)]
            say_beyond_reach([task for tasks in own for task in tasks], one.parts)
        robots = (shard or Shard()).of(what.robots)
        with progress(one_line(what.name), len(robots), "robots") as bar:
            for saved in lab.conducting.run(store, what, info, pool, now, say, robots, keep):
                bar(saved, "")
        # Meanwhile another process may have asked for more robots.
        wished = store.experiments.named(what.name).definition["experiment"]["robots"]
        result = lab.overview.experiment_of(store, info)
    count = f"{result.robots} of " * (result.robots != wished) + many(wished, "robot")
    say(f"experiment {one_line(what.name)}: {count}, saved in {one_line(database)}")
    show_either(
        as_json=as_json,
        results=lambda: [experiment_json(result)],
        tables=lambda: experiment_tables(result),
    )
    for condition in result.results:
        if words := invalid_words(condition):
            say(f"{words}; they stay as stored: another name or --db tries again")
    nothing_counts = any(one.invalid.trials and not one.tallies for one in result.results)
    return say_failed(result.failed) or (PartFailedError.exit_code if nothing_counts else 0)


def _interrupted(store: "stores.Store", database: Path) -> "lab.experiment.Experiment":
    """Return the experiment that was begun last and is not done."""
    begun = [one for one in store.experiments.all() if one.status == "running"]
    if not begun:
        raise UsageError(f"nothing to resume in {database}; begin one: affcli experiment FILE.toml")
    place = f"experiment {one_line(begun[-1].name)} in {database}"
    return lab.definition.experiment_of(begun[-1].definition, place)


def _say_cost(
    what: "lab.experiment.Experiment", shard: Shard, pool: object, keep: Keep, *, as_json: bool
) -> None:
    """Let one robot live, and say what all of them will take; in a cluster, on one worker."""
    robots = shard.of(what.robots)
    with progress("one robot", 1.0):
        found = lab.conducting.estimate(what, now, keep, robots)
    counts = (found.robots, found.learning_runs, found.trials, found.robot_hours)
    workers = pool if isinstance(pool, int) else 1
    cost = Cost(*counts, found.seconds, found.bytes, workers)
    names = [condition.name for condition in what.conditions]
    show_either(
        as_json=as_json,
        results=lambda: [cost_json(names, cost)],
        tables=lambda: [cost_table(what.name, names, cost)],
    )
