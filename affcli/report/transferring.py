"""What a run borrowed, in words (§8)."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from affcli.core.affordance import Affordance
from affcli.core.mask import Mask
from affcli.core.records import LearningRunInfo
from affcli.core.transfer import Borrowed
from affcli.errors import one_line
from affcli.report.captions import Words, joined, run_caption
from affcli.report.figures.words import tool_words
from affcli.report.sheet import Sheet
from affcli.report.words import many


class Kind(Enum):
    """What became of a row of a lender, in words."""

    LEFT = "not borrowed"
    SAME = "as it was"
    SHIFTED = "shifted"
    MIRRORED = "mirrored, maybe shifted"

    @classmethod
    def of(cls, one: Borrowed) -> "Kind":
        """Return what became of a row that was borrowed."""
        if one.mirrored:
            return cls.MIRRORED
        return cls.SHIFTED if any(one.shift) else cls.SAME


@dataclass(frozen=True, slots=True)
class LentTable:
    """Rows over the tool that they are of, as a figure shows them.

    Args:
        heading: what stands over it.
        mask: of the tool.
        rows: each with what became of it.
    """

    heading: str
    mask: Mask
    rows: Sequence[tuple[Affordance, Kind]]


def lent_tables(
    run: LearningRunInfo,
    mask: Mask,
    borrowed: Sequence[Borrowed],
    lenders: Sequence[tuple[LearningRunInfo, Mask, Sequence[Affordance]]],
) -> tuple[Words, list[LentTable]]:
    """Return what a figure shows of a run that borrowed.

    A row of a lender that was borrowed in several ways is shown as the plainest of them.

    Args:
        run: which.
        mask: what its camera saw of its tool.
        borrowed: what it borrowed.
        lenders: each that is still there, with its mask and its own rows.
    """
    tables = []
    for lender, seen, rows in lenders:
        own = [one for one in borrowed if one.lender == lender.spec.key]
        became = {kind: {one.step for one in own if Kind.of(one) is kind} for kind in Kind}
        plainest = (Kind.SAME, Kind.SHIFTED, Kind.MIRRORED)
        shown = [
            (row, next((kind for kind in plainest if row.step in became[kind]), Kind.LEFT))
            for row in rows
        ]
        lent = len({one.step for one in own})
        name = f"{tool_words(lender.spec.tool)}, run {lender.id}"
        heading = f"{name}: {lent} of {many(len(rows), 'row')} lent"
        tables.append(LentTable(heading, seen, shown))
    heading = f"{tool_words(run.spec.tool)}, run {run.id}: {many(len(borrowed), 'row')} borrowed"
    tables.append(LentTable(heading, mask, [(one.row, Kind.of(one)) for one in borrowed]))
    gone = len({one.lender for one in borrowed}) - len(lenders)
    missing = f"{many(gone, 'lender')} not there any more" if gone else ""
    title = f"Carried over to the {tool_words(run.spec.tool)}"
    return Words(title, joined(run_caption(run), missing)), tables


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
