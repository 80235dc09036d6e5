"""``affcli learn``: a robot babbles with a tool for an hour and keeps what it saw (§6)."""

from typing import Annotated

import typer

from affcli import lab, registry
from affcli import store as stores
from affcli.cli.database import opened
from affcli.cli.options import (
    DEFAULT_DATABASE,
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
    checked_hours,
)
from affcli.cli.terminal import now, progress, say, show_either
from affcli.config import load_settings, with_sensor
from affcli.core.limits import MOST_BEHAVIORS
from affcli.core.records import AlikeRun, LearningRunInfo
from affcli.core.results import BehaviorGroup
from affcli.core.specs import LearningSpec
from affcli.errors import BadInputError, UsageError
from affcli.report.learning import groups_json, groups_table, run_json, summary
from affcli.simulation.tools.paper import TOOL_PARTS


def learn(
    *,
    tool: Tools = None,
    all_tools: Annotated[bool, typer.Option("--all-tools", help="The paper's five tools.")] = False,
    hours: Annotated[
        float | None,
        typer.Option(
            "--hours",
            help="Robot hours; 1 if not given.",
            metavar="H",
            callback=check_if_given(checked_hours),
        ),
    ] = None,
    behaviors: Annotated[
        int | None,
        typer.Option(
            "--behaviors",
            help="Instead of hours.",
            metavar="N",
            callback=check_count("--behaviors", MOST_BEHAVIORS),
        ),
    ] = None,
    seed: Seed = 0,
    repertoire: Repertoire = None,
    binding: Binding = None,
    explorer: Explorer = None,
    sensor: Sensor = None,
    world: World = None,
    resume: Resume = False,
    database: Database = DEFAULT_DATABASE,
    config: Config = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> None:
    """Let a robot babble with a tool and fill its affordance table.

    The same command again says that the run is done; after an interruption it goes on, as does
    --resume alone.
    """
    names = _tools_asked_for(tool, all_tools=all_tools)
    own = (hours, behaviors, seed, sensor, config, changes, repertoire, binding, explorer, world)
    _check_together(names, hours, behaviors, resume=resume, own=any(own))
    if behaviors is None and hours is None:
        hours = 1.0

    settings = with_sensor(load_settings(config, changes or ()), sensor)
    parts = lab.run_parts.RunParts.chosen(
        settings, repertoire=repertoire or (), binding=binding, explorer=explorer, world=world
    )
    specs = [parts.spec(name, seed, 0, hours, behaviors) for name in names]
    with opened(database, create=bool(names), write=True) as store:
        if not names:
            specs = lab.learning.interrupted(store)
            if not specs:
                raise UsageError(f"nothing to resume in {database}; learn a tool: --tool t-hook")
        found, stuck = _learn_all(store, specs, all_or_none=bool(names))
    show_either(
        as_json=as_json,
        results=lambda: [
            {**run_json(learned.info), "new": learned.new, "groups": groups_json(group)}
            for learned, group in found
        ],
        tables=lambda: [groups_table(learned.info, group) for learned, group in found],
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
    names: list[str], hours: float | None, behaviors: int | None, *, resume: bool, own: bool
) -> None:
    """Refuse options that do not go together: nothing that is asked for is ignored."""
    if not names and not resume:
        known = "|".join(registry.parts("tools"))
        raise UsageError(f"which tool? give --tool {known}, or --all-tools")
    if not names and own:
        raise UsageError("--resume alone: an interrupted run has its own hours, seed and settings")
    if hours is not None and behaviors is not None:
        raise UsageError("give --hours or --behaviors, not both")


def _learn_all(
    store: "stores.Store", specs: list[LearningSpec], *, all_or_none: bool
) -> tuple[list[tuple["lab.learning.Learned", tuple[BehaviorGroup, ...]]], list[str]]:
    """Return what the runs gave, with their rows counted, and why others cannot go on.

    A run whose parts are not all here does not keep the others from going on, unless `all_or_none`.
    """
    found, stuck = [], []
    for spec in specs:
        try:
            learned = _learn(store, spec)
        except BadInputError as error:
            if all_or_none:
                raise
            stuck.append(f"the interrupted {spec.tool}, seed {spec.seed}: {error}")
        else:
            found.append((learned, store.results.behavior_groups(learned.info.id)))
    return found, stuck


def _learn(store: "stores.Store", spec: LearningSpec) -> "lab.learning.Learned":
    """Run one learning run with progress on stderr; say what it gave."""
    for alike in lab.learning.made_by_other_defaults(store, spec):
        say(_in_words(alike))
    goal = 3600.0 * spec.hours if spec.hours is not None else float(spec.behaviors or 0)
    with progress(spec.tool, goal) as bar:

        def update(info: LearningRunInfo) -> None:
            """Show the robot clock, behaviors, rows and resets."""
            done = info.robot_seconds if spec.hours is not None else info.behaviors
            bar(min(done, goal), summary(info))

        learned = lab.learning.learn(store, spec, now, update)
    info = learned.info
    verb = "learned" if learned.new else "already learned, nothing to do:"
    say(f"{verb} {spec.tool} (run {info.id}, seed {spec.seed}): {summary(info)}")
    return learned


def _in_words(alike: AlikeRun) -> str:
    """Say of a stored run by the same command what was otherwise then."""
    words = ", ".join(f"{one.name} was {one.stored}, now {one.wanted}" for one in alike.changed)
    return f"run {alike.run.id} is of the same command, but {words}: learning anew"
