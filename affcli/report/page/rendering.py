"""The page as one file of HTML: text is escaped, and nothing is loaded from elsewhere."""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from affcli import __version__
from affcli.core.replay import Replay
from affcli.core.task import GOAL_NUMBERS
from affcli.core.trial import Outcome, Protocol
from affcli.report.learning import clock
from affcli.report.page import answers, drawings, films
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.report.paper import EXTENSION_OF_REACH
from affcli.report.reproduction import ENOUGH_ROBOTS, reproduction_json

HOME = "affcli.report.page"
"""Where template, style sheet and scripts lie."""
KINDS = {
    Outcome.NO_ROW.value: "every row was excluded, or asks for a place out of the arm's reach",
    Outcome.ATTRACTOR_OUT_OF_REACH.value: "the puck was pushed where the tool cannot reach it",
    Outcome.STEP_LIMIT.value: "still trying when its steps ran out; the paper names no limit",
    Outcome.INVALID.value: "the simulation failed; the trial counts for nothing",
}
"""How trials fail."""
FEW = 3
"""Tries in vain that show what adaptation is."""


@dataclass(frozen=True, slots=True)
class _ToolSection:
    """What the page shows of one tool."""

    learned: LearnedRows
    panels: Sequence[drawings.Panel]
    frame: drawings.Frame
    answer: str
    clock: str
    excluded: bool


def render(content: Content, command: str) -> str:
    """Return the page.

    Args:
        content: what it shows.
        command: makes it again; shown at its end.
    """
    loader = PackageLoader(HOME, "")
    pages = Environment(
        loader=loader,
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=False,
        keep_trailing_newline=True,
    )
    pages.filters["capitalize_first"] = lambda text: text[:1].upper() + text[1:]
    sources = {name: _source(pages, name) for name in ("style.css", "tables.js", "player.js")}
    worlds = list(dict.fromkeys(replay.workspace for replay in content.replays))
    trials = [films.trial_data(r, worlds.index(r.workspace)) for r in content.replays]
    template = pages.get_template("page.html.j2")
    return template.render(
        content=content,
        version=__version__,
        command=command,
        style=sources["style.css"],
        tables=sources["tables.js"],
        player=sources["player.js"],
        points=drawings.points,
        tools=[_tool_section(tool) for tool in content.tools],
        trials=trials,
        same=answers.same(content),
        data={
            "unit": films.UNIT,
            "worlds": [films.world_data(workspace) for workspace in worlds],
            "trials": trials,
            "first": _worth_seeing(trials),
        },
        broken=[_broken_section(broken) for broken in content.broken],
        kinds=KINDS,
        **_results(content),
    )


def _source(pages: Environment, name: str) -> Markup:
    """Return a style sheet or script as it is: it is ours, and goes where nothing is escaped."""
    if pages.loader is None:
        raise LookupError(name)
    return Markup(pages.loader.get_source(pages, name)[0])  # noqa: S704 no word of a user's in it


def _results(content: Content) -> dict[str, Any]:
    """Return what the section of results shows."""
    single = _single(content.replays)
    if content.reproduction is None:
        ends = Counter(r.end.outcome.value for r in content.replays if r.end is not None)
        tried = ends.total()
        del ends[Outcome.SOLVED.value]
        return {
            "result": None,
            "results_answer": answers.solved_by_one(content.replays),
            "single": single,
            "enough": False,
            "failures": ends.most_common(),
            "failed_of": tried,
        }
    result = reproduction_json(content.reproduction)
    cells = {(cell["tool"], cell["goal"]): cell for cell in result["cells"]}
    return {
        "result": result,
        "results_answer": answers.reproduced(content.reproduction),
        "by_tool": [
            (tool, [cells[tool, goal] for goal in (1, 2, 3, 4)]) for tool in EXTENSION_OF_REACH
        ],
        "single": single,
        "enough": content.reproduction.robots >= ENOUGH_ROBOTS,
        "failures": sorted(result["failures"].items(), key=lambda item: (-item[1], item[0])),
        "failed_of": result["trials"],
    }


def _single(replays: Sequence[Replay]) -> list[tuple[str, list[tuple[int, int, int]]]]:
    """Return for each tool and goal what one robot solved and tried, and the paper's successes."""
    counts: dict[tuple[str, int], list[bool]] = defaultdict(list)
    for replay in replays:
        if replay.end is not None and replay.spec.protocol is Protocol.EXTENSION_OF_REACH:
            solved = replay.end.outcome is Outcome.SOLVED
            counts[replay.spec.tool, replay.spec.goal].append(solved)
    return [
        (
            tool,
            [
                (sum(counts[tool, goal]), len(counts[tool, goal]), in_paper)
                for goal, in_paper in enumerate(paper, 1)
            ],
        )
        for tool, paper in EXTENSION_OF_REACH.items()
        if any(counts[tool, goal] for goal in GOAL_NUMBERS)
    ]


def _tool_section(learned: LearnedRows) -> _ToolSection:
    """Return what the page shows of one tool."""
    drawn = drawings.panels(learned.tool, learned.rows)
    return _ToolSection(
        learned,
        drawn,
        drawings.frame([learned.tool], drawn),
        answers.pulls(learned),
        clock(learned.robot_seconds),
        any(arrow.excluded for panel in drawn for arrow in panel.arrows),
    )


def _broken_section(broken: Broken) -> dict[str, Any]:
    """Return what the page shows of a tool that broke."""
    result = answers.unlearned(broken)
    drawn = drawings.panels(broken.tool, broken.rows, result.excluded)
    table: dict[str, list[int]] = defaultdict(lambda: [0, 0, 0, 0])
    for number, row in broken.rows.items():
        out = number in result.excluded
        counts = (out, number in result.missing, out and number in result.lost, True)
        mine = table[str(row.exploratory)]
        for column, count in enumerate(counts):
            mine[column] += count
    return {
        "answer": answers.forgot(broken, result),
        "tool": broken.tool,
        "shape": broken.shape,
        "side": bool(broken.missing_side),
        "panels": drawn,
        "frame": drawings.frame([broken.tool], drawn),
        "missing": broken.tool.parts_missing_in(broken.shape),
        "table": [(name, *counts) for name, counts in sorted(table.items())],
    }


def _worth_seeing(trials: Sequence[dict[str, Any]]) -> int:
    """Return which trial to show first.

    The shortest in which the robot tries in vain, a few times, what its broken tool cannot do, and
    then solves the task (Figs. 10 and 11); else the longest that is solved.
    """
    solved = [i for i, trial in enumerate(trials) if trial["outcome"] == Outcome.SOLVED]
    adapted = [i for i in solved if sum(bool(s["lost"]) for s in trials[i]["steps"]) >= FEW]
    if adapted:
        return min(adapted, key=lambda i: len(trials[i]["steps"]))
    return max(solved, key=lambda i: len(trials[i]["steps"]), default=0)
