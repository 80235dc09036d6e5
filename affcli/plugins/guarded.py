"""A world of another package, in this process: what it raises is said with its name.

A world is an engine with all that stands on it: robot, sensor and experimenter are called thousands
of times in a trial, too often for a pipe. So one that ends the process, or goes on for ever, is not
kept apart.
"""

from typing import Any

from affcli.errors import AffcliError, PartFailedError
from affcli.plugins.entry_points import Offer
from affcli.plugins.host import loaded, words_of

OPENED = frozenset({"learning", "trial", "verification"})
"""What gives a setting of a world."""
PORTS = frozenset({"robot", "sensor", "experimenter"})
"""What of a setting procedures meet."""


class Guarded:
    """Something of a world, whose errors are told as those of its package.

    Args:
        behind: the thing itself.
        offer: the part that it is of.
    """

    def __init__(self, behind: Any, offer: Offer) -> None:
        self._behind, self._offer = behind, offer

    def __getattr__(self, name: str) -> Any:
        """Return an attribute; of what is called, the answer is looked after as well."""
        if name.startswith("__"):
            raise AttributeError(name)
        try:
            found = getattr(self._behind, name)
        except AttributeError:
            raise
        except Exception as error:
            raise _failure(self._offer, error) from error
        if name in PORTS:
            return Guarded(found, self._offer)
        return _guarded_call(found, name, self._offer) if callable(found) else found


def _guarded_call(function: Any, name: str, offer: Offer) -> Any:
    def call(*args: Any, **named: Any) -> Any:
        try:
            answer = function(*args, **named)
        except (AffcliError, ValueError, LookupError, TypeError) as error:
            # The contract has these: a state that is not its own, tasks that it does not have.
            if isinstance(error, AffcliError) or name in ("restore", "tasks", "observe_goal"):
                raise
            raise _failure(offer, error) from error
        except Exception as error:
            raise _failure(offer, error) from error
        return Guarded(answer, offer) if name in OPENED else answer

    return call


def guarded_world(offer: Offer, /, *args: Any, **values: Any) -> Guarded:
    """Return a world of another package; PartFailedError when it cannot be made, or is another than
    its part says.
    """
    try:
        part = loaded(offer)
        made = part.build(*args, **values)
        own = (made.name, made.version)
    except Exception as error:
        raise _failure(offer, error) from error
    if own != (part.name, part.version):
        raise offer.refused(f"it is {own}, its part {(part.name, part.version)}; let them agree")
    return Guarded(made, offer)


def _failure(offer: Offer, error: Exception) -> PartFailedError:
    return offer.refused(words_of(error))
