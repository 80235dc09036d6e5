"""Rows of affordance tables: listed, and one in full with all that was tried of it (§3.2, §6.1)."""

import math
from collections.abc import Sequence
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from affcli.analysis.paper import PLANNER
from affcli.analysis.regions import UNKNOWN
from affcli.core.affordance import Affordance, is_probable
from affcli.core.geometry import Point, direction_degrees
from affcli.core.log import LogFile, LogLine
from affcli.core.observation import Observation
from affcli.core.records import LearningRunInfo, StoredReplication, StoredRow, StoredStep
from affcli.core.specs import TrialSpec
from affcli.core.transfer import Borrowed
from affcli.report.sheet import Sheet
from affcli.report.transferring import borrowed_json, borrowed_words
from affcli.report.words import call_words, degrees_of, fixed, many, movement_cell

DIRECTIONS = "degrees: 0 right, 90 away from the robot, 180 left"
USUAL_BINDING = "grasp 1"

Line = tuple[LogFile, LogLine]
"""Where a row stands in a log."""
Whence = tuple[Borrowed, int | None]
"""A borrowed row and the number of the run that made it; None when that was deleted."""
Use = tuple[StoredStep, TrialSpec]
"""A step that tried a row, and the trial it is part of."""


def rows_table(rows: Sequence[tuple[StoredRow, str]], title: str, *, with_runs: bool) -> Sheet:
    """Return rows, each on a line.

    Args:
        rows: each with its region: the part of the tool nearest to the attractor when it was made.
        title: what they are.
        with_runs: name the learning run of each.
    """
    run = ("run",) if with_runs else ()
    bindings = {call_words(stored.row.binding) for stored, _ in rows}
    columns = ("behavior", "from wrist", "region", "inches", "degrees", "uses")
    binding = ("binding",) if bindings - {USUAL_BINDING} else ()
    borrowed = ("borrowed",) if any(stored.row.is_borrowed for stored, _ in rows) else ()
    table = Sheet(
        ("id", *run, "tool", *binding, *columns, *borrowed),
        title=title,
        caption="from wrist: the attractor before; region: the part of the tool it was nearest to; "
        f"{DIRECTIONS}; uses: successes/uses, at 1/2 or less the row is excluded",
        left=("tool", "binding", "behavior", "region", "borrowed"),
    )
    for stored, region in rows:
        row, moved = stored.row, stored.row.expected_movement
        table.add(
            str(stored.id),
            *((str(stored.run_id),) if with_runs else ()),
            stored.tool,
            *(call_words(row.binding) for _ in binding),
            call_words(row.exploratory),
            _place(row.start.wrist_to_object),
            region,
            f"{moved.distance:.1f}",
            str(degrees_of(moved.dx, moved.dy)),
            f"{row.times_successful}/{row.times_used}",
            *(("yes" if row.is_borrowed else "no") for _ in borrowed),
        )
    return table


def rows_json(rows: Sequence[tuple[StoredRow, str]]) -> list[dict[str, Any]]:
    """Return what `rows_table` shows as JSON types."""
    return [_row_json(stored, region) for stored, region in rows]


def row_tables(
    stored: StoredRow,
    region: str,
    run: LearningRunInfo,
    history: Sequence[Use],
    tries: Sequence[StoredReplication] = (),
    line: Line | None = None,
    borrowed: Whence | None = None,
) -> tuple[RenderableType, ...]:
    """Return one row in full, its two observation vectors, and all that tried it.

    Args:
        stored: the row.
        region: the part of the tool nearest to the attractor when it was made.
        run: which made it.
        history: the steps of trials that tried it.
        tries: those of verifications that updated the table.
        line: where it stands, if its run was imported from a log.
        borrowed: where it comes from, if its run borrowed it.
    """
    verified = (_tries(tries),) if tries else ()
    facts = _facts(stored, region, run, line, borrowed)
    observations = _observations(stored.row)
    return facts, observations, _history(history), *verified


def row_json(
    stored: StoredRow,
    region: str,
    run: LearningRunInfo,
    history: Sequence[Use],
    tries: Sequence[StoredReplication] = (),
    line: Line | None = None,
    borrowed: Whence | None = None,
) -> dict[str, Any]:
    """Return what `row_tables` shows as JSON types."""
    row = stored.row
    return {
        **_row_json(stored, region),
        "binding": {"behavior": row.binding.name, "params": dict(row.binding.params)},
        "start": row.start._asdict(),
        "end": row.end._asdict(),
        "learned": {"session": run.session_id, "seed": run.spec.seed, "robot": run.spec.robot},
        "logged": None
        if line is None
        else {**line[0]._asdict(), "line": line[1].line, "object": line[1].object},
        "borrowed_from": None if borrowed is None else borrowed_json(*borrowed),
        "history": [_use_json(step, trial) for step, trial in history],
        "verifications": [
            {**one._asdict(), "expected": one.expected[:2], "seen": one.seen[:2]} for one in tries
        ],
    }


def _facts(
    stored: StoredRow,
    region: str,
    run: LearningRunInfo,
    line: Line | None,
    borrowed: Whence | None,
) -> Sheet:
    """Return what was done, what is expected of it, and how far it may be trusted."""
    row, moved = stored.row, stored.row.expected_movement
    part = "" if run.session_id is None else f", robot {run.spec.robot} of session {run.session_id}"
    angle = 0.0 if math.isnan(row.wrist_angle) else round(math.degrees(row.wrist_angle), 1)
    turned = f", the wrist at {angle:g} degrees" if angle else ""
    near = "" if region == UNKNOWN else f", nearest the {region}"
    whence = f"seed {run.spec.seed}{part}"
    if line is not None:
        file, at = line
        whence = f"{file.name}, line {at.line}" + (f", object {at.object}" if at.object else "")
    how = "computed" if run.spec.told else "learned"
    learned = {how: f"step {row.step} of run {run.id} ({whence})"}
    if borrowed is not None:
        learned = {"borrowed": f"by run {run.id} ({whence}): {borrowed_words(*borrowed)}"}
    facts = {
        "tool": stored.tool,
        **learned,
        "done": f"{call_words(row.binding)}, then {call_words(row.exploratory)}{turned}",
        "attractor from wrist": f"{_place(row.start.wrist_to_object)} in{near}",
        "expected movement": f"{moved.distance:.1f} in at {degrees_of(moved.dx, moved.dy)} degrees",
        "truncated": "yes, at the edge of the arm's reach" if row.truncated else "no",
        "successes/uses": f"{row.times_successful}/{row.times_used}, "
        f"probability {row.replication_probability:.3g}",
        "excluded": "yes, at 1/2 or less" if _excluded(row) else "no",
    }
    sheet = Sheet(tuple(facts), title=f"Row {stored.id} of the affordance tables", records=True)
    sheet.add(*facts.values())
    return sheet


def _observations(row: Affordance) -> Sheet:
    """Return O^s and O^e, each component on a line."""
    sheet = Sheet(
        ("component", "what", "O^s", "O^e"),
        title="Observation vectors before and after",
        caption="positions in inches, colours 0 to 255; wrist to object: the object from the wrist",
        left=("component", "what"),
    )
    components = zip(Observation._fields, row.start, row.end, strict=True)
    for number, (name, start, end) in enumerate(components, start=1):
        sheet.add(f"o{number}", name.replace("_", " "), fixed(start, 2), fixed(end, 2))
    return sheet


def _history(history: Sequence[Use]) -> Sheet | Text:
    """Return the steps that tried a row."""
    if not history:
        return Text("No stored trial tried it.")
    planner = ("planner",) if any(str(trial.planner) != PLANNER for _, trial in history) else ()
    sheet = Sheet(
        ("trial", "shape", *planner, "step", "expected", "seen", "replicated", "successes/uses"),
        title=f"Tried {many(len(history), 'time')}",
        caption="shape: what the tool was then; expected, seen: inches at degrees; successes/uses: "
        "solve updates the stored ones, a trial of break-tool or reproduce counts from 1/1 for "
        "itself",
        left=("shape", "planner", "replicated"),
    )
    for step, trial in history:
        blocked = step.placing_status if step.status is None else ""
        verdict = _verdict(replicated=step.replicated, blocked=blocked, died=step.died)
        counters = (step.row.times_successful, step.row.times_used)
        after = (step.times_successful_after, step.times_used_after)
        sheet.add(
            str(step.trial_id),
            trial.shape,
            *(str(trial.planner) for _ in planner),
            str(step.number),
            movement_cell(step.expected),
            movement_cell(step.seen),
            f"{verdict}, grasped anew" if step.regrasped else verdict,
            _counted(counters, after),
        )
    return sheet


def _tries(tries: Sequence[StoredReplication]) -> Sheet:
    """Return the tries of verifications, which update the stored counters."""
    sheet = Sheet(
        ("verification", "try", "shape", "expected", "seen", "replicated", "successes/uses"),
        title=f"Tried by verify --update {many(len(tries), 'time')}",
        left=("shape", "replicated"),
    )
    for one in tries:
        sheet.add(
            str(one.verification),
            str(one.number),
            one.shape,
            movement_cell(one.expected),
            movement_cell(one.seen),
            _verdict(
                replicated=one.replicated, blocked="blocked" if one.blocked else "", died=one.died
            ),
            _counted(one.before, one.after),
        )
    return sheet


def _verdict(*, replicated: bool, blocked: str, died: bool) -> str:
    """Return whether a row replicated, why it was not executed, and whether that excluded it."""
    words = ("yes" if replicated else "no", blocked, "excluded" if died else "")
    return ", ".join(filter(None, words))


def _counted(before: tuple[int, int], after: tuple[int, int]) -> str:
    """Return successes and uses around a try."""
    return f"{before[0]}/{before[1]} -> {after[0]}/{after[1]}"


def _row_json(stored: StoredRow, region: str) -> dict[str, Any]:
    """Return a row as JSON types, without its observation vectors."""
    row, moved = stored.row, stored.row.expected_movement
    return {
        "id": stored.id,
        "run": stored.run_id,
        "step": row.step,
        "tool": stored.tool,
        "behavior": row.exploratory.name,
        "params": dict(row.exploratory.params),
        "truncated": row.truncated,
        "wrist_angle_degrees": math.degrees(row.wrist_angle),
        "from_wrist": list(row.start.wrist_to_object),
        "region": region,
        "expected": [moved.dx, moved.dy],
        "movement": moved.distance,
        "direction": direction_degrees(moved.dx, moved.dy),
        "times_successful": row.times_successful,
        "times_used": row.times_used,
        "replication_probability": row.replication_probability,
        "excluded": _excluded(row),
        "borrowed": row.is_borrowed,
    }


def _use_json(step: StoredStep, trial: TrialSpec) -> dict[str, Any]:
    """Return a step that tried a row as JSON types."""
    return {
        "trial": step.trial_id,
        "protocol": trial.protocol.value,
        "shape": trial.shape,
        "goal": trial.goal,
        "start": trial.start,
        "counters": trial.counters.value,
        "planner": str(trial.planner),
        "step": step.number,
        "reasons": [reason.json() for reason in step.reasons],
        "regrasped": step.regrasped,
        "placing_status": step.placing_status,
        "status": step.status,
        "expected": [step.expected.dx, step.expected.dy],
        "seen": [step.seen.dx, step.seen.dy],
        "replicated": step.replicated,
        "times_successful_before": step.row.times_successful,
        "times_used_before": step.row.times_used,
        "times_successful_after": step.times_successful_after,
        "times_used_after": step.times_used_after,
        "excluded": step.died,
        "lost": step.lost,
    }


def _excluded(row: Affordance) -> bool:
    """Tell whether the second search of §6.2 leaves the row out."""
    return not is_probable(row.times_successful, row.times_used)


def _place(offset: Point) -> str:
    """Return where the attractor was from the wrist (in), to the right and away."""
    return f"{fixed(offset.x, 1)}, {fixed(offset.y, 1)}"
