"""``affcli learn``: a robot babbles with a tool for an hour and keeps what it saw (§6)."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

import typer

from affcli import lab, registry
from affcli import store as stores
from affcli.cli.database import opened
from affcli.cli.options import (
    MOST_WORKERS,
    AsJson,
    Binding,
    Changes,
    Config,
    Database,
    Explorer,
    Repertoire,
    Resume,
    Seed,
    Sensor,
    Tools,
    World,
    check_count,
    check_if_given,
    checked_hours_or_none,
    checked_minutes_or_none,
    checked_note,
)
from affcli.cli.terminal import bars, say, show_either
from affcli.config import load_settings, with_sensor
from affcli.core.limits import MOST_BEHAVIORS
from affcli.core.records import AlikeRun, LearningRunInfo
from affcli.core.specs import LearningSpec
from affcli.errors import BadInputError, UsageError
from affcli.lab.clock import now
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.learning import groups_json, groups_table, run_json, summary
from affcli.report.transferring import borrowed_table
from affcli.simulation.tools.paper import TOOL_PARTS

AllTools = Annotated[bool, typer.Option("--all-tools", help="The paper's five tools.")]
Hours = Annotated[
    float | None,
    typer.Option(
        "--hours",
        help="Robot hours; 1 if not given.",
        metavar="H",
        callback=check_if_given(checked_hours_or_none),
    ),
]
Minutes = Annotated[
    float | None,
    typer.Option(
        "--minutes",
        help="Instead of hours; 0 to borrow only.",
        metavar="M",
        callback=check_if_given(checked_minutes_or_none),
    ),
]
TransferFrom = Annotated[
    list[str] | None,
    typer.Option(
        "--transfer-from",
        help="First it borrows from these runs what carries over.",
        metavar="RUN,...",
    ),
]
Behaviors = Annotated[
    int | None,
    typer.Option(
        "--behaviors",
        help="Instead of hours.",
        metavar="N",
        parser=check_count("--behaviors", MOST_BEHAVIORS),
    ),
]
Workers = Annotated[
    int,
    typer.Option(
        "--workers",
        help="Processes, when there are several tools.",
        metavar="N",
        parser=check_count("--workers", MOST_WORKERS),
    ),
]
Note = Annotated[
    str | None,
    typer.Option(
        "--note",
        help="What you want to remember of it.",
        metavar="TEXT",
        callback=check_if_given(checked_note),
    ),
]


def learn(
    *,
    tool: Tools = None,
    all_tools: AllTools = False,
    hours: Hours = None,
    minutes: Minutes = None,
    behaviors: Behaviors = None,
    transfer_from: TransferFrom = None,
    seed: Seed = 0,
    repertoire: Repertoire = None,
    binding: Binding = None,
    explorer: Explorer = None,
    sensor: Sensor = None,
    world: World = None,
    resume: Resume = False,
    workers: Workers = 1,
    note: Note = None,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> None:
    """Let a robot babble with a tool and fill its affordance table.

    With --transfer-from it first borrows, from what was learned with other tools, the rows in whose
    surroundings the new tool looks alike (§8).

    The same command again says that the run is done; after an interruption it goes on, as does
    --resume alone.
    """
    names = _tools_asked_for(tool, all_tools=all_tools)
    lengths = (hours, minutes, behaviors)
    own = (*(one is not None for one in lengths), seed, sensor, config, changes, transfer_from)
    own = (*own, repertoire, binding, explorer, world)
    _check_together(names, lengths, resume=resume, own=any((*own, note)))
    given = "--hours" if minutes is None else "--minutes"
    if minutes is not None:
        hours = minutes / 60.0
    elif behaviors is None and hours is None:
        hours = 1.0
    if hours == 0.0 and not transfer_from:
        raise BadInputError(
            f"{given} 0.0: must be more than 0, but for what only borrows: --transfer-from RUN,..."
        )

    settings = with_sensor(load_settings(config, changes or ()), sensor)
    parts = lab.run_parts.RunParts.chosen(
        settings,
        repertoire=lab.inventing.repertoire_of(repertoire, database),
        binding=binding,
        explorer=explorer,
        world=world,
    )
    specs = [parts.spec(name, seed, 0, hours, behaviors) for name in names]
    with opened(database, create=bool(names) and not transfer_from, write=True) as store:
        if transfer_from:
            lenders = lab.transferring.joined(transfer_from)
            transfer = lab.transferring.transfer_from(store, lenders)
            specs = [replace(spec, transfer=transfer) for spec in specs]
        if not names:
            specs = lab.learning.interrupted(store)
            if not specs:
                raise UsageError(f"nothing to resume in {database}; learn a tool: --tool t-hook")
        runs, stuck = begun_runs(store, specs, note, all_or_none=bool(names))
        done = learned_runs_of(store, runs, workers)
        found = [(run, store.results.behavior_groups(run.id)) for run in done]
        lent = [(run.id, *lab.transferring.borrowed_of(store, run.id)) for run in done]
    for words in filter(None, (lab.run_parts.beyond_the_box(run.spec) for run in done)):
        say(words)
    new = {run.id for run in runs if run.status != "done"}
    show_either(
        as_json=as_json,
        results=lambda: [
            {**run_json(run), "new": run.id in new, "groups": groups_json(groups)}
            for run, groups in found
        ],
        tables=lambda: [
            *(groups_table(run, groups) for run, groups in found if groups),
            *(borrowed_table(*one) for one in lent if one[1]),
        ],
    )
    if stuck:
        for line in stuck[:-1]:
            say(line)
        raise BadInputError(stuck[-1])


def _tools_asked_for(tool: list[str] | None, *, all_tools: bool) -> list[str]:
    """Return the tools that are asked for: none to go on with what was interrupted."""
    if all_tools and tool:
        raise UsageError("give --tool or --all-tools, not both")
    return list(TOOL_PARTS) if all_tools else list(tool or ())


def _check_together(
    names: list[str], lengths: Sequence[float | None], *, resume: bool, own: bool
) -> None:
    """Refuse options that do not go together: nothing that is asked for is ignored."""
    if not names and not resume:
        known = "|".join(registry.parts("tools"))
        raise UsageError(f"which tool? give --tool {known}, or --all-tools")
    if not names and own:
        raise UsageError("--resume alone: an interrupted run has its own hours, seed and settings")
    if sum(length is not None for length in lengths) > 1:
        raise UsageError("give one of --hours, --minutes and --behaviors")


def begun_runs(
    store: "stores.Store", specs: list[LearningSpec], note: str | None, *, all_or_none: bool
) -> tuple[list[LearningRunInfo], list[str]]:
    """Return the runs as far as they came, and why others cannot go on.

    A run whose parts are not all here does not keep the others from going on, unless `all_or_none`:
    then none is begun.
    """
    for spec in specs:
        for alike in lab.learning.made_by_other_defaults(store, spec):
            say(_in_words(alike))
        found = store.learning.find(spec)
        gone = lab.transferring.lenders_gone(store, spec)
        if gone and found is not None and found.status != "done":
            say(gone)
    if all_or_none:
        return lab.learning.all_begun(store, specs, now, note, say), []
    runs, stuck = [], []
    for spec in specs:
        try:
            runs.append(lab.learning.begun(store, spec, now, note, say))
        except BadInputError as error:
            stuck.append(f"the interrupted {spec.tool}, seed {spec.seed}: {error}")
    return runs, stuck


def learned_runs_of(
    store: "stores.Store", runs: list[LearningRunInfo], workers: int
) -> list[LearningRunInfo]:
    """Let runs go on to their end, with a bar for each on stderr; say what each gave."""
    done = {run.id: run for run in runs if run.status == "done"}
    for run in done.values():
        _say_done("already learned, nothing to do:", run)
    with bars({run.id: (run.spec.tool, _goal(run)) for run in runs if run.id not in done}) as bar:
        for run in lab.learning.learn_all(store, runs, now, workers, say):
            clock = run.robot_seconds if run.spec.hours is not None else run.behaviors
            bar(run.id, min(clock, _goal(run)), summary(run))
            if run.status == "done":
                done[run.id] = run
                _say_done("learned", run)
    return [done[run.id] for run in runs]


def _goal(run: LearningRunInfo) -> float:
    """Return when a run is done: at so many seconds of the robot, or behaviors."""
    spec = run.spec
    return 3600.0 * spec.hours if spec.hours is not None else float(spec.behaviors or 0)


def _say_done(verb: str, run: LearningRunInfo) -> None:
    """Say what a finished run gave."""
    say(f"{verb} {run.spec.tool} (run {run.id}, seed {run.spec.seed}): {summary(run)}")


def _in_words(alike: AlikeRun) -> str:
    """Say of a stored run by the same command what was otherwise then."""
    words = ", ".join(f"{one.name} was {one.stored}, now {one.wanted}" for one in alike.changed)
    return f"run {alike.run.id} is of the same command, but {words}: learning anew"
