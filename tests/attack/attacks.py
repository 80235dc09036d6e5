"""What is attacked, with what, and when: all of it drawn from a seed."""

import shutil
import signal
from dataclasses import dataclass
from functools import cache

import numpy as np

from tests.fuzz.commands import FITTING, PLAUSIBLE, TOOLS, USUAL, Command, every_command
from tests.states.commands import ALWAYS_WRITE

Args = tuple[str, ...]

BORROWED = ("--transfer-from", "1,2", "--config", "settings.toml")
GRASPS = ("--binding", "grasp", "--binding", "grasp:grasp_point=7")
WRITERS: tuple[Args, ...] = (
    ("learn", "--tool", "TOOL", "--behaviors", "SOME", "--seed", "SEED"),
    ("learn", "--tool", "TOOL", "--seed", "SEED", "--config", "settings.toml"),
    ("learn", "--resume"),
    ("learn", "--tool", "fork", "--minutes", "0", *BORROWED, "--seed", "SEED"),
    ("learn", "--tool", "fork", "--behaviors", "SOME", *BORROWED, "--seed", "SEED"),
    ("learn", "--tool", "TOOL", "--behaviors", "SOME", *GRASPS, "--seed", "SEED"),
    ("learn", "--tool", "TOOL", "--tool", "fork", "--minutes", "6", "--workers", "2"),
    ("invent", "--tool", "TOOL", "--minutes", "6", "--seed", "SEED"),
    ("solve", "--goal", "GOAL"),
    ("solve", "--goal", "GOAL", "--tool", "t-hook", "--start", "2"),
    ("solve", "--goal", "GOAL", "--run", "2", "--explain", "--json"),
    ("solve", "--goal", "GOAL", "--run", "14", "--planner", "lookahead"),
    ("break-tool", "--becomes", "TOOL"),
    ("verify", "--update"),
    ("verify", "--update", "--rows", "12", "--shape", "TOOL", "--seed", "SEED"),
    ("reproduce", "--seed", "SEED", "--robots", "2", "--workers", "1", "--config", "settings.toml"),
    ("reproduce", "--resume", "--workers", "1"),
    ("experiment", "two.toml", "--workers", "1"),
    ("import", "log.txt", "--map", "map.toml"),
    ("db", "merge", "other.db"),
    ("db", "backup", "--out", "copy.db", "--force"),
    ("db", "upgrade"),
)
"""What writes into a database, or a copy of it; `db upgrade` is given one of an older schema."""
NOT_THERE = {"compare", "figure compare", "figure plan"}
"""What needs two conditions of one seed, or a plan: the database under attack has none."""
MOST_READ = {"figure", "report", "replay"}
"""Half of what is drawn of all commands begins so: it reads most of a database."""
BY_WORD = {"--robots": ("1", "2"), "--workers": ("1",), "--speed": ("1000",)}

SYSTEM_CALLS = {
    "write": "pwrite64,write,ftruncate",
    "sync": "fdatasync,fsync",
    "read": "pread64,read",
    "open": "openat",
    "remove": "unlink,rename",
}
FAULTS = (
    *("kill", "kill at a call", "SIGINT", "SIGTERM", "EIO", "ENOSPC", "little room"),
    *("lock", "neighbour", "clock", "memory"),
)
DAY = 86_400
CLOCKS = (-56 * 365 * DAY, -365 * DAY, -DAY, -3600, 3600, DAY, 20 * 365 * DAY, 600 * 365 * DAY)


@dataclass(frozen=True, slots=True)
class Attack:
    """One command and what happens to it.

    Args:
        number: of the attack, counting from 1; with the seed it tells all the rest.
        args: of the command, but for its database.
        fault: one of `FAULTS`.
        moment: seconds after the command began.
        call: which kind of system call, and the how manieth of them.
        size: bytes of memory or room.
        clock: seconds by which the clock is wrong.
    """

    number: int
    args: Args
    fault: str
    moment: float
    call: tuple[str, int]
    size: int
    clock: int

    @property
    def command(self) -> str:
        """The name of the command."""
        return next(c.name for c in named() if self.args[: len(c.words)] == c.words)

    @property
    def writes(self) -> bool:
        """Whether it may write into its database."""
        return self.command in ALWAYS_WRITE or "--update" in self.args


@cache
def named() -> tuple[Command, ...]:
    """Return the commands that do something, those of two words first."""
    alone = [c for c in every_command() if c.words and c.name not in {"camera", "db", "figure"}]
    return tuple(sorted(alone, key=lambda command: -len(command.words)))


def drawn(seed: int, number: int) -> Attack:
    """Return an attack: the same for the same seed and number."""
    chance = np.random.default_rng([seed, number])
    # Half of them fall at random over a command, half in the moment it takes to open and to write.
    moment = float(chance.uniform(0.0, 1.0) if chance.random() < 0.5 else chance.exponential(0.1))
    call = (str(chance.choice(list(SYSTEM_CALLS))), int(np.ceil(np.exp(chance.uniform(0.0, 4.5)))))
    return Attack(
        number=number,
        args=_command(chance),
        fault=str(chance.choice(possible_faults())),
        moment=moment,
        call=call,
        size=int(np.exp(chance.uniform(np.log(1e4), np.log(1e7)))),
        clock=int(chance.choice(CLOCKS)),
    )


@cache
def possible_faults() -> tuple[str, ...]:
    """Return the faults that can be made here."""
    traced = {"kill at a call", "EIO", "ENOSPC"}
    return FAULTS if shutil.which("strace") else tuple(f for f in FAULTS if f not in traced)


def _command(chance: np.random.Generator) -> Args:
    """Draw a command: most of them write."""
    if chance.random() < 0.6:
        line = WRITERS[chance.integers(len(WRITERS))]
        words = {
            "TOOL": str(chance.choice(TOOLS)),
            "GOAL": str(chance.integers(1, 5)),
            "SEED": str(chance.integers(3)),
            "SOME": str(chance.integers(20, 1200)),
        }
        return tuple(words.get(word, word) for word in line)
    listed = [c for c in named() if has_database(c)]
    if chance.random() < 0.5:
        listed = [c for c in listed if c.words[0] in MOST_READ]
    return called(listed[chance.integers(len(listed))], chance)


NEED: dict[str, Args] = {
    "learn": ("--tool", "stick", "--behaviors", "20"),
    "invent": ("--tool", "stick", "--minutes", "6"),
    "solve": ("--goal", "1"),
    "reproduce": ("--robots", "1", "--workers", "1"),
    "db backup": ("--out", "copy.db", "--force"),
    "sql": ("select count(*) from affordance_table",),
    "replay": ("--run", "2"),
    "table show": ("1",),
    "table list": ("--all-runs",),
    "table export": ("--what", "steps", "--out", "new.csv", "--force"),
    "predict": ("--pushes", "3"),
    "verify": ("--rows", "3"),
    "camera view": ("--trial", "1", "--step", "1", "--out", "new.png", "--force"),
    "runs show": ("1",),
    "power": ("--session", "3"),
    "figure curve": ("--session", "3", "--out", "new.svg", "--force"),
    "runs note": ("1", "seen"),
    "runs delete": ("2", "--yes"),
    "experiment": ("two.toml", "--workers", "1"),
    "import": ("log.txt", "--map", "map.toml"),
    "which": ("nearer",),
    "figure row": ("1", "--out", "new.svg", "--force"),
    "figure plan": ("1", "1", "--out", "new.svg", "--force"),
    "figure transfer": ("--run", "14", "--out", "new.svg", "--force"),
    "figure trial": ("1", "--out", "new.svg", "--force"),
    "figure prediction": ("--pushes", "3", "--out", "new.svg", "--force"),
}
"""What a command must be told, or should be to do much; else where its figure goes."""


def plainly(command: Command) -> Args:
    """Return a call of a command with which it does what it is for."""
    out = ("--out", "new.svg", "--force") if "--out" in command.needed else ()
    return (*command.words, *NEED.get(command.name, out))


def in_database(args: Args, name: str) -> Args:
    """Return a command with the database it works in."""
    return (*args, "--into" if args[:2] == ("db", "merge") else "--db", name)


def has_database(command: Command) -> bool:
    """Tell whether a command is given a database."""
    return any(option == "--db" for option, _ in command.options)


def called(command: Command, chance: np.random.Generator) -> Args:
    """Draw plausible arguments for a command."""

    def value(option: str, word: str) -> str:
        fitting = BY_WORD.get(option) or FITTING.get(option) or PLAUSIBLE.get(word, ("1",))
        return fitting[chance.integers(len(fitting))]

    options = [option for option in command.own_options if option[0] in command.needed]
    others = [option for option in command.own_options if option not in options]
    options += [others[at] for at in chance.permutation(len(others))[: chance.integers(0, 3)]]
    given = [value("", word) for word in command.arguments]
    usual = USUAL.get(command.name, ())
    names = {name for name, _ in options}
    args = [*command.words, *given, *(usual if not names & set(usual) else ())]
    for option, word in options:
        args += [option, value(option, word)]
    if "--gif" in args and "--steps" not in args:
        args += ["--steps", "1"]  # a film of all takes long
    return (*args, *(("--force",) if "--force" in command.flags else ()))


SIGNALS = {"kill": signal.SIGKILL, "SIGINT": signal.SIGINT, "SIGTERM": signal.SIGTERM}
