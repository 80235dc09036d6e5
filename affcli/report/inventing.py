"""What robots invented, as a table and as JSON types."""

from collections.abc import Sequence
from typing import Any

from affcli.core.invention import Invention
from affcli.core.motion import motion_json
from affcli.core.records import LearningRunInfo
from affcli.report.sheet import Sheet
from affcli.report.words import call_words, many


def inventions_table(run: LearningRunInfo, inventions: Sequence[Invention]) -> Sheet:
    """Return what a run tried again: what each brings, the tries, and whether it was kept."""
    table = Sheet(
        ("behavior", "kept", "brings", "first", "for", "against"),
        title=f"Run {run.id}: what was invented with the {run.spec.tool}",
        caption="brings: more cells of place and direction; first, for, against: behaviors of the "
        "run, in which it was found and which speak for it and against it",
        left=("behavior", "kept", "for", "against"),
    )
    for one in inventions:
        tries = (
            ", ".join(str(step) for step, alike in one.tries if alike is wanted) or "none"
            for wanted in (True, False)
        )
        kept = "yes" if one.kept else "no"
        table.add(call_words(one.behavior.call), kept, str(one.gain), str(one.step), *tries)
    return table


def inventions_json(inventions: Sequence[Invention]) -> list[dict[str, Any]]:
    """Return the same as JSON types."""
    return [
        {
            "behavior": one.behavior.call.name,
            "params": dict(one.behavior.call.params),
            "motion": motion_json(one.behavior.motion),
            "kept": one.kept,
            "gain": one.gain,
            "step": one.step,
            "tries": [{"step": step, "alike": alike} for step, alike in one.tries],
        }
        for one in inventions
    ]


def invented_words(inventions: Sequence[Invention]) -> str:
    """Return in words what came of inventing: ``4 behaviors kept: turn 31 deg, ...``."""
    kept = [call_words(one.behavior.call) for one in inventions if one.kept]
    if not kept:
        return f"nothing kept; {many(len(inventions), 'composed behavior')} tried again"
    return f"{many(len(kept), 'behavior')} kept: {', '.join(kept)}"
