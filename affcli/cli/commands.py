"""The commands of ``affcli``: what the help lists, and where each is found when it is run."""

from collections.abc import Sequence
from typing import NamedTuple


class Command(NamedTuple):
    """A command.

    Args:
        name: the word that calls it.
        home: its module in this room and its function there, ``module:function``.
        help: what it does, in one sentence: the first line of the function's docstring.
        example: a call of it, as its row of the README has it.
        goes_on: given again after an interruption, it goes on from what was saved.
    """

    name: str
    home: str
    help: str
    example: str
    goes_on: bool = False


class Group(NamedTuple):
    """A word with commands under it."""

    name: str
    help: str
    commands: tuple[Command, ...]


CAMERA = Group(
    "camera",
    "Calibrate the camera, find things with it, look at what it sees.",
    (
        Command(
            "calibrate",
            "camera_calibrate:calibrate",
            "Calibrate a camera from a picture of markers.",
            "affcli camera calibrate --out camera.json",
        ),
        Command(
            "locate",
            "camera_locate:locate",
            "Say where a picture shows what is colour-coded.",
            "affcli camera locate picture.png --calibration camera.json",
        ),
        Command(
            "view",
            "camera_view:view",
            "Show what the camera sees and how it is segmented.",
            "affcli camera view --out view.png",
        ),
    ),
)

DB = Group(
    "db",
    "Check, copy, merge and upgrade the database file.",
    (
        Command(
            "upgrade",
            "db:upgrade",
            "Bring the schema of an older database up to date.",
            "affcli db upgrade",
        ),
        Command(
            "backup",
            "db:backup",
            "Write a checked copy of the database.",
            "affcli db backup --out copy.db",
        ),
        Command(
            "merge",
            "db:merge",
            "Bring robots of the same experiments together from several databases.",
            "affcli db merge a.db b.db --into all.db",
        ),
        Command(
            "check",
            "db:check",
            "Check that everything in the database is as it must be.",
            "affcli db check",
        ),
        Command(
            "info",
            "db:info",
            "Show schema revision, size, journal mode, and how many rows each table has.",
            "affcli db info",
        ),
    ),
)

FIGURE = Group(
    "figure",
    "Draw a figure for a paper: PNG, SVG or PDF, by the ending of the file's name.",
    (
        Command(
            "affordances",
            "figure_learned:affordances",
            "Draw what a tool affords, as arrows over its outline.",
            "affcli figure affordances --out fig6.pdf",
        ),
        Command(
            "row",
            "figure_learned:row",
            "Draw one row of an affordance table.",
            "affcli figure row 17 --out fig5.pdf",
        ),
        Command(
            "transfer",
            "figure_learned:transfer",
            "Draw what a run borrowed from others, and what it became.",
            "affcli figure transfer --run RUN --out transfer.pdf",
        ),
        Command(
            "workspace",
            "figure_learned:workspace",
            "Draw the table: goals, starts, tool, reach of the arm.",
            "affcli figure workspace --out fig8.pdf",
        ),
        Command(
            "tools",
            "figure_learned:tools",
            "Draw the five tools to scale, and one that broke.",
            "affcli figure tools --out fig9.pdf",
        ),
        Command(
            "learning",
            "figure_learned:learning",
            "Draw how learning went over robot time.",
            "affcli figure learning --out learning.pdf",
        ),
        Command(
            "trial",
            "figure_tested:trial",
            "Draw a trial as a film strip, as in Figures 10 and 11.",
            "affcli figure trial 11 --out trial.pdf",
        ),
        Command(
            "plan",
            "figure_tested:plan",
            "Draw what a planner looked at in one step of a trial.",
            "affcli figure plan TRIAL STEP --out plan.pdf",
        ),
        Command(
            "results",
            "figure_tested:results",
            "Draw our intervals with the paper's counts.",
            "affcli figure results --out results.pdf",
        ),
        Command(
            "adaptation",
            "figure_tested:adaptation",
            "Draw how robots adapt to a broken tool, step by step.",
            "affcli figure adaptation --out adaptation.pdf",
        ),
        Command(
            "prediction",
            "figure_prediction:prediction",
            "Draw how well a table predicts fresh pushes.",
            "affcli figure prediction --out prediction.pdf",
        ),
        Command(
            "compare",
            "figure_compared:compare",
            "Draw differences between conditions with their intervals.",
            "affcli figure compare EXPERIMENT --out FILE",
        ),
        Command(
            "curve",
            "figure_compared:curve",
            "Draw a measure of conditions against robot time, rows or a swept setting.",
            "affcli figure curve EXPERIMENT --out FILE",
        ),
    ),
)

RUNS = Group(
    "runs",
    "List what was learned, run by run; write notes; delete.",
    (
        Command(
            "list",
            "runs:list_runs",
            "List the learning runs, with their notes.",
            "affcli runs list",
        ),
        Command(
            "show",
            "runs:show_run",
            "Show one learning run in full, also one of which not all was kept.",
            "affcli runs show 1",
        ),
        Command(
            "note",
            "runs:note_run",
            "Write a note on a learning run, in place of the one it has.",
            'affcli runs note 1 "low friction"',
        ),
        Command(
            "delete",
            "runs:delete_run",
            "Delete a learning run and all that belongs to it.",
            "affcli runs delete ID",
        ),
    ),
)

TABLE = Group(
    "table",
    "Look at the rows of the affordance tables, and take them out.",
    (
        Command(
            "list",
            "table_list:list_rows",
            "List rows of the affordance tables.",
            "affcli table list --tool t-hook",
        ),
        Command("show", "table_show:show_row", "Show one row in full.", "affcli table show 17"),
        Command(
            "export",
            "table_export:export",
            "Write rows of the affordance tables for other programs.",
            "affcli table export --out rows.csv",
        ),
    ),
)

NEW = Group(
    "new",
    "Write a file or a package to begin with.",
    tuple(
        Command(kind, f"new:{kind}", f"Write {said}.", f"affcli new {kind} {name}")
        for kind, name, said in (
            ("tool", "rake", "a tool to begin with: a rake, with what to change said beside it"),
            (
                "behavior",
                "shove",
                "a behavior to begin with: what the wrist does, piece after piece",
            ),
            ("task", "corner", "tasks to begin with: goals, and starts of the attractor"),
            ("planner", "greedy", "a package with a planner to begin with: how to choose a row"),
            ("explorer", "in-turn", "a package with an explorer to begin with: what to try next"),
            ("world", "ice", "a package with a world to begin with: the table, changed"),
        )
    ),
)

SECTIONS: dict[str, tuple[Command | Group, ...]] = {
    "Learn and use": (
        Command(
            "learn",
            "learn:learn",
            "Let a robot babble with a tool and fill its affordance table.",
            "affcli learn --tool t-hook",
            goes_on=True,
        ),
        Command(
            "invent",
            "invent:invent",
            "Let a robot compose behaviors, and keep the few that bring something new.",
            "affcli invent --tool stick",
            goes_on=True,
        ),
        Command(
            "solve",
            "solve:solve",
            "Bring the attractor over a goal region with the tables that were learned.",
            "affcli solve --goal 2 --explain",
        ),
        Command(
            "break-tool",
            "break_tool:break_tool",
            "Use a broken tool with the table of the whole one: 4 goals x 4 starts.",
            "affcli break-tool",
        ),
        Command(
            "verify",
            "verify:verify",
            "Let the robot test its own table: does it still hold?",
            "affcli verify",
        ),
        Command(
            "predict",
            "predict:predict",
            "Predict fresh pushes with a table, and see how often it is right.",
            "affcli predict",
        ),
        Command(
            "reproduce",
            "reproduce:reproduce",
            "Reproduce the paper with many robots: five tools, 80 + 16 trials each.",
            "affcli reproduce --robots 20 --db reproduce.db",
            goes_on=True,
        ),
        Command(
            "experiment",
            "experiment:experiment",
            "Let many robots live under several conditions, as a file says.",
            "affcli experiment experiments/extension_of_reach/friction.toml",
            goes_on=True,
        ),
    ),
    "Look": (
        Command(
            "report",
            "report:report",
            "Show tools learned, rows by behavior, trials beside the paper's, and failures by "
            "kind.",
            "affcli report",
        ),
        Command(
            "which",
            "which:which",
            "Say which tool moves the attractor where, by which behavior, and how often.",
            "affcli which nearer --by 5cm",
        ),
        Command(
            "compare",
            "compare:compare",
            "Compare conditions robot by robot: did it matter?",
            "affcli compare EXPERIMENT",
        ),
        Command(
            "power",
            "power:power",
            "Say how many robots it takes to see a difference.",
            "affcli power EXPERIMENT",
        ),
        Command(
            "replay",
            "replay:replay",
            "Replay a stored trial step by step, and compare it with its record.",
            "affcli replay 11",
        ),
        FIGURE,
        TABLE,
        CAMERA,
    ),
    "Data": (
        Command(
            "import",
            "import_log:import_log",
            "Import the log of a real robot: what it did with tools, and what moved.",
            "affcli import trials.csv --map map.toml",
        ),
        RUNS,
        Command(
            "sql", "sql:sql", "Ask the database one question in SQL.", 'affcli sql "select ..."'
        ),
        DB,
        Command(
            "doctor",
            "doctor:doctor",
            "Say whether everything is here that affcli needs.",
            "affcli doctor",
        ),
        Command(
            "cite",
            "cite:cite",
            "Say how to cite the paper and this software, in BibTeX.",
            "affcli cite",
        ),
    ),
    "Extend": (
        Command(
            "list",
            "list_parts:list_parts",
            "List the parts that a run can be made of: what each is, its parameters, its source.",
            "affcli list planners",
        ),
        Command(
            "settings",
            "settings:settings",
            "Show all settings: what each means, its default, its unit and what it may be.",
            "affcli settings",
        ),
        NEW,
        Command(
            "check",
            "check:check",
            "Say what a file of yours is, or what is wrong in it and where.",
            "affcli check rake.toml",
        ),
    ),
}
"""The commands under the headings of the help, in its order."""


OWN = ("--shard", "--keep")
"""Options that --resume alone does not know, at least before a robot is saved."""


BEGINS_ANEW = frozenset({"break-tool"})
"""Commands whose trials belong together: interrupted, they are done again from the first."""


def how_it_goes_on(words: Sequence[str]) -> str:
    """Return what to do after an interruption, in words after a comma; empty where nothing is."""
    if words and words[0] in BEGINS_ANEW:
        return f", and not all was done: run affcli {words[0]} again, which begins anew"
    if not words or not goes_on(words[0]):
        return ""
    options = {word.partition("=")[0] for word in words}
    # What is invented is a learning run: invent has no --resume of its own.
    same = " with the same --db" if "--db" in options else ""
    resume = f"affcli learn --resume{same}" if words[0] == "invent" else "--resume"
    alone = "" if options.intersection(OWN) else f" (or: {resume})"
    return f", and the same command goes on from there{alone}"


def goes_on(name: str) -> bool:
    """Tell whether a command, given again after an interruption, goes on from what was saved."""
    return any(
        isinstance(entry, Command) and entry.name == name and entry.goes_on
        for section in SECTIONS.values()
        for entry in section
    )
