"""Every command of the program, found in the program itself, and command lines for it.

A new command or option is fuzzed by its being there; what suits an option is told by the word that
stands for its value in the help.
"""

import os
from dataclasses import dataclass
from functools import cache
from typing import Any

from hypothesis import strategies as st

TOOLS = ("t-hook", "stick", "l-hook", "l-stick", "t-stick")
FILES = (
    *("filled.db", "empty.db", "none.db", "nothing.db", "text.db"),
    *("new.png", "new.svg", "new.pdf", "new.html", "new.gif", "new.csv", "new.json", "new.avi"),
    *("new.md", "new.tex"),
    *("new.parquet", "new.mp4", "settings.toml", "colors.toml", "calibration.json", "pattern.png"),
    *("view.png", "folder", "folder/new.png", "none/new.png", "-", "/dev/null", "../../x.png"),
)
PLAUSIBLE: dict[str, tuple[str, ...]] = {
    "N": ("1", "2", "3", "4"),
    "H": ("0.01", "0.2"),
    "ID": ("1", "2", "3", "40"),
    "TRIAL": ("1", "2", "3", "40"),
    "ROW": ("1", "2", "3", "40"),
    "STEP": ("1", "2", "40"),
    "NAME": (*TOOLS, "right hook", "extend arm", "extend arm 5"),
    "KIND": ("noisy", "exact", "camera", "csv", "json", "parquet", "rows", "behaviors", "steps"),
    "FILE": FILES,
    "IMAGE": ("pattern.png", "view.png", "settings.toml", "none.png", "folder"),
    "PART": ("right hook", "handle"),
    "RANGE": ("<=0.5", ">0.5", "0.2..0.8", "1"),
    "A-B": ("1", "1-2", "2-2"),
    "X": ("1000",),
    "X,Y": ("0,0", "-12.5,3"),
    "CxR": ("6x6", "3x4"),
    "C": ("#2a7a3f", "200,10,10"),
    "DEG": ("0", "90"),
    "NAMES": ("tool", "tool,goal", "start", "task,protocol"),
    "MEASURE": ("solved", "rows", "share"),
    "AXIS": ("minutes", "rows", "sensor.position_noise", "sensor.kind"),
    "D": ("0.5", "2", "1000"),
    "P": ("0.5", "0.9"),
    "R": ("-0.5", "0", "0.9"),
    "IN": ("5", "2.5"),
    "MM": ("4.8",),
    "LOG...": ("log.txt", "log.txt", "settings.toml", "folder", "*.txt"),
    "MAP.toml": ("map.toml", "map.toml", "settings.toml", "none.toml"),
    "WAY": ("nearer", "farther", "left", "right"),
    "LENGTH": ("2in", "5cm", "0.1"),
    "QUERY": ("select * from affordance_table", "select * from trial, step"),
}
"""By the word that stands for a value. No number lets a command run for hours."""
FIGURES = ("new.png", "new.svg", "new.pdf", "view.png")
FITTING: dict[str, tuple[str, ...]] = {
    "--db": ("filled.db", "filled.db", "filled.db", "empty.db", "none.db", "nothing.db"),
    "--config": ("settings.toml",),
    "--colors": ("colors.toml",),
    "--calibration": ("calibration.json",),
    "--html": ("new.html",),
    "--gif": ("new.gif",),
    "--video": ("new.avi", "new.mp4"),
    "--out": FIGURES,
    "--tool": TOOLS[:3],
    "--shape": TOOLS,
    "--becomes": TOOLS,
    "--region": ("right hook", "handle"),
    "--behavior": ("extend arm", "extend arm 5", "slide arm left"),
    "--sensor": ("noisy", "exact", "camera"),
    "--format": ("csv", "json", "parquet", "markdown", "latex"),
    "--what": ("rows", "behaviors", "trials", "steps"),
    "--start": ("1", "4", "all"),
    "--turn": ("0", "90", "270"),
}
"""By the option, where its word alone would not tell."""
ALL_PLAUSIBLE = tuple(sorted({value for values in PLAUSIBLE.values() for value in values}))

NUMBERS = (
    *("0", "-0", "1", "-1", "2", "+1", "00000001", "1_0", "0x10", "1e1", "1.5", "-1.5", "1e-9"),
    *("1e-320", "1e308", "-1e308", "1e999", "nan", "-nan", "inf", "-inf", "Infinity", "3e5"),
    *("2147483648", "9007199254740993", "9223372036854775807", "9223372036854775808"),
    *("-9223372036854775808", "18446744073709551616", "9" * 400, "9" * 5000, "0." + "1" * 5000),
    *("\u0663", "\uff11", " 1 ", "1,2", "1-", "-", "5-1", "1-1e9", "1-99999999999999999999"),
)
TEXTS = (
    *("", " ", "\t", "\n", "a\nb", "\r", "\x1b[31mred", "\x1b]0;title\x07", "\x7f", "\x9b31m"),
    *("[/]", "[bold]x[/bold]", "[link=file:///etc/passwd]", "{x}", "%s%n", "\\", "'", '"', "`id`"),
    *("x'); DROP TABLE learning_run; --", "' OR 1=1 --", "<script>alert(1)</script>", "=1+1"),
    *("t-hook,stick", "t-hook,", ",", "T-HOOK", "t-hook\n", "all", "ALL", "none", "None"),
    *("--", "-", "--db", "--help", "-h", "--version", "-x", "--no-json", "--json=1", "@file"),
    *("\u202e", "\u200b", "\ufeff", "\U0001f528", "\u0130", "e\u0301" * 300, "x" * 10_000),
    *(os.fsdecode(b"\xff"), os.fsdecode(b"\xff\xfe.db"), "\ufdd0", "\U0010ffff"),
    *("../x.png", "../../x", "folder/../x.png", ".", "..", "./", "folder/", "x" * 300 + ".png"),
    *("file:filled.db?mode=rwc", "filled.db?mode=memory", ":memory:", "sqlite:///filled.db"),
    *("/dev/null", "/dev/full", "/nonexistent/x.png", "/proc/self/mem.png/x", "~/x.png", "$HOME"),
    *("select 1", "select 1; select 2", "attach 'x.db' as x", "pragma user_version = 9"),
)


def _speakable(text: str) -> bool:
    """Tell whether a text can be an argument, and names no file outside the test's folder."""
    try:
        os.fsencode(text)
    except UnicodeEncodeError:
        return False
    return "\0" not in text and not text.startswith("/") and "=/" not in text


ANYTHING = st.one_of(
    st.sampled_from(NUMBERS),
    st.sampled_from(TEXTS),
    st.sampled_from(ALL_PLAUSIBLE),
    st.text(max_size=40).filter(_speakable),
    st.binary(max_size=20).map(lambda raw: os.fsdecode(raw.replace(b"\0", b""))).filter(_speakable),
    st.integers().map(lambda number: str(number) if abs(number) < 4 else f"{number}0000000000"),
    st.floats().map(lambda number: str(number) if not 1e-3 < number < 1e4 else "nan"),
)


@dataclass(frozen=True, slots=True)
class Command:
    """A command as it is called.

    Args:
        words: its name.
        options: each option that wants a value, and the word that stands for it.
        flags: the options that want none.
        arguments: for each, the word that stands for it.
        needed: the options that must be given.
    """

    words: tuple[str, ...]
    options: tuple[tuple[str, str], ...]
    flags: tuple[str, ...]
    arguments: tuple[str, ...]
    needed: frozenset[str]

    @property
    def name(self) -> str:
        """Its name, with blanks between the words."""
        return " ".join(self.words)

    @property
    def own_options(self) -> tuple[tuple[str, str], ...]:
        """The options that want a value, but for the database."""
        return tuple(option for option in self.options if option[0] != "--db")


@dataclass(frozen=True, slots=True)
class CommandLine:
    """A command with all that follows it, and what changes in the environment."""

    command: Command
    args: tuple[str, ...]
    env: tuple[tuple[str, str], ...] = ()


FOR_THE_SHELL = ("--install-completion", "--show-completion")
"""Options that write into the home of whoever runs the tests, or ask which shell that is."""


@cache
def every_command() -> tuple[Command, ...]:
    """Return every command of the program, those of its groups too."""
    from affcli.cli.app import program

    found: list[Command] = []

    def walk(listed: Any, words: tuple[str, ...]) -> None:
        command = listed if hasattr(listed, "commands") else listed.loaded
        params = command.params
        options = [
            p for p in params if p.param_type_name == "option" and p.opts[0] not in FOR_THE_SHELL
        ]
        found.append(
            Command(
                words,
                tuple((p.opts[0], p.metavar or "N") for p in options if not p.is_flag),
                tuple(p.opts[0] for p in options if p.is_flag),
                tuple(p.metavar or "N" for p in params if p.param_type_name == "argument"),
                frozenset(p.opts[0] for p in options if p.required),
            )
        )
        for name, sub in getattr(command, "commands", {}).items():
            walk(sub, (*words, name))

    walk(program, ())
    return tuple(found)


USUAL = {
    "learn": ("--behaviors", "20"),
    "invent": ("--tool", "stick", "--minutes", "6"),
    "reproduce": ("--robots", "1", "--workers", "1", "--config", "settings.toml"),
    "predict": ("--pushes", "3"),
    "verify": ("--rows", "3"),
    "figure prediction": ("--pushes", "3"),
}
"""Given first where nothing else is said, so that the command ends soon."""


@st.composite
def command_lines(draw: st.DrawFn, hostile: bool = True) -> CommandLine:
    """Draw a command with options and arguments; if `hostile`, some of them of any kind."""
    command = draw(st.sampled_from(every_command()))
    # One strange thing is more often seen than hidden behind another: mostly there is one or none.
    strange = draw(st.sampled_from((0.0, 0.1, 0.2, 0.5, 1.0))) if hostile else 0.0

    def value(word: str, option: str = "") -> str:
        if strange and draw(st.floats(0.0, 1.0)) < strange:
            anything: str = draw(ANYTHING)
            return anything
        fitting = FITTING.get(option) or PLAUSIBLE.get(word, ALL_PLAUSIBLE)
        written: str = draw(st.sampled_from(fitting))
        return written

    args: list[str] = []
    chosen = draw(
        st.lists(st.sampled_from(command.own_options), max_size=3, unique=strange < 0.5)
        if command.own_options
        else EMPTY
    )
    given_options = {option for option, _ in chosen}
    if not strange or draw(st.booleans()):
        needed = command.needed - given_options
        chosen += [option for option in command.own_options if option[0] in needed]
    for option, word in chosen:
        written = value(word, option)
        args += [f"{option}={written}"] if draw(st.booleans()) else [option, written]
    if command.flags:
        args += draw(st.lists(st.sampled_from(command.flags), max_size=2, unique=strange < 0.5))
    given = [value(word) for word in command.arguments]
    if strange and draw(st.floats(0.0, 1.0)) < 0.3 * strange:
        given += draw(st.lists(ANYTHING, max_size=3))
    args = [*given, *args] if draw(st.booleans()) else [*args, *given]
    usual = USUAL.get(command.name, ())
    if usual and usual[0] not in given_options:
        args = [*usual, *args]
    if hostile and any(option == "--db" for option, _ in command.options):
        args += ["--db", value("FILE", "--db")]
    return CommandLine(command, tuple(args), draw(ENVIRONMENTS) if hostile else ())


EMPTY: st.SearchStrategy[list[tuple[str, str]]] = st.just([])
ENVIRONMENTS = st.one_of(
    st.just(()),
    st.lists(
        st.sampled_from(
            (
                *(("COLUMNS", value) for value in ("0", "1", "40", "-1", "x", "100000", "")),
                *(("LINES", value) for value in ("0", "x")),
                *(("TERM", value) for value in ("dumb", "", "linux", "\x1b")),
                *(("NO_COLOR", "1"), ("FORCE_COLOR", "1"), ("LC_ALL", "C"), ("PYTHONUTF8", "0")),
                *(("AFFCLI_DB", value) for value in ("", "filled.db", os.fsdecode(b"\xff"), "[/]")),
                *(("TZ", "Mars/Olympus"), ("HOME", ""), ("HOME", "/nonexistent"), ("LANG", "tr")),
            )
        ),
        max_size=2,
        unique_by=lambda pair: pair[0],
    ).map(tuple),
)
