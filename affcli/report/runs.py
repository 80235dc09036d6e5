"""Learning runs as they are kept: what each is, what used it, and its note."""

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from affcli.core.invention import Invention
from affcli.core.log import LogSource
from affcli.core.records import Belongings, LearningRunInfo
from affcli.core.results import BehaviorGroup
from affcli.core.transfer import Borrowed
from affcli.report.inventing import inventions_json, inventions_table
from affcli.report.learning import groups_json, groups_table, run_json
from affcli.report.sheet import Sheet
from affcli.report.transferring import borrowed_json, borrowed_table
from affcli.report.words import (
    bindings_words,
    call_words,
    clock,
    fixed,
    many,
    run_words,
    seed_words,
)

SOME = 3
"""So many files of a log are named; `affcli sql "select * from log_file"` has all."""

Uses = Mapping[int, tuple[int, int]]
"""How many trials and verifications used a run, by its id; of those used at all."""


def runs_table(runs: Sequence[LearningRunInfo], uses: Uses) -> Sheet:
    """Return the runs, one a line, with what in each is not the usual, and its note."""
    counts = ("minutes", "tried", "rows", "trials")
    table = Sheet(
        ("run", "tool", "seed", *counts, "begun", "what differs; note"),
        caption="minutes: of the robot; tried: behaviors; trials: that used its table",
        left=("tool", "begun", "what differs; note"),
    )
    for run in runs:
        table.add(
            str(run.id),
            run.spec.tool,
            seed_words(run.spec),
            fixed(run.robot_seconds / 60.0, 1),
            *(str(run.behaviors), str(run.rows), str(uses.get(run.id, (0, 0))[0])),
            run.started_at[:10],
            "; ".join(_unusual(run)) or "defaults",
        )
    return table


def _unusual(run: LearningRunInfo) -> Iterator[str]:
    """Yield what is to be said of a run beside its numbers."""
    if run.status != "done":
        yield "unfinished"
    if run.session_id is not None:
        yield f"robot {run.spec.robot} of session {run.session_id}"
    if (words := run_words(run.spec)) != "defaults":
        yield words
    if run.note:
        yield f'"{run.note}"'


def run_tables(
    run: LearningRunInfo,
    belongings: Belongings,
    groups: Sequence[BehaviorGroup] | None,
    log: LogSource | None = None,
    inventions: Sequence[Invention] = (),
    borrowed: Sequence[Borrowed] = (),
    lenders: Mapping[str, int] = MappingProxyType({}),
) -> tuple[Sheet, ...]:
    """Return one run in full, what it learned by behavior unless that was not kept or it only
    borrowed, what it invented, and what it borrowed.

    Args:
        run: which.
        belongings: what used its table.
        groups: what it learned by behavior; None where that was not kept.
        log: where it comes from, if it was imported.
        inventions: what the robot invented in it.
        borrowed: what it borrowed.
        lenders: the number of each lender's run that is there, by its key.
    """
    spec = run.spec
    wanted = (
        f"{spec.hours:g} h" if spec.hours is not None else many(spec.behaviors or 0, "behavior")
    )
    part = "" if run.session_id is None else f", robot {spec.robot} of session {run.session_id}"
    facts = {
        "tool": spec.tool,
        "note": run.note or "none",
        "status": run.status if run.status == "done" else "unfinished; --resume goes on",
        "begun": f"{run.started_at[:16].replace('T', ' ')} UTC",
        "asked for": wanted if spec.logged else f"{wanted}, seed {spec.seed}{part}",
        "did": f"{clock(run.robot_seconds)}, {many(run.behaviors, 'behavior')}, "
        f"{many(run.rows, 'row')}, {many(run.resets, 'reset')}",
        "differs from the defaults": run_words(spec),
        "binding": bindings_words(spec),
        "behaviors": ", ".join(call_words(one.call) for one in spec.repertoire),
        "made with": ", ".join(f"{name} {one}" for name, one in run.versions.items()),
        "used by": use_words(belongings),
        **({} if log is None else _log_facts(log)),
    }
    sheet = Sheet(tuple(facts), title=f"Run {run.id}", records=True)
    sheet.add(*facts.values())
    nothing = groups is None or run.only_borrowed
    sheets = [sheet] if nothing else [sheet, groups_table(run, groups or ())]
    return (
        *sheets,
        *([inventions_table(run, inventions)] if inventions else ()),
        *([borrowed_table(run.id, borrowed, lenders)] if borrowed else ()),
    )


def _log_facts(log: LogSource) -> dict[str, str]:
    """Return where a run comes from."""
    return {
        "log": log.source,
        "licence": log.licence or "not known",
        "citation": log.citation or "not known",
        "files": ", ".join(f"{one.name} (SHA-256 {one.sha256[:12]})" for one in log.files[:SOME])
        + (f" and {len(log.files) - SOME} more" if len(log.files) > SOME else ""),
        "lines left out": str(log.left_out),
    }


def use_words(belongings: Belongings) -> str:
    """Return in words what used the table of a run."""
    used = (
        (belongings.trials, "trial", f" ({many(belongings.steps, 'step')})"),
        (belongings.verifications, "verification", f" ({many(belongings.tries, 'try')})"),
    )
    return " and ".join(f"{many(n, noun)}{of}" for n, noun, of in used if n) or "nothing"


def belongings_words(belongings: Belongings) -> str:
    """Return in words what is deleted with a run."""
    made = f"{many(belongings.behaviors, 'behavior')}, {many(belongings.rows, 'row')}"
    used = use_words(belongings)
    return made if used == "nothing" else f"{made}, {used}"


def kept_json(run: LearningRunInfo, uses: Uses) -> dict[str, Any]:
    """Return a line of `runs_table` as JSON types."""
    trials, verifications = uses.get(run.id, (0, 0))
    return {**run_json(run), "trials": trials, "verifications": verifications}


def run_in_full_json(
    run: LearningRunInfo,
    belongings: Belongings,
    groups: Sequence[BehaviorGroup] | None,
    log: LogSource | None = None,
    inventions: Sequence[Invention] = (),
    borrowed: Sequence[Borrowed] = (),
    lenders: Mapping[str, int] = MappingProxyType({}),
) -> dict[str, Any]:
    """Return what `run_tables` shows as JSON types."""
    spec = run.spec
    return {
        **kept_json(run, {run.id: (belongings.trials, belongings.verifications)}),
        "robot": spec.robot,
        "hours": spec.hours,
        "behaviors_limit": spec.behaviors,
        "versions": run.versions,
        "steps": belongings.steps,
        "tries": belongings.tries,
        "groups": None if groups is None else groups_json(groups),
        "log": None
        if log is None
        else {**log._asdict(), "files": [f._asdict() for f in log.files]},
        "inventions": inventions_json(inventions),
        "borrowed": [
            {"at": one.row.step, **borrowed_json(one, lenders.get(one.lender))} for one in borrowed
        ],
    }
