"""Carrying over to a new tool: from which runs a robot borrows, and what comes of it (§8)."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from affcli import registry
from affcli.core.affordance import Affordance
from affcli.core.identity import LONGEST_TEXT, Component, shown, stream_number
from affcli.core.limits import LARGEST_SEED
from affcli.core.mask import Mask
from affcli.core.records import LearningRunInfo, StoredRow
from affcli.core.setting import Value
from affcli.core.specs import LearningSpec
from affcli.core.transfer import MOST_LENDERS, Borrowed, Borrowing, Transfer
from affcli.core.world import shows_tools
from affcli.errors import BadInputError, UsageError, one_line
from affcli.exploration.borrowing import Lender, borrow
from affcli.lab.run_parts import RunParts, require_learned, world_of
from affcli.report.captions import Words
from affcli.report.transferring import LentTable, lent_tables
from affcli.store import Store

TRANSFER = 6
"""First word of the key of the random streams by which rows are drawn; see `simulation`."""
OPTION = "--transfer-from"

Tell = Callable[[str], object]
"""Is told what a person should know, in a line."""


def mask_of(spec: LearningSpec) -> Mask:
    """Return what the camera of a run's robot sees of its tool: a function of the spec alone.

    Raises:
        UsageError: its world shows no tools, or the camera's packages are missing.
        NotSeenError: the camera does not see the tool.
    """
    world = world_of(spec)
    if not shows_tools(world):
        raise UsageError(f"the world {world.name} shows no tool's shape: nothing can be borrowed")
    return world.mask(spec)


def borrowed_by(spec: LearningSpec, lenders: Sequence[Lender], mask: Mask) -> tuple[Borrowed, ...]:
    """Return what a run borrows: a function of its spec, for that names its lenders.

    Args:
        spec: of the run.
        lenders: those that it names, with their rows as they were learned.
        mask: what its camera sees of its tool.

    Raises:
        ValueError: it names none.
    """
    if spec.transfer is None:
        raise ValueError(f"the {spec.tool} borrows nothing")

    def stream(name: str) -> np.random.Generator:
        """Return the random stream of a name."""
        key = (TRANSFER, spec.seed, spec.robot, stream_number(spec.tool), stream_number(name))
        return np.random.Generator(np.random.PCG64(np.random.SeedSequence(key)))

    return borrow(lenders, mask, spec.repertoire, spec.transfer.borrowing, stream)


def lender_of(spec: LearningSpec, rows: Iterable[Affordance], mask: Mask) -> Lender:
    """Return a run as a lender, with the mask of its tool."""
    return Lender(spec.key, spec.tool, lendable(spec, rows), mask)


def lendable(spec: LearningSpec, rows: Iterable[Affordance]) -> list[Affordance]:
    """Return the rows that a run can lend: those that its own robot made, as they were learned.

    Of several grasps it lends what it did with the first: that is the one its camera saw.
    """
    return [
        replace(row, times_used=1, times_successful=1)
        for row in rows
        if not row.is_borrowed and row.binding == spec.binding
    ]


def joined(texts: Sequence[str]) -> str:
    """Return as one text what was said one by one: all runs, and after them how.

    Raises:
        BadInputError: how is said of two of them.
    """
    hows = [text.partition(":")[2] for text in texts if ":" in text]
    if len(hows) > 1:
        said = one_line(" and ".join(hows), 60)
        raise BadInputError(f"{OPTION}: how to borrow is said twice ({said}); say it once")
    runs = ",".join(text.partition(":")[0] for text in texts)
    return ":".join([runs, *hows])


def transfer_from(store: Store, text: str) -> Transfer:
    """Return what ``1,2:limit=0.2`` stands for: runs to borrow from, and how.

    Raises:
        BadInputError: a text of another form, or a wrong parameter.
        UsageError: there is no such run; the message says what to do.
    """
    place = f"{OPTION} {one_line(text, 60)}"
    numbers, borrowing = _parsed(text, place)
    if not all(re.fullmatch(r"[0-9]{1,18}", one) for one in numbers):
        raise BadInputError(f"{place}: name runs by their numbers: {OPTION} 1,2")
    keys = []
    for number in map(int, numbers):
        if not 1 <= number <= LARGEST_SEED:
            raise BadInputError(f"{place}: runs are numbered from 1")
        try:
            keys.append(store.learning.run(number).spec.key)
        except UsageError as error:
            raise UsageError(f"{place}: {error}; affcli runs list shows which there are") from error
    return Transfer(tuple(sorted(set(keys))), borrowing)


def _parsed(text: str, place: str) -> tuple[list[str], Borrowing]:
    """Return the names before the colon, and how to borrow, which stands behind it."""
    head, _, tail = text[:LONGEST_TEXT].partition(":")
    names = [one.strip() for one in head.split(",")]
    if not all(names) or len(text) > LONGEST_TEXT or len(names) > MOST_LENDERS:
        raise BadInputError(f"{place}: not of the form NAME,NAME:key=value,key=value")
    return names, Borrowing.of(_params(tail, place), place)


def _params(tail: str, place: str) -> dict[str, Value]:
    """Return the parameters of a text like ``key=value,key=value``."""
    try:
        return dict(Component.parse(f"transfer:{tail}" if tail else "transfer").params)
    except BadInputError as error:
        raise BadInputError(f"{place}: not of the form NAME,NAME:key=value,key=value") from error


def borrowed_from_store(
    store: Store, spec: LearningSpec, tell: Tell = str
) -> tuple[Mask, tuple[Borrowed, ...]]:
    """Return what a new run's camera sees, and what the run borrows from others of a database.

    What the cameras of these saw is kept from now on.

    Raises:
        UsageError: a lender is not there, not finished, has no rows, is of another kind, or of the
            same tool; or nothing carries over. The message says what to do.
        NotSeenError: a camera does not see its tool.
    """
    if spec.transfer is None:
        raise ValueError(f"the {spec.tool} borrows nothing")
    there = store.transfers.lenders(spec.transfer.lenders)
    if len(there) < len(spec.transfer.lenders):
        raise UsageError(
            f"{OPTION}: a run that the {one_line(spec.tool, 40)} borrows from was deleted; name "
            f"others: {OPTION} RUN,..."
        )
    runs = [store.learning.run(number) for number in sorted(there.values())]
    lenders = [_lender(store, run, spec, tell) for run in runs]
    mask = mask_of(spec)
    found = borrowed_by(spec, lenders, mask)
    if not found:
        numbers = ",".join(str(run.id) for run in runs)
        borrowing = spec.transfer.borrowing
        more = replace(borrowing, limit=min(2.0 * max(borrowing.limit, 0.1), 100.0))
        raise UsageError(
            f"{OPTION} {numbers}: nothing carries over to the {one_line(spec.tool, 40)}; borrow "
            f"from tools that are more like it, or allow more: {OPTION} {numbers}:{more}"
        )
    return mask, found


def borrowed_again(store: Store, run: LearningRunInfo) -> tuple[Borrowed, ...] | None:
    """Return what a stored run borrows when it does so again; None where a lender is not there.

    Raises:
        UsageError: the rows of a lender were not kept, or the camera's packages are missing.
    """
    if run.spec.transfer is None:
        return ()
    keys = run.spec.transfer.lenders
    there = map(store.learning.run, store.transfers.lenders(keys).values())
    lenders = [
        lender_of(
            one.spec, (stored.row for stored in store.learning.rows(one.id)), mask_of(one.spec)
        )
        for one in there
        if one.status == "done"
    ]
    return borrowed_by(run.spec, lenders, mask_of(run.spec)) if len(lenders) == len(keys) else None


def _lender(store: Store, run: LearningRunInfo, spec: LearningSpec, tell: Tell) -> Lender:
    """Return a stored run as a lender of a new one."""
    place, tool = f"{OPTION}: run {run.id}", one_line(run.spec.tool, 40)
    if run.status != "done":
        raise UsageError(f"{place} is not finished; go on with it first: affcli learn --resume")
    if run.spec.logged:
        raise UsageError(f"{place} comes from a log: no camera saw its {tool}; name another")
    require_learned(run, OPTION)
    if run.spec.held == spec.held:
        raise UsageError(
            f"{place} was learned with the {tool} itself: a tool borrows from others; name another "
            "run, or let it learn for longer"
        )
    other = _difference(run.spec, spec)
    if other:
        raise UsageError(
            f"{place} has {other} than this run; borrow from one that has the same, or learn with "
            "what it has (affcli runs show)"
        )
    lender_rows = (one.row for one in store.learning.rows(run.id))
    seen = store.transfers.mask(run.id)
    if seen is None:
        seen = mask_of(run.spec)
        store.transfers.save_mask(run.id, seen)
        tell(f"run {run.id}: took the mask of its {tool} by its spec; it is kept from now on")
    lender = lender_of(run.spec, lender_rows, seen)
    if not lender.rows:
        raise UsageError(f"{place} made no rows of its own with the {tool}; name another")
    return lender


def _difference(lender: LearningSpec, spec: LearningSpec) -> str:
    """Return in what a lender differs from a run so that its rows would say other things."""
    for what, one, two in (
        ("other settings", lender.settings, spec.settings),
        ("another world", lender.world, spec.world),
        ("another repertoire", lender.repertoire, spec.repertoire),
        ("another binding", lender.binding, spec.binding),
    ):
        if one != two:
            return what
    return ""


def lenders_gone(store: Store, spec: LearningSpec) -> str:
    """Return what is to be said of a run whose lenders were deleted; empty when they are there."""
    if spec.transfer is None:
        return ""
    gone = len(spec.transfer.lenders) - len(store.transfers.lenders(spec.transfer.lenders))
    if not gone:
        return ""
    return (
        f"the {one_line(spec.tool, 40)}: {gone} of the runs that it borrowed from "
        f"{'was' if gone == 1 else 'were'} deleted; it goes on with the rows that it has"
    )


@dataclass(frozen=True, slots=True)
class Transferring:
    """That the robots of a condition borrow from what each has learned itself.

    Args:
        tools: from which tools, by name; none lends to itself.
        minutes: for how long they are learned.
        borrowing: how.
    """

    tools: tuple[str, ...]
    minutes: float
    borrowing: Borrowing

    @classmethod
    def parse(cls, text: str) -> "Transferring":
        """Return what ``t-hook,l-stick:minutes=60`` stands for.

        Raises:
            UsageError: there is no such tool.
            BadInputError: a text of another form, or a wrong parameter.
        """
        place = f"transfer {one_line(text, 60)}"
        head, _, tail = text.partition(":")
        params = _params(tail, place)
        minutes = params.pop("minutes", 60.0)
        if isinstance(minutes, str) or not 0.0 < minutes <= 600_000.0:
            raise BadInputError(f"{place}: minutes = {one_line(minutes, 40)} must be more than 0")
        rest = ",".join(f"{key}={value}" for key, value in params.items())
        names, borrowing = _parsed(f"{head}:{rest}" if rest else head, place)
        tools = tuple(str(registry.part("tools", name).name) for name in names)
        if len(set(tools)) < len(tools):
            raise BadInputError(f"{place}: a tool comes twice")
        return cls(tools, float(minutes), borrowing)

    def __str__(self) -> str:
        """Write it as `parse` reads it."""
        params = [f"minutes={shown(self.minutes)}", *filter(None, (str(self.borrowing),))]
        return f"{','.join(self.tools)}:{','.join(params)}"

    def canonical(self, parts: RunParts) -> dict[str, Any]:
        """Return it with its tools by value, as JSON types."""
        return {
            "tools": [parts.tool(tool).canonical() for tool in self.tools],
            "minutes": self.minutes,
            "borrowing": self.borrowing.differing(Borrowing.first()),
        }

    def lenders(self, parts: RunParts, tool: str, seed: int, robot: int) -> list[LearningSpec]:
        """Return the learning runs from which a robot with these parts borrows for a tool."""
        others = (name for name in self.tools if name != tool)
        return [parts.spec(name, seed, robot, self.minutes / 60.0) for name in others]

    def of(self, lenders: Sequence[LearningSpec]) -> Transfer:
        """Return the part of a spec that names lenders."""
        return Transfer(tuple(sorted(one.key for one in lenders)), self.borrowing)


def borrowed_of(store: Store, run_id: int) -> tuple[tuple[Borrowed, ...], dict[str, int]]:
    """Return what a run borrowed, and the number of each lender's run that is there, by its key."""
    borrowed = store.transfers.of_run(run_id)
    return borrowed, store.transfers.lenders(sorted({one.lender for one in borrowed}))


def lending(store: Store, run: LearningRunInfo) -> tuple[Words, list[LentTable]]:
    """Return what a figure shows of what a run borrowed; nothing is saved.

    Raises:
        UsageError: it borrowed nothing.
    """
    borrowed, there = borrowed_of(store, run.id)
    if not borrowed:
        raise UsageError(
            f"run {run.id} of the {one_line(run.spec.tool, 40)} borrowed nothing; name one that "
            f"did (affcli learn {OPTION} RUN,...)"
        )
    lenders = []
    for number in sorted(there.values()):
        lender = store.learning.run(number)
        rows = lendable(lender.spec, (one.row for one in store.learning.rows(number)))
        lenders.append((lender, _mask_shown(store, lender), rows))
    return lent_tables(run, _mask_shown(store, run), borrowed, lenders)


def _mask_shown(store: Store, run: LearningRunInfo) -> Mask:
    """Return the mask of a run, as it is stored or as it would be."""
    return store.transfers.mask(run.id) or mask_of(run.spec)


def whence(store: Store, stored: StoredRow) -> tuple[Borrowed, int | None] | None:
    """Return where a row comes from and the number of the run that made it, None when that was
    deleted; None for a row that was not borrowed.
    """
    if not stored.row.is_borrowed:
        return None
    for one in store.transfers.of_run(stored.run_id, stored.row.step):
        return one, store.transfers.lenders([one.lender]).get(one.lender)
    return None
