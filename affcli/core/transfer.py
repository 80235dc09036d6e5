"""Carrying over to a new tool: what a run borrows from, how, and where each row comes from (§8).

A borrowed row is a row of its run like any other. Its step is 0 or less: the robot has not made it
by any of its own behaviors, which are counted from 1.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any

from affcli.core.affordance import Affordance
from affcli.core.geometry import Point, Pose
from affcli.core.identity import shown
from affcli.core.setting import Value, setting, settings_of
from affcli.errors import BadInputError, one_line

LOCAL, WHOLE = "local", "whole"
"""The ways to borrow: rows whose surroundings look alike; all rows of the most similar tool."""
MOST_LENDERS = 50
"""Of one run."""


@dataclass(frozen=True, slots=True)
class Borrowing:
    """How rows are borrowed.

    Choice: the numbers are those of the prototype that came before this, chosen on seeds 100 to
    199.
    """

    way: str = setting(
        LOCAL,
        "",
        "local: rows whose surroundings look alike; whole: all rows of the most similar tool.",
        choices=(LOCAL, WHOLE),
    )
    radius: float = setting(
        2.1,
        "in",
        "So far about the attractor's way the masks are held against each other: its radius, and "
        "some.",
        high=20.0,
    )
    limit: float = setting(0.3, "in^2", "There they may differ by so much.", low=0.0, high=100.0)
    each: int = setting(60, "", "So many rows are drawn from each lender.", high=10_000)
    most: int = setting(150, "", "So many of what carries over are kept.", high=10_000)
    shifts: int = setting(
        2, "", "At so many other places one row is borrowed, at most.", low=0, high=100
    )
    grown: float = setting(
        0.0,
        "in",
        "The mask of the new tool is made so much larger: what a mask that is wrong costs.",
        low=0.0,
        high=5.0,
    )

    @classmethod
    def of(cls, given: Mapping[str, Value], place: str) -> "Borrowing":
        """Return it with some numbers as they were given.

        Args:
            given: by name.
            place: where they were given, for the message.

        Raises:
            BadInputError: an unknown name, or a value out of its limits.
        """
        known = settings_of(cls)
        for name in given:
            if name not in known:
                raise BadInputError(
                    f"{place}: no parameter {one_line(name, 40)}; it has {', '.join(known)}"
                )
        checked = {k: known[k].checked(v, f"{place}: {k}") for k, v in given.items()}
        return cls(**checked)  # type: ignore[arg-type]

    @classmethod
    def first(cls) -> "Borrowing":
        """Return the defaults number 1, which stored ones differ from: see `CHANGED`."""
        return cls(**{name: former[0] for name, former in CHANGED.items()})  # type: ignore[arg-type]

    def differing(self, usual: "Borrowing") -> dict[str, Value]:
        """Return in what it differs from another, by name."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return {k: v for k, v in values.items() if v != getattr(usual, k)}

    def __str__(self) -> str:
        """Write what is not the default, as it is given."""
        differing = self.differing(Borrowing())
        return ",".join(f"{name}={shown(value)}" for name, value in differing.items())


CHANGED: dict[str, tuple[Value, ...]] = {}
"""Former defaults of `Borrowing`, by name, oldest first: whoever changes one notes it here, and
what was stored before means what it meant."""


@dataclass(frozen=True, slots=True)
class Transfer:
    """What a run borrows from, and how: a part of what it is a function of.

    Args:
        lenders: the keys of learning runs, in ascending order: whose rows are borrowed.
        borrowing: how.
    """

    lenders: tuple[str, ...]
    borrowing: Borrowing

    def canonical(self) -> dict[str, Any]:
        """Return it as JSON types."""
        return {
            "lenders": list(self.lenders),
            "borrowing": self.borrowing.differing(Borrowing.first()),
        }

    def __str__(self) -> str:
        """Write from how many runs it is, and what of the way is not the default."""
        runs = f"{len(self.lenders)} run{'s' * (len(self.lenders) > 1)}"
        return ":".join(filter(None, (runs, str(self.borrowing))))

    @classmethod
    def from_canonical(cls, value: Any) -> "Transfer":
        """Return what `canonical` gave; ValueError, KeyError, TypeError or BadInputError if not."""
        lenders = tuple(map(str, value["lenders"]))
        if not lenders or list(lenders) != sorted(set(lenders)):
            raise ValueError("lenders in another order")
        given = Borrowing.first().differing(Borrowing()) | dict(value["borrowing"])
        return cls(lenders, Borrowing.of(given, "transfer"))


def borrowed_starts(rows: Iterable[Affordance]) -> dict[int, tuple[Pose, Pose]]:
    """Return where wrist and attractor were when borrowed rows were made, by step: where they say,
    for nobody made them with this tool (in, rad).
    """
    return {row.step: row.as_placed for row in rows if row.is_borrowed}


@dataclass(frozen=True, slots=True)
class Borrowed:
    """A borrowed row and where it comes from.

    Args:
        row: as a row of the new tool, with the counters of one that was made just now.
        lender: the key of the learning run that made it.
        tool: the name of the tool that it was made with.
        step: the behavior of that run which made it.
        shift: by how much the attractor stands elsewhere to the new tool (in, tool frame), after
            mirroring.
        mirrored: whether left and right are exchanged.
    """

    row: Affordance
    lender: str
    tool: str
    step: int
    shift: Point
    mirrored: bool
