"""The page as one file of HTML: text is escaped, and nothing is loaded from elsewhere."""

from base64 import b64encode
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from affcli import __version__
from affcli.analysis.breaking import missing_side
from affcli.analysis.experiment import ExperimentResult
from affcli.analysis.inventions import tried_in_passing
from affcli.analysis.overview import Tried, goal_counts
from affcli.analysis.paper import (
    BROKEN_TRIALS,
    GOALS,
    TRIALS,
    row_name,
)
from affcli.analysis.reproduction import failures_in
from affcli.core.replay import Replay
from affcli.core.specs import Protocol
from affcli.core.trial import Outcome
from affcli.errors import one_line
from affcli.report.json_table import plain
from affcli.report.overview import experiment_sheets
from affcli.report.page import answers, charts, drawings, films
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.report.prediction import predictions_table
from affcli.report.reproduction import reproduction_json
from affcli.report.sheet import Sheet
from affcli.report.verification import verifications_table
from affcli.report.words import (
    call_words,
    clock,
    experiment_words,
    few_robots_note,
    in_order,
    run_words,
    spread_words,
    unknown_shapes,
)

HOME = "affcli.report.page"
"""Where template, style sheet and scripts lie."""
KINDS = {
    Outcome.NO_ROW.value: "every row was excluded, or asks for a place out of the arm's reach",
    Outcome.NO_PLAN.value: "rows could be used, but the planner chose none of them",
    Outcome.ATTRACTOR_OUT_OF_REACH.value: "the puck was pushed where the tool cannot reach it",
    Outcome.STEP_LIMIT.value: "still trying when its steps ran out; the paper names no limit",
}
"""How trials fail."""
VARIED = ("tasks", "planner", "sensor")
"""What the list of trials has a column for where it is not always the same."""
FEW = 3
"""Tries in vain that show what adaptation is."""


def render(content: Content, command: str) -> str:
    """Return the page.

    Args:
        content: what it shows.
        command: makes it again; shown at its end.
    """
    pages = Environment(
        loader=PackageLoader(HOME, ""),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_printable,
        keep_trailing_newline=True,
    )
    pages.globals["spread_words"] = spread_words
    pages.filters["capitalize_first"] = lambda text: text[:1].upper() + text[1:]
    sources = ("style.css", "tables.js", "saving.js", "player.js")
    style, tables, saving, player = (_source(pages, name) for name in sources)
    worlds = list(dict.fromkeys(replay.workspace for replay in content.replays))
    runs = {learned.run.id: learned.run for learned in content.tools}
    whose = {learned.run.id: learned.robot for learned in content.tools}
    robots = list(dict.fromkeys(whose.values()))
    trials = [
        films.trial_data(replay, runs[replay.run_id], worlds.index(replay.workspace))
        for replay in content.replays
    ]
    listed = _listed(content, whose)
    return pages.get_template("page.html.j2").render(
        content=content,
        version=__version__,
        command=command,
        style=style,
        tables=tables,
        saving=saving,
        player=player,
        outline=drawings.outline,
        open_run=next((one.run.id for one in reversed(content.tools) if one.filmed), None),
        robots=robots if len(robots) > 1 else [],
        more_robots=more_robots(content),
        tools=[_tool_section(learned) for learned in content.tools],
        trials=trials,
        listed=listed,
        # What is the same in all trials needs no column.
        varied=[name for name in VARIED if len({str(one[name]) for one in listed}) > 1],
        charts=charts.charts(content.tools, content.curves, content.bands),
        sheets=_sheets(content),
        worth=answers.worth(content),
        same=answers.same(content),
        left_out=answers.left_out(content),
        data=plain(
            {
                "unit": films.UNIT,
                "worlds": [films.world_data(workspace) for workspace in worlds],
                "trials": trials,
                "first": _worth_seeing(trials),
            }
        ),
        broken=[_broken_section(broken) for broken in content.broken],
        kinds=KINDS,
        goals=GOALS,
        sums={"total": TRIALS, "broken": BROKEN_TRIALS},
        experiments=[_experiment_section(one, content.drawn) for one in content.experiments],
        **_results(content),
    )


def _experiment_section(one: ExperimentResult, drawn: Mapping[str, bytes]) -> dict[str, Any]:
    """Return what the page shows of an experiment."""
    picture = drawn.get(one.name)
    return {
        "question": one.question or one.name,
        "words": experiment_words(one),
        "sheets": experiment_sheets(one),
        "picture": picture and f"data:image/svg+xml;base64,{b64encode(picture).decode()}",
    }


def _listed(content: Content, whose: Mapping[int, str]) -> list[dict[str, Any]]:
    """Return the lines of the list of trials; of those without a film, what is stored with them."""

    def line(trial: Tried, number: int, steps: int | None, found: int | None) -> dict[str, Any]:
        return {
            **films.which(trial.spec),
            "robot": whose[trial.run_id],
            "id": number,
            "filmed": found is not None,
            "outcome": "interrupted" if trial.outcome is None else trial.outcome.value,
            "steps": steps,
            "replicated": found,
        }

    def again(one: Replay) -> int:
        return sum(step.step.record.replicated for step in one.steps)

    return [
        *(line(one, one.trial_id, len(one.steps), again(one)) for one in content.replays),
        *(line(one, one.id, one.steps, None) for one in content.others),
    ]


def more_robots(content: Content) -> str:
    """Return what stands beside the choice of robots: whose films are here, how to get others."""
    if not content.others and not content.not_shown:
        return ""
    option = "--run ID" if content.tools[0].run.session_id is None else "--robot N"
    more = content.not_shown
    not_shown = f" {more} more {'are' if more > 1 else 'is'} in the database." if more else ""
    return (
        f"Films are here of {content.robot}; of others affcli report --html FILE {option} makes "
        f"them.{not_shown}"
    )


def _sheets(content: Content) -> list[Sheet]:
    """Return tables on what the affordance tables are worth; none that is empty."""
    asked = [(one.robot, one.run.spec.tool, one.pushes) for one in content.tools if one.pushes]
    return [
        *([predictions_table(asked)] if asked else []),
        *([verifications_table(content.verifications)] if content.verifications else []),
    ]


def _printable(value: object) -> object:
    """Return a text without what is not printable; what is HTML already as it is."""
    plain = isinstance(value, str) and not isinstance(value, Markup)
    return one_line(value, 10_000) if plain else value


def _source(pages: Environment, name: str) -> Markup:
    """Return a style sheet or script as it is: it is ours, and goes where nothing is escaped."""
    if pages.loader is None:
        raise LookupError(name)
    return Markup(pages.loader.get_source(pages, name)[0])  # noqa: S704 no word of a user's in it


def _results(content: Content) -> dict[str, Any]:
    """Return what the section of results shows."""
    single_goals, single = _single(content)
    shared = {"single": single, "single_goals": single_goals}
    if content.reproduction is None:
        ends = Counter(r.outcome for r in content.replays if r.outcome is not None)
        failed = failures_in(ends)
        return {
            **shared,
            "result": None,
            "results_answer": answers.solved_by_one(content.replays),
            "failures": failed.kinds.items(),
            "failed_of": failed.trials,
            "invalid": failed.invalid,
        }
    result = reproduction_json(content.reproduction)
    by_tool: dict[str, dict[str, dict[str, Any]]] = defaultdict(dict)
    for cell in result["cells"]:
        by_tool[cell["tool"]][cell["goal"]] = cell
    return {
        **shared,
        "result": result,
        "results_answer": answers.reproduced(content.reproduction),
        "by_tool": by_tool.items(),
        "settings": run_words(content.reproduction.session.spec),
        "within": spread_words(content.reproduction.robots),
        "few": few_robots_note(content.reproduction.robots),
        "failures": result["failures"].items(),
        "failed_of": result["trials"],
        "invalid": result["invalid"],
    }


def _single(content: Content) -> tuple[list[str], list[tuple[str, str, list[dict[str, Any]]]]]:
    """Return the goals; and for each row whose it is, and what was solved and tried of each goal.

    A row is a tool, and what is not the usual of planner, tasks and, where it differs, sensor.
    """
    every: list[Tried] = [*content.replays, *content.others]
    whole = [r for r in every if r.spec.protocol is Protocol.EXTENSION_OF_REACH]
    counts = goal_counts(whole, [learned.run for learned in content.tools])
    sensors = {one.by.sensor for one in counts}
    whose = {learned.run.id: learned.robot for learned in content.tools}
    rows: dict[tuple[str, int], dict[str, dict[str, Any]]] = defaultdict(dict)
    for one in counts:
        by = one.by
        name = row_name(by.tool, by.planner, by.task_set)
        if len(sensors) > 1:
            name += f", {by.sensor}"
        if len(set(whose.values())) > 1:
            name += f", {whose[by.run]}, run {by.run}"
        for goal, (solved, tried) in one.goals.items():
            rows[name, by.run][goal] = {"solved": solved, "tried": tried, "paper": one.paper(goal)}
    goals = in_order(goal for cells in rows.values() for goal in cells)
    none = {"solved": 0, "tried": 0, "paper": None}
    return goals, [
        (name, whose[run], [cells.get(goal, none) for goal in goals])
        for (name, run), cells in rows.items()
    ]


def _tool_section(learned: LearnedRows) -> dict[str, Any]:
    """Return what the page shows of one tool."""
    spec = learned.run.spec
    calls = [one.call for one in spec.repertoire]
    passing = tried_in_passing(spec.repertoire, learned.rows.values())
    shown = {n: row for n, row in learned.rows.items() if row.exploratory not in passing}
    drawn = drawings.panels(spec.held, spec.binding, shown, calls=calls)
    return {
        "run": learned.run,
        "robot": learned.robot,
        "not_asked": learned.not_asked,
        "rows": len(learned.rows),
        "panels": drawn,
        "frame": drawings.frame(drawn),
        "answer": answers.pulls(learned),
        "time": "" if spec.logged else f" in {clock(learned.run.robot_seconds)}",
        "settings": run_words(spec),
        "unknown": drawings.LOGGED if spec.logged else unknown_shapes([spec.held]),
        "excluded": any(arrow.excluded for panel in drawn for arrow in panel.arrows),
    }


def _broken_section(broken: Broken) -> dict[str, Any]:
    """Return what the page shows of a tool that broke."""
    dead, rows = answers.excluded_rows(broken), broken.learned.rows
    spec, trial = broken.learned.run.spec, broken.trials[0].spec
    left = trial.held
    gone = {number: row.trials for number, row in dead.items()}
    calls = [one.call for one in spec.repertoire]
    drawn = drawings.panels(spec.held, spec.binding, rows, gone, calls)
    table: dict[str, list[int]] = defaultdict(lambda: [0, 0, 0, 0])
    for number, row in rows.items():
        one = dead.get(number)
        out = (True, one.on_missing_side, one.lost) if one else (False, False, False)
        mine = table[call_words(row.exploratory)]
        for column, count in enumerate((*out, True)):
            mine[column] += count
    return {
        "answer": answers.forgot(broken),
        "tool": spec.held,
        "robot": broken.learned.robot,
        "shape": left,
        "by": row_name("", str(trial.planner), trial.task_set),
        "side": missing_side(spec.held, left) != 0.0,
        "panels": drawn,
        "frame": drawings.frame(drawn),
        "missing": {part.name for part in spec.held.parts_missing_in(left)},
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
