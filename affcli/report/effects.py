"""Which tool moves the attractor where, and how often."""

from collections.abc import Sequence
from typing import Any

from affcli.analysis.statistics import exact_interval
from affcli.core.effects import Effect, Way
from affcli.core.records import LearningRunInfo
from affcli.report.sheet import Sheet
from affcli.report.words import call_words

Effects = Sequence[tuple[LearningRunInfo, Effect]]


def effects_table(effects: Effects, way: Way, inches: float) -> Sheet:
    """Return how often each behavior with each tool moved the attractor so far, the best first."""
    table = Sheet(
        ("run", "tool", "behavior", "tried", "did", "share", "rows", "alive"),
        title=f"What brings the attractor {way} by more than {inches:.3g} in",
        caption="did: of those tried; share: with its 95 % interval; rows: moved it at all; alive: "
        "of the rows, with a replication probability over 1/2",
        left=("tool", "behavior"),
    )
    for run, one in effects:
        low, high = exact_interval(one.moved, one.tried)
        table.add(
            *(str(run.id), run.spec.tool, call_words(one.call), str(one.tried), str(one.moved)),
            f"{one.moved / one.tried:.2f} ({low:.2f} to {high:.2f})",
            *(str(one.rows), str(one.alive)),
        )
    return table


def effects_json(effects: Effects, way: Way, inches: float) -> list[dict[str, Any]]:
    """Return what `effects_table` shows as JSON types."""
    return [
        {
            "run": run.id,
            "tool": run.spec.tool,
            "behavior": one.call.name,
            "params": dict(one.call.params),
            "way": way.value,
            "inches": inches,
            "tried": one.tried,
            "moved": one.moved,
            "share_95": list(exact_interval(one.moved, one.tried)),
            "rows": one.rows,
            "alive": one.alive,
        }
        for run, one in effects
    ]


def best_words(effects: Effects, way: Way) -> str:
    """Return the answer in a line: the tool and behavior that did it the most often."""
    run, best = effects[0]
    if not best.moved:
        return f"none brought it {way} so far"
    return (
        f"most often {way}: the {run.spec.tool}, {call_words(best.call)}: "
        f"{best.moved} of {best.tried}"
    )
