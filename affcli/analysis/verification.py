"""What a robot found when it tested its own table (§3.1, §8)."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

from affcli.analysis.statistics import exact_interval
from affcli.core.behavior import BehaviorCall
from affcli.core.specs import VerificationSpec
from affcli.core.verification import Evidence, ReplicationRecord


class JudgedTry(NamedTuple):
    """One try with what the robot does not know.

    Args:
        record: what the robot did and saw.
        affordance_id: the row in the store.
        region: the part of the tool, as it was learned, nearest the attractor at O^s.
    """

    record: ReplicationRecord
    affordance_id: int
    region: str

    @property
    def call(self) -> BehaviorCall:
        """The behavior of the row with its parameters."""
        return self.record.row.exploratory


@dataclass(frozen=True, slots=True)
class Verification:
    """A verification that came to its end.

    Args:
        run_id: the learning run whose table was tested.
        spec: which verification.
        rows: how many rows the table has.
        updated: the stored counters were updated.
        tries: all tries, in order.
    """

    run_id: int
    spec: VerificationSpec
    rows: int
    updated: bool
    tries: tuple[JudgedTry, ...]

    @property
    def records(self) -> list[ReplicationRecord]:
        """What the robot did and saw."""
        return [one.record for one in self.tries]

    @property
    def of_live_rows(self) -> list[JudgedTry]:
        """The tries of rows that a robot with a task would use."""
        return [one for one in self.tries if one.record.live]

    @property
    def borrowed(self) -> Evidence:
        """What the tries of borrowed rows say, of those that a robot with a task would use."""
        return Evidence.of(one for one in self.records if one.row.is_borrowed)

    @property
    def of_excluded_rows(self) -> list[JudgedTry]:
        """The tries of rows that were excluded before."""
        return [one for one in self.tries if not one.record.live]

    @property
    def drifted(self) -> list[JudgedTry]:
        """The last failure of each live row that failed, by region and behavior."""
        failed = {one.affordance_id: one for one in self.of_live_rows if not one.record.replicated}
        return sorted(
            failed.values(), key=lambda one: (one.region, str(one.call), one.record.number)
        )

    @property
    def came_back(self) -> int:
        """How many tries took an excluded row's probability over 1/2 again."""
        return sum(not one.record.died for one in self.of_excluded_rows)


class Share(NamedTuple):
    """How often the rows of one behavior, or of one region of the tool, replicated."""

    what: str
    tries: int
    replicated: int
    low: float
    high: float


def shares(tries: Iterable[JudgedTry], what: Callable[[JudgedTry], str]) -> list[Share]:
    """Return how often tries replicated, with the 95 % interval, by what they have in common."""
    groups: dict[str, list[bool]] = {}
    for one in tries:
        groups.setdefault(what(one), []).append(one.record.replicated)
    return [
        Share(name, len(seen), sum(seen), *exact_interval(sum(seen), len(seen)))
        for name, seen in sorted(groups.items())
    ]
