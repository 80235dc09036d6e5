"""The commands of ``affcli``: what the help lists, and where each is found when it is run."""

from typing import NamedTuple


class Command(NamedTuple):
    """A command.

    Args:
        name: the word that calls it.
        home: its module in this room and its function there, ``module:function``.
        help: what it does, in one sentence: the first line of the function's docstring.
        goes_on: given again after an interruption, it goes on from what was saved.
    """

    name: str
    home: str
    help: str
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
        ),
        Command(
            "locate", "camera_locate:locate", "Say where a picture shows what is colour-coded."
        ),
        Command("view", "camera_view:view", "Show what the camera sees and how it is segmented."),
    ),
)

DB = Group(
    "db",
    "Check, copy, merge and upgrade the database file.",
    (
        Command("upgrade", "db:upgrade", "Bring the schema of an older database up to date."),
        Command("backup", "db:backup", "Write a checked copy of the database."),
        Command(
            "merge",
            "db:merge",
            "Bring robots of the same experiments together from several databases.",
        ),
        Command("check", "db:check", "Check that everything in the database is as it must be."),
        Command(
            "info",
            "db:info",
            "Show schema revision, size, journal mode, and how many rows each table has.",
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
        ),
        Command("row", "figure_learned:row", "Draw one row of an affordance table."),
        Command(
            "workspace",
            "figure_learned:workspace",
            "Draw the table: goals, starts, tool, reach of the arm.",
        ),
        Command(
            "tools", "figure_learned:tools", "Draw the five tools to scale, and one that broke."
        ),
        Command("learning", "figure_learned:learning", "Draw how learning went over robot time."),
        Command(
            "trial", "figure_tested:trial", "Draw a trial as a film strip, as in Figures 10 and 11."
        ),
        Command("results", "figure_tested:results", "Draw our intervals with the paper's counts."),
        Command(
            "adaptation",
            "figure_tested:adaptation",
            "Draw how robots adapt to a broken tool, step by step.",
        ),
        Command(
            "prediction",
            "figure_prediction:prediction",
            "Draw how well a table predicts fresh pushes.",
        ),
    ),
)

TABLE = Group(
    "table",
    "Look at the rows of the affordance tables, and take them out.",
    (
        Command("list", "table_list:list_rows", "List rows of the affordance tables."),
        Command("show", "table_show:show_row", "Show one row in full."),
        Command(
            "export",
            "table_export:export",
            "Write rows of the affordance tables for other programs.",
        ),
    ),
)

SECTIONS: dict[str, tuple[Command | Group, ...]] = {
    "Learn and use": (
        Command(
            "learn",
            "learn:learn",
            "Let a robot babble with a tool and fill its affordance table.",
            goes_on=True,
        ),
        Command(
            "solve",
            "solve:solve",
            "Bring the attractor over a goal region with the tables that were learned.",
        ),
        Command(
            "break-tool",
            "break_tool:break_tool",
            "Use a broken tool with the table of the whole one: 4 goals x 4 starts.",
        ),
        Command("verify", "verify:verify", "Let the robot test its own table: does it still hold?"),
        Command(
            "predict",
            "predict:predict",
            "Predict fresh pushes with a table, and see how often it is right.",
        ),
        Command(
            "reproduce",
            "reproduce:reproduce",
            "Reproduce the paper with many robots: five tools, 80 + 16 trials each.",
            goes_on=True,
        ),
        Command(
            "experiment",
            "experiment:experiment",
            "Let many robots live under several conditions, as a file says.",
            goes_on=True,
        ),
    ),
    "Look": (
        Command(
            "report",
            "report:report",
            "Show tools learned, rows by behavior, trials beside the paper's, and failures by "
            "kind.",
        ),
        Command(
            "replay",
            "replay:replay",
            "Replay a stored trial step by step, and compare it with its record.",
        ),
        FIGURE,
        TABLE,
        CAMERA,
    ),
    "Data": (
        Command("sql", "sql:sql", "Ask the database one question in SQL."),
        DB,
        Command("doctor", "doctor:doctor", "Say whether everything is here that affcli needs."),
        Command("cite", "cite:cite", "Say how to cite the paper and this software, in BibTeX."),
    ),
    "Extend": (
        Command(
            "list",
            "list_parts:list_parts",
            "List the parts that a run can be made of: what each is, its parameters, its source.",
        ),
        Command(
            "settings",
            "settings:settings",
            "Show all settings: what each means, its default, its unit and what it may be.",
        ),
    ),
}
"""The commands under the headings of the help, in its order."""


def goes_on(name: str) -> bool:
    """Tell whether a command, given again after an interruption, goes on from what was saved."""
    return any(
        isinstance(entry, Command) and entry.name == name and entry.goes_on
        for section in SECTIONS.values()
        for entry in section
    )
