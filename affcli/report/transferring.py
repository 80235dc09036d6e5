"""What a run borrowed, in words (§8)."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from affcli.core.transfer import Borrowed
from affcli.errors import one_line
from affcli.report.sheet import Sheet


def borrowed_words(one: Borrowed, lender: int | None) -> str:
    """Return in words where a borrowed row comes from.

    Args:
        one: the row.
        lender: the number of the run that made it; None when that is not there any more.
    """
    whose = "a run that was deleted" if lender is None else f"run {lender}"
    changes = ["mirrored"] if one.mirrored else []
    if any(one.shift):
        changes.append(f"shifted by ({one.shift.x:.1f}, {one.shift.y:.1f}) in")
    changed = ", ".join(changes) or "as it was"
    return f"step {one.step} of {whose} ({one_line(one.tool, 40)}), {changed}"


def borrowed_json(one: Borrowed, lender: int | None) -> dict[str, Any]:
    """Return where a borrowed row comes from as JSON types."""
    return {
        "run": lender,
        "key": one.lender,
        "tool": one.tool,
        "step": one.step,
        "shift": list(one.shift),
        "mirrored": one.mirrored,
    }


def borrowed_table(run_id: int, rows: Sequence[Borrowed], lenders: Mapping[str, int]) -> Sheet:
    """Return what a run borrowed, by lender.

    Args:
        run_id: the run.
        rows: what it borrowed.
        lenders: the number of each lender's run that is there, by its key.
    """
    table = Sheet(
        ("run", "tool", "rows", "as they were", "shifted", "mirrored"),
        title=f"Run {run_id}: what it borrowed",
        caption="shifted: the new tool looks alike elsewhere; mirrored: left and right exchanged",
        left=("tool",),
    )
    for (key, tool), count in Counter((one.lender, one.tool) for one in rows).items():
        own = [one for one in rows if one.lender == key]
        table.add(
            str(lenders.get(key, "deleted")),
            one_line(tool, 40),
            str(count),
            str(sum(not (any(one.shift) or one.mirrored) for one in own)),
            str(sum(any(one.shift) for one in own)),
            str(sum(one.mirrored for one in own)),
        )
    return table
