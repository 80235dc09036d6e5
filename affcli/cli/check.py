"""``affcli check``: what a file is that a person wrote, or what is wrong in it and where; and
whether a part keeps the contract of its kind.
"""

from pathlib import Path
from typing import Annotated, Any

import typer

from affcli import lab, registry
from affcli.cli.files import require_new, save
from affcli.cli.options import FIGURE_ENDINGS, PART, AsJson, Changes, Config, Force
from affcli.cli.terminal import progress, say, show_either
from affcli.config import Settings, load_settings
from affcli.core.behavior import ExploratoryBehavior
from affcli.core.geometry import Pose
from affcli.core.names import one_of
from affcli.core.part import Kind
from affcli.core.task import Task
from affcli.core.tool import Tool
from affcli.errors import UsageError, one_line
from affcli.lab.drawing import require_figures
from affcli.report import figures
from affcli.report.checked import checked_json, checked_table, part_json, part_table
from affcli.simulation.arm import reach_at


def checked_kind(text: str) -> Kind:
    """Return the kind that a word names: ``planner``; UsageError when there is none."""
    words = [kind.removesuffix("s") for kind in registry.KINDS]
    return registry.KINDS[words.index(one_of("kind of part", text, words))]


def check(
    file: Annotated[
        Path | None,
        typer.Argument(
            help="A tool, a behavior, tasks, a map of a log, an experiment, or settings, in TOML.",
            metavar="FILE.toml",
            readable=False,
        ),
    ] = None,
    *,
    kind: Annotated[
        Kind | None,
        typer.Option(
            "--part",
            help="Instead of a file: of this kind (planner, explorer, world, ...),",
            metavar="KIND",
            parser=checked_kind,
        ),
    ] = None,
    name: Annotated[
        str | None,
        typer.Option("--name", help="the part of this name; run its suite of tests.", metavar=PART),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Draw what it is: *.png, *.svg or *.pdf.", metavar="FILE"),
    ] = None,
    force: Force = False,
    config: Config = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> int:
    """Say what a file of yours is, or what is wrong in it and where.

    Of a tool also whether babbling and a camera can do with it; --out draws tools, behaviors and
    tasks. With --part and
    --name: whether a part keeps the contract of its kind (exit code 1 if it does not).
    """
    if (file is None) is (kind is None) or (kind is None) is not (name is None):
        raise UsageError("check what? give a file, or --part KIND with --name NAME")
    if kind is not None:
        if out is not None or config is not None or changes:
            raise UsageError("--part is checked as it is: leave out --out, --config and --set")
        return _check_part(kind, name or "", as_json=as_json)
    settings = load_settings(config, changes or ())
    return _check_file(file or Path(), out, settings, force=force, as_json=as_json)


def _check_part(kind: Kind, text: str, *, as_json: bool) -> int:
    """Run the suite of a part; return 1 if it fails a test."""
    chosen = registry.component(kind, text)
    values = registry.part(kind, chosen.name).values(chosen)
    tests: list[tuple[str, str, str]] = []
    with progress(str(chosen), 1.0) as bar:
        for verdict in lab.conforming.conforming(kind, chosen.name, values):
            tests.append(verdict)
            bar(0.0, f"{len(tests)} tests")
    said = (kind.removesuffix("s"), str(chosen), tests)
    show_either(
        as_json=as_json,
        results=lambda: [part_json(*said)],
        tables=lambda: [part_table(*said)],
    )
    return 1 if any(what == "failed" for _, what, _ in tests) else 0


def _figure(found: "lab.checking.Checked", file: Path, settings: Settings) -> Any:
    """Return a drawing of what a file describes."""
    place = settings.workspace
    in_the_hand = registry.tool(lab.checking.TRIED_WITH, place.tools)
    match found.drawn:
        case Tool() as tool:
            broken = (tool, tool.without(tool.loses)) if tool.loses else None
            return figures.tools.tools_figure([tool], broken, place.puck.radius)
        case ExploratoryBehavior(_, motion):
            start = Pose(*place.wrist_start)
            return figures.behavior.behavior_figure(motion, in_the_hand, start, place.table)
        case (Task(), *_) as tasks:
            reach = reach_at(place.arm, place.arm.flange_height)
            return figures.workspace.workspace_figure(place, in_the_hand, reach, tasks)
    raise UsageError(f"--out draws tools, behaviors and tasks; {one_line(file)} is {found.kind}")


def _check_file(
    file: Path, out: Path | None, settings: Settings, *, force: bool, as_json: bool
) -> int:
    """Say what a file is, and draw it."""
    if out is not None:
        require_new(out, force=force, endings=FIGURE_ENDINGS)
        require_figures()
    found = lab.checking.checked(file, settings)
    if out is not None:
        drawn = _figure(found, file, settings)
        save(out, figures.canvas.encoded(drawn, out.suffix, title="", caption="", dpi=300))
        say(f"{found.name}, to scale: {one_line(out)}")
    said = (found.kind, found.name, found.facts)
    show_either(
        as_json=as_json,
        results=lambda: [{"file": str(file), **checked_json(*said)}],
        tables=lambda: [checked_table(*said)],
    )
    return 0
