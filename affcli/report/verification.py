"""What a robot found when it tested its own table (§3.1, §8)."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from rich.console import RenderableType
from rich.text import Text

from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import direction_degrees
from affcli.core.observation import Movement
from affcli.core.verification import (
    Evidence,
    ReplicationRecord,
    Verdict,
    VerificationSpec,
    decided_after,
)
from affcli.report.learning import clock, whole_degrees
from affcli.report.sheet import Sheet
from affcli.report.statistics import wilson

MOST_ROWS = 20
"""So many rows that drifted are shown; the JSON has all."""

STYLE = {Verdict.HOLDS: "green", Verdict.CHANGED: "red", Verdict.UNDECIDED: "yellow"}


class Checked(NamedTuple):
    """One try with what the robot does not know.

    Args:
        record: what the robot did and saw.
        affordance_id: the row in the store.
        region: the part of the tool, as it was learned, nearest the attractor at O^s.
    """

    record: ReplicationRecord
    affordance_id: int
    region: str


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
    tries: tuple[Checked, ...]

    @property
    def records(self) -> list[ReplicationRecord]:
        """What the robot did and saw."""
        return [one.record for one in self.tries]

    @property
    def of_live_rows(self) -> list[Checked]:
        """The tries of rows that a robot with a task would use."""
        return [one for one in self.tries if one.record.live]

    @property
    def of_excluded_rows(self) -> list[Checked]:
        """The tries of rows that were excluded before."""
        return [one for one in self.tries if not one.record.live]

    @property
    def drifted(self) -> list[Checked]:
        """The last failure of each live row that failed, by region and behavior."""
        failed = {one.affordance_id: one for one in self.of_live_rows if not one.record.replicated}
        return sorted(
            failed.values(), key=lambda one: (one.region, _behavior(one), one.record.number)
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


def shares(tries: Iterable[Checked], what: Callable[[Checked], str]) -> list[Share]:
    """Return how often tries replicated, with the 95 % interval, by what they have in common."""
    groups: dict[str, list[bool]] = {}
    for one in tries:
        groups.setdefault(what(one), []).append(one.record.replicated)
    return [
        Share(name, len(seen), sum(seen), *wilson(sum(seen), len(seen)))
        for name, seen in sorted(groups.items())
    ]


def verification_tables(found: Verification) -> tuple[RenderableType, ...]:
    """Return the verdict, the shares by behavior and by region, and the rows that drifted."""
    live = found.of_live_rows
    tables: list[RenderableType] = [_verdict(found)]
    if live:
        tables += [
            _shares_table("behavior", "By behavior", shares(live, _behavior)),
            _shares_table(
                "region",
                f"By region of the {found.spec.tool}",
                shares(live, _region),
                "region: the part nearest the attractor when the behavior began",
            ),
        ]
    if found.drifted:
        tables.append(_drifted_table(found.drifted))
    return tuple(tables)


def _behavior(one: Checked) -> str:
    """Return the behavior of a try with its parameter."""
    return str(one.record.row.exploratory)


def _region(one: Checked) -> str:
    """Return the region of a try."""
    return one.region


def _verdict(found: Verification) -> Text:
    """Return in words what was tried, and what follows."""
    spec, records = found.spec, found.records
    evidence = Evidence.of(records)
    head = Text(f"Run {found.run_id}, {spec.tool}: ")
    head.append(evidence.verdict.value, style=STYLE[evidence.verdict])
    first, tried = decided_after(records), _many(evidence.tries, "try", "tries")
    if not evidence.tries:
        head.append(": no row that was tried is live")
    elif first is None:
        head.append(f": {tried} were too few ({evidence.failures} failed)")
    else:
        head.append(f": {evidence.failures} of {tried} failed, told after try {first}")
    lines = [head]
    excluded = found.of_excluded_rows
    if excluded:
        again = sum(one.record.replicated for one in excluded)
        more = _many(len(excluded), "more try", "more tries")
        what = f"of rows that were excluded before: {again} replicated, {found.came_back} came back"
        lines.append(Text(f"{more} {what}"))
    seconds = records[-1].clock if records else 0.0
    kept = "stored counters updated" if found.updated else "stored table left as it is"
    lines.append(
        Text(f"{clock(seconds)} of robot time; seen through: {spec.sensor}; {kept}", style="dim")
    )
    return Text("\n").join(lines)


def _many(count: int, one: str, more: str) -> str:
    """Return a count with its noun."""
    return f"{count} {one if count == 1 else more}"


def _shares_table(heading: str, title: str, found: Sequence[Share], more: str = "") -> Sheet:
    """Return the observed replication probabilities of some groups."""
    caption = "share that replicated, with its 95 % interval (Wilson)"
    table = Sheet(
        (heading, "tries", "replicated", "share", "95 % interval"),
        title=title,
        caption=f"{caption}; {more}" if more else caption,
        left=(heading,),
    )
    for one in found:
        share = f"{one.replicated / one.tries:.2f}"
        table.add(
            one.what,
            str(one.tries),
            str(one.replicated),
            share,
            f"{one.low:.2f} to {one.high:.2f}",
        )
    return table


def _drifted_table(drifted: Sequence[Checked]) -> Sheet:
    """Return the rows that failed, the first of them when they are many."""
    more = len(drifted) - MOST_ROWS
    caption = "row: its id; inches at degrees; counters: successful/used"
    if more > 0:
        caption += f"; {more} more, all in --json"
    table = Sheet(
        ("row", "behavior", "region", "expected", "seen", "counters"),
        title=f"Rows that drifted: {len(drifted)}",
        caption=caption,
        left=("behavior", "region"),
    )
    for one in drifted[:MOST_ROWS]:
        record = one.record
        table.add(
            str(one.affordance_id),
            _behavior(one),
            one.region,
            _movement(record.expected),
            _movement(record.seen) if record.execution else record.placing.status.value,
            f"{record.times_successful_after}/{record.times_used_after}",
        )
    return table


def _movement(movement: Movement) -> str:
    """Return a movement as length and direction, none when T does not detect it."""
    if movement.distance <= MOVEMENT_THRESHOLD:
        return "none"
    direction = whole_degrees(direction_degrees(movement.dx, movement.dy))
    return f"{movement.distance:.1f} at {direction}"


def verification_json(found: Verification) -> dict[str, Any]:
    """Return what `verification_tables` shows as JSON types, with all rows that drifted."""
    spec, records, excluded = found.spec, found.records, found.of_excluded_rows
    evidence = Evidence.of(records)
    return {
        "run": found.run_id,
        "tool": spec.tool,
        "shape": spec.shape,
        "sensor": spec.sensor,
        "seed": spec.seed,
        "rows": found.rows,
        "updated": found.updated,
        "tries": len(records),
        "robot_seconds": records[-1].clock if records else 0.0,
        "verdict": evidence.verdict.value,
        "decided_after": decided_after(records),
        "log_likelihood_ratio": evidence.log_ratio,
        "of_live_rows": {"tries": evidence.tries, "failed": evidence.failures},
        "of_excluded_rows": {
            "tries": len(excluded),
            "replicated": sum(one.record.replicated for one in excluded),
            "came_back": found.came_back,
        },
        "by_behavior": [one._asdict() for one in shares(found.of_live_rows, _behavior)],
        "by_region": [one._asdict() for one in shares(found.of_live_rows, _region)],
        "drifted": [
            {
                "affordance": one.affordance_id,
                "row": one.record.row.step,
                "behavior": _behavior(one),
                "region": one.region,
                "placing": one.record.placing.status.value,
                "expected": [one.record.expected.dx, one.record.expected.dy],
                "seen": [one.record.seen.dx, one.record.seen.dy],
                "times_successful": one.record.times_successful_after,
                "times_used": one.record.times_used_after,
            }
            for one in found.drifted
        ],
    }
