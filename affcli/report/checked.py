"""What a person's file or part is, as a table and as JSON types (``affcli check``)."""

from collections.abc import Mapping, Sequence
from typing import Any

from affcli.report.sheet import Sheet


def checked_table(kind: str, name: str, facts: Mapping[str, str]) -> Sheet:
    """Return what a file says: a fact a line."""
    table = Sheet((kind, name), left=(kind, name))
    for what, said in facts.items():
        table.add(what, said)
    return table


def checked_json(kind: str, name: str, facts: Mapping[str, str]) -> dict[str, Any]:
    """Return the same as JSON types."""
    return {"kind": kind, "name": name, "facts": dict(facts)}


Tests = Sequence[tuple[str, str, str]]
"""Tests of a part: which, ``passed``, ``failed`` or ``skipped``, and why it failed."""


def part_table(kind: str, part: str, tests: Tests) -> Sheet:
    """Return what came of the tests of a part: how many passed, and a line for each that did not,
    however often it was run.

    Args:
        kind: what the part is one of: ``planner``.
        part: its name, with parameters and package.
        tests: in the order in which they were run.
    """
    counts = {word: sum(what == word for _, what, _ in tests) for word in ("passed", "failed")}
    table = Sheet(
        (kind, part),
        left=(kind, part),
        caption=f"{counts['passed']} of {len(tests)} tests passed, {counts['failed']} failed",
    )
    failed: dict[str, list[str]] = {}
    for test, what, why in tests:
        if what == "failed":
            failed.setdefault(test.partition("[")[0], []).append(why)
    for test, all_of_it in failed.items():
        times = f"{len(all_of_it)} times: " if len(all_of_it) > 1 else ""
        table.add(test, times + all_of_it[0])
    if not counts["failed"]:
        table.add("its contract", "kept")
    return table


def part_json(kind: str, part: str, tests: Tests) -> dict[str, Any]:
    """Return the same as JSON types."""
    named = [{"test": test, "outcome": what, "why": why or None} for test, what, why in tests]
    return {"kind": kind, "part": part, "tests": named}
