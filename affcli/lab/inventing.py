"""Inventing behaviors with a tool, and taking what a run invented into a repertoire (§7.1, §8)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from affcli import registry
from affcli.core.behavior import ExploratoryBehavior, Repertoire
from affcli.core.identity import Component, shown
from affcli.core.invention import kept_of
from affcli.core.limits import LARGEST_SEED
from affcli.core.specs import LearningSpec
from affcli.errors import BadInputError, UsageError, one_line
from affcli.lab.run_parts import RunParts
from affcli.store import Store, open_store

EXPLORER = "inventing"
INVENTED = "invented"
"""What names the behaviors that a run invented: ``invented:run=12``."""
BABBLING, COMPOSING = 1.0 / 2.0, 1.0 / 3.0
"""Shares of the time in which the robot babbles and composes; in the rest it tries again."""
LEAST_MINUTES = 6.0
"""With fewer there is no time to try anything again."""


def explorer(minutes: float) -> str:
    """Return the explorer that invents in so many minutes, as text.

    Raises:
        BadInputError: they are too few.
    """
    if minutes < LEAST_MINUTES:
        raise BadInputError(
            f"--minutes {minutes:g}: too few to invent anything; give {LEAST_MINUTES:g} or more, "
            "60 for what a tool can do"
        )
    babbling, composing = (round(minutes * share, 2) for share in (BABBLING, COMPOSING))
    return f"{EXPLORER}:babbling={babbling!r},composing={composing!r}"


@dataclass(frozen=True, slots=True)
class Inventing:
    """That the robots of a condition invent behaviors, each for itself, before they learn.

    Args:
        tool: with which tool, by its name.
        minutes: for how long.
    """

    tool: str
    minutes: float

    @classmethod
    def parse(cls, text: str) -> "Inventing":
        """Return what ``invented:tool=stick,minutes=60`` stands for.

        Raises:
            UsageError: there is no such tool.
            BadInputError: a text of another form, or too few minutes.
        """
        said = dict(Component.parse(text).params)
        tool, minutes = said.pop("tool", None), said.pop("minutes", 60.0)
        if said or not isinstance(tool, str) or isinstance(minutes, str):
            raise BadInputError(
                f"{one_line(text, 60)}: each robot invents for itself; say with which tool and how "
                f"long: {INVENTED}:tool=stick,minutes=60"
            )
        explorer(minutes)
        return cls(registry.part("tools", tool).name, float(minutes))

    def __str__(self) -> str:
        """Write it as `parse` reads it."""
        return f"{INVENTED}:tool={self.tool},minutes={shown(self.minutes)}"

    def spec(self, parts: RunParts, seed: int, robot: int) -> LearningSpec:
        """Return the learning run in which a robot with these parts invents: with the first of its
        grasps.
        """
        way = registry.component("explorers", explorer(self.minutes))
        own = replace(parts, explorer=way, other_bindings=())
        return own.spec(self.tool, seed, robot, self.minutes / 60.0)


def are_invented(text: str) -> bool:
    """Tell whether a text names what a run invented, and no part."""
    return text.partition(":")[0] == INVENTED


def repertoire_of(texts: Sequence[str] | None, database: Path) -> list[str | ExploratoryBehavior]:
    """Return what a repertoire is to be made of: what runs of a database invented is by value.

    Raises:
        UsageError, BadInputError: as `with_inventions`.
        DatabaseError: the database is needed, and cannot be read.
    """
    given = list(texts or ())
    if not any(map(are_invented, given)):
        return [*given]
    with open_store(database, create=False, write=False) as store:
        return with_inventions(store, given)


def with_inventions(store: Store, texts: Sequence[str]) -> list[str | ExploratoryBehavior]:
    """Return a repertoire's texts with what runs invented by value.

    Raises:
        UsageError: a run is not there any more, is not finished, or invented nothing; the message
            says what to do.
        BadInputError: a text of another form.
    """
    found: list[str | ExploratoryBehavior] = []
    for text in texts:
        found += _invented(store, text) if are_invented(text) else [text]
    return found


def _invented(store: Store, text: str) -> Repertoire:
    """Return the behaviors that a text names, by value."""
    shown = f"--repertoire {one_line(text, 60)}"
    named = dict(Component.parse(text).params)
    number = named.pop("run", None)
    if named or not isinstance(number, int) or not 1 <= number <= LARGEST_SEED:
        raise BadInputError(f"{shown}: name the run that invented them: {INVENTED}:run=ID")
    anew = "invent anew: affcli invent --tool stick"
    try:
        run = store.learning.run(number)
    except UsageError as error:
        raise UsageError(f"{shown}: {error}; {anew}") from error
    anew = f"invent anew: affcli invent --tool {one_line(run.spec.tool, 40)}"
    if run.spec.explorer.name != EXPLORER:
        way = run.spec.explorer
        raise UsageError(f"{shown}: run {number} explored by {way}, it did not invent; {anew}")
    if run.status != "done":
        raise UsageError(f"{shown}: run {number} is not finished; go on: affcli learn --resume")
    kept = kept_of(store.inventions.of_run(number))
    if not kept:
        raise UsageError(f"{shown}: run {number} invented nothing; {anew} --minutes 60")
    return kept
