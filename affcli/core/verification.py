"""Testing the robot's own table: does what it learned still hold (§3.1, §8)?"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from affcli.core.trial import Attempt

INTACT, CHANGED = 0.02, 0.10
"""Shares of tries that fail: what is told apart. Choice: with an intact tool 0.5 to 0.9 % fail, and
less than 3 % with 97.5 % of robots, whichever of the five tools it is; and a tenth of what was
learned is worth telling. Settled for all at once, on 100 robots a tool of seed 100
(``experiments/verification``)."""

ERROR = 0.01
"""How often each of the two is taken for the other, at most, where tries fail independently.
Choice: a fifth of the 5 % allowed, for some robots' rows fail more often than others'."""

BOUND = math.log((1.0 - ERROR) / ERROR)
"""Wald's bounds on the logarithm of the likelihood ratio: a verdict lies beyond +-`BOUND`."""


class Verdict(StrEnum):
    """What a robot makes of its tries."""

    HOLDS = "table holds"
    CHANGED = "tool has changed"
    UNDECIDED = "undecided"
    """The tries were too few to tell."""


@dataclass(frozen=True, slots=True)
class ReplicationRecord(Attempt):
    """One try of a verification: a row was executed again and judged.

    Args:
        number: 1, 2, 3, ... within the verification.
        clock: robot seconds when the try ended.
    """

    number: int
    clock: float


@dataclass(frozen=True, slots=True)
class Evidence:
    """Wald's sequential probability ratio test (1945) on tries that failed.

    Only tries of live rows count: of a row that was excluded before nothing is expected. So a table
    that has adapted to a changed tool holds for it, and an excluded row no longer counts.

    Args:
        tries: of rows that were live.
        failures: how many of them did not replicate.
    """

    tries: int = 0
    failures: int = 0

    @classmethod
    def of(cls, attempts: Iterable[Attempt]) -> "Evidence":
        """Return the evidence of some tries."""
        evidence = cls()
        for one in attempts:
            evidence = evidence.after(one)
        return evidence

    def after(self, one: Attempt) -> "Evidence":
        """Return the evidence after one more try."""
        if not one.live:
            return self
        return Evidence(self.tries + 1, self.failures + int(not one.replicated))

    @property
    def log_ratio(self) -> float:
        """The logarithm of P(these tries | `CHANGED`) / P(these tries | `INTACT`)."""
        replicated = self.tries - self.failures
        return self.failures * math.log(CHANGED / INTACT) + replicated * math.log(
            (1.0 - CHANGED) / (1.0 - INTACT)
        )

    @property
    def verdict(self) -> Verdict:
        """What the tries say so far."""
        if self.log_ratio >= BOUND:
            return Verdict.CHANGED
        return Verdict.HOLDS if self.log_ratio <= -BOUND else Verdict.UNDECIDED


def decided_after(attempts: Iterable[Attempt]) -> int | None:
    """Return after how many tries their verdict could be told for the first time; None if never."""
    stages, evidence = [], Evidence()
    for one in attempts:
        evidence = evidence.after(one)
        stages.append(evidence.verdict)
    if evidence.verdict is Verdict.UNDECIDED:
        return None
    return stages.index(evidence.verdict) + 1
