"""What a robot invented: behaviors that nobody wrote, with the tries that speak for and against."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from affcli.core.behavior import ExploratoryBehavior, Repertoire


@dataclass(frozen=True, slots=True)
class Invention:
    """A behavior that a robot composed, found to do something new, and tried again.

    Args:
        behavior: the behavior, called by what it does.
        step: the behavior of the learning run in which it did that first.
        gain: in how many more cells of place and direction of movement the attractor could be moved
            with it than with what the robot could do before.
        tries: the behaviors of the run in which it was tried again, each with whether the attractor
            moved alike: whether it speaks for the invention.
        kept: enough of them do.
    """

    behavior: ExploratoryBehavior
    step: int
    gain: int
    tries: tuple[tuple[int, bool], ...]
    kept: bool

    @property
    def speak_for(self) -> int:
        """How many tries speak for it."""
        return sum(good for _, good in self.tries)

    @property
    def speak_against(self) -> int:
        """How many tries speak against it."""
        return len(self.tries) - self.speak_for


@runtime_checkable
class Inventor(Protocol):
    """An explorer that invents, a capability that it may lack."""

    def inventions(self) -> tuple[Invention, ...]:
        """Return what it tried again, kept or not, in the order in which it did."""


def kept_of(inventions: Iterable[Invention]) -> Repertoire:
    """Return the behaviors that were kept, by value."""
    return tuple(one.behavior for one in inventions if one.kept)
