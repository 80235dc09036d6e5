"""What a robot found when it tested its own table: tables and JSON (§3.1, §8)."""

from collections.abc import Sequence
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from affcli.analysis.verification import JudgedTry, Share, Verification, shares
from affcli.core.results import VerificationResult
from affcli.core.verification import Evidence, Verdict, decided_after
from affcli.report.sheet import Sheet
from affcli.report.words import call_words, clock, many, movement_cell

MOST_ROWS = 20
"""So many rows that drifted are shown; the JSON has all."""

STYLE = {Verdict.HOLDS: "green", Verdict.CHANGED: "red", Verdict.UNDECIDED: "yellow"}


def verification_tables(found: Verification) -> tuple[RenderableType, ...]:
    """Return the verdict, the shares by behavior and by region, and the rows that drifted."""
    live = found.of_live_rows
    tables: list[RenderableType] = [_verdict(found)]
    if live:
        tables += [
            _shares_table(
                "behavior", "By behavior", shares(live, lambda one: call_words(one.call))
            ),
            _shares_table(
                "region",
                f"By region of the {found.spec.tool}",
                shares(live, lambda one: one.region),
                "region: the part nearest the attractor when the behavior began",
            ),
        ]
    if found.drifted:
        tables.append(_drifted_table(found.drifted))
    return tuple(tables)


def verdict_words(verdict: str, tried: Evidence, borrowed: Evidence) -> str:
    """Return a verdict in words: of a table with borrowed rows it may be these that do not hold.

    A borrowed row may never have held for the tool: that it fails does not tell that the tool is
    another than it was. Where the robot's own rows alone tell that it is, it is said as ever.

    Args:
        verdict: of all tries.
        tried: what all tries say.
        borrowed: what those of borrowed rows say.
    """
    own = Evidence(tried.tries - borrowed.tries, tried.failures - borrowed.failures)
    if verdict != Verdict.CHANGED or not borrowed.failures or own.verdict is Verdict.CHANGED:
        return verdict
    but = "borrowed rows do not hold"
    return but if own.verdict is Verdict.HOLDS else f"{verdict}, or {but}"


def _verdict(found: Verification) -> Text:
    """Return in words what was tried, and what follows."""
    spec, records, borrowed = found.spec, found.records, found.borrowed
    evidence = Evidence.of(records)
    head = Text(f"Run {found.run_id}, {spec.tool}: ")
    words = verdict_words(evidence.verdict.value, evidence, borrowed)
    head.append(words, style=STYLE[evidence.verdict])
    first, tried = decided_after(records), many(evidence.tries, "try")
    if not evidence.tries:
        head.append(": no row that was tried is live")
    elif first is None:
        head.append(f": {tried} were too few ({evidence.failures} failed)")
    else:
        head.append(f": {evidence.failures} of {tried} failed, told after try {first}")
    lines = [head]
    if borrowed.tries:
        own = f"{evidence.failures - borrowed.failures} of {evidence.tries - borrowed.tries}"
        of_borrowed = f"{borrowed.failures} of {many(borrowed.tries, 'try')}"
        lines.append(Text(f"of borrowed rows {of_borrowed} failed, of its own rows {own}"))
    excluded = found.of_excluded_rows
    if excluded:
        again = sum(one.record.replicated for one in excluded)
        more = many(len(excluded), "more try")
        what = f"of rows that were excluded before: {again} replicated, {found.came_back} came back"
        lines.append(Text(f"{more} {what}"))
    seconds = records[-1].clock if records else 0.0
    kept = "stored counters updated" if found.updated else "stored table left as it is"
    lines.append(
        Text(f"{clock(seconds)} of robot time; seen through: {spec.sensor}; {kept}", style="dim")
    )
    return Text("\n").join(lines)


def _shares_table(heading: str, title: str, found: Sequence[Share], more: str = "") -> Sheet:
    """Return the observed replication probabilities of some groups."""
    caption = "share that replicated, with its 95 % interval (exact)"
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


def _drifted_table(drifted: Sequence[JudgedTry]) -> Sheet:
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
            call_words(one.call),
            one.region,
            movement_cell(record.expected),
            movement_cell(record.seen) if record.execution else record.placing.status.value,
            f"{record.times_successful_after}/{record.times_used_after}",
        )
    return table


def verifications_table(found: Sequence[VerificationResult]) -> Sheet:
    """Return what stored verifications found, one row each."""
    words = ("table of", "held", "sensor", "verdict")
    table = Sheet(
        ("run", *words[:3], "tries", "failed", "verdict", "told after", "robot time"),
        title="The table tested by the robot itself (affcli verify --update)",
        caption="held: what the tool truly was; tries: of rows that were not excluded; failed: not "
        "as expected; told after: so many tries",
        left=words,
    )
    for one in found:
        seconds, after = one.robot_seconds, one.decided_after
        table.add(
            *(str(one.run_id), one.tool, one.shape, one.sensor, str(one.live), str(one.failed)),
            _stored_verdict(one),
            "-" if after is None else str(after),
            "-" if seconds is None else clock(seconds),
        )
    return table


def _stored_verdict(one: VerificationResult) -> str:
    """Return the verdict of a stored verification in words."""
    if one.verdict is None:
        return "interrupted"
    tried = Evidence(one.live, one.failed)
    return verdict_words(one.verdict, tried, Evidence(one.borrowed, one.borrowed_failed))


def found_words(one: VerificationResult) -> str:
    """Return what a stored verification found: its verdict, and how many tries failed."""
    return f"{_stored_verdict(one)} ({one.failed} of {one.live} tries failed)"


def verification_json(found: Verification) -> dict[str, Any]:
    """Return what `verification_tables` shows as JSON types, with all rows that drifted."""
    spec, records, excluded = found.spec, found.records, found.of_excluded_rows
    borrowed = found.borrowed
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
        "of_borrowed_rows": {"tries": borrowed.tries, "failed": borrowed.failures},
        "of_excluded_rows": {
            "tries": len(excluded),
            "replicated": sum(one.record.replicated for one in excluded),
            "came_back": found.came_back,
        },
        "by_behavior": [
            one._asdict() for one in shares(found.of_live_rows, lambda one: str(one.call))
        ],
        "by_region": [one._asdict() for one in shares(found.of_live_rows, lambda one: one.region)],
        "drifted": [
            {
                "row": one.affordance_id,
                "step": one.record.row.step,
                "behavior": str(one.call),
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
