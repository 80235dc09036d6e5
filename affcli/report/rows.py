"""Rows of affordance tables: listed, and one in full with all that was tried of it (§3.2, §6.1)."""

from collections.abc import Sequence
from typing import Any, Protocol

from rich.console import RenderableType
from rich.text import Text

from affcli.core.affordance import Affordance
from affcli.core.geometry import Point, direction_degrees
from affcli.core.observation import Movement, Observation
from affcli.core.trial import LearningSpec, TrialSpec
from affcli.core.verification import Tried
from affcli.errors import one_line
from affcli.report.learning import whole_degrees
from affcli.report.sheet import Sheet

DIRECTIONS = "degrees: 0 right, 90 away from the robot, 180 left"


class StoredRow(Protocol):
    """A row of an affordance table as it is stored."""

    @property
    def id(self) -> int:
        """Its number in the database."""

    @property
    def run_id(self) -> int:
        """The learning run that made it."""

    @property
    def tool(self) -> str:
        """The tool held then."""

    @property
    def row(self) -> Affordance:
        """What was learned, with its counters as they are now."""


class LearningRun(Protocol):
    """The learning run that made a row."""

    @property
    def id(self) -> int:
        """Its number in the database."""

    @property
    def session_id(self) -> int | None:
        """The reproduction it is part of; None when it stands for itself."""

    @property
    def spec(self) -> LearningSpec:
        """What it is a function of."""

    @property
    def behaviors(self) -> int:
        """Behaviors executed."""


class TriedStep(Protocol):
    """A step of a trial that tried a row."""

    @property
    def trial_id(self) -> int:
        """The trial."""

    @property
    def number(self) -> int:
        """Which of its steps."""

    @property
    def row(self) -> Affordance:
        """The row with its counters before the step."""

    @property
    def placing_status(self) -> str:
        """How the position wrist before it ended."""

    @property
    def status(self) -> str | None:
        """How the exploratory behavior ended; None when the tool could not be lowered."""

    @property
    def expected(self) -> Movement:
        """The movement the row predicts (in)."""

    @property
    def seen(self) -> Movement:
        """The movement observed (in)."""

    @property
    def replicated(self) -> bool:
        """Whether it counts as a success of the row."""

    @property
    def died(self) -> bool:
        """Whether it excluded the row from then on."""

    @property
    def lost(self) -> bool | None:
        """Whether the row was truly lost when the tool broke; None for a whole tool."""

    @property
    def times_used_after(self) -> int:
        """The row's counter of uses after the step."""

    @property
    def times_successful_after(self) -> int:
        """The row's counter of successes after the step."""


Use = tuple[TriedStep, TrialSpec]
"""A step that tried a row, and the trial it is part of."""


def rows_table(rows: Sequence[tuple[StoredRow, str]], title: str, *, with_runs: bool) -> Sheet:
    """Return rows, one a line.

    Args:
        rows: each with its region: the part of the tool nearest to the attractor when it was made.
        title: what they are.
        with_runs: name the learning run of each.
    """
    run = ("run",) if with_runs else ()
    table = Sheet(
        ("id", *run, "tool", "behavior", "from wrist", "region", "inches", "degrees", "uses"),
        title=title,
        caption="from wrist: the attractor before; region: the part of the tool it was nearest to; "
        f"{DIRECTIONS}; uses: successes/uses, at 1/2 or less the row is excluded",
        left=("tool", "behavior", "region"),
    )
    for stored, region in rows:
        row, moved = stored.row, stored.row.expected_movement
        table.add(
            str(stored.id),
            *((str(stored.run_id),) if with_runs else ()),
            one_line(stored.tool),
            one_line(row.exploratory),
            _place(row.start.wrist_to_object),
            region,
            f"{moved.distance:.1f}",
            str(_degrees(moved)),
            f"{row.times_successful}/{row.times_used}",
        )
    return table


def rows_json(rows: Sequence[tuple[StoredRow, str]]) -> list[dict[str, Any]]:
    """Return what `rows_table` shows as JSON types."""
    return [_row_json(stored, region) for stored, region in rows]


def row_tables(
    stored: StoredRow,
    region: str,
    run: LearningRun,
    history: Sequence[Use],
    tries: Sequence[Tried] = (),
) -> tuple[RenderableType, ...]:
    """Return one row in full, its two observation vectors, and all that tried it.

    Args:
        stored: the row.
        region: the part of the tool nearest to the attractor when it was made.
        run: which made it.
        history: the steps of trials that tried it.
        tries: those of verifications that updated the table.
    """
    verified = (_tries(tries),) if tries else ()
    facts, observations = _facts(stored, region, run), _observations(stored.row)
    return facts, observations, _history(history), *verified


def row_json(
    stored: StoredRow,
    region: str,
    run: LearningRun,
    history: Sequence[Use],
    tries: Sequence[Tried] = (),
) -> dict[str, Any]:
    """Return what `row_tables` shows as JSON types."""
    row = stored.row
    return {
        **_row_json(stored, region),
        "binding": {"behavior": row.binding.name, "params": dict(row.binding.params)},
        "start": row.start._asdict(),
        "end": row.end._asdict(),
        "learned": {"session": run.session_id, "seed": run.spec.seed, "robot": run.spec.robot},
        "history": [_use_json(step, trial) for step, trial in history],
        "verifications": [
            {**one._asdict(), "expected": one.expected[:2], "seen": one.seen[:2]} for one in tries
        ],
    }


def _facts(stored: StoredRow, region: str, run: LearningRun) -> Sheet:
    """Return what was done, what is expected of it, and how far it may be trusted."""
    row, moved = stored.row, stored.row.expected_movement
    part = "" if run.session_id is None else f", robot {run.spec.robot} of session {run.session_id}"
    facts = {
        "tool": stored.tool,
        "learned": f"step {row.step} of run {run.id} (seed {run.spec.seed}{part})",
        "done": f"{row.binding}, then {row.exploratory}",
        "attractor from wrist": f"{_place(row.start.wrist_to_object)} in, nearest the {region}",
        "expected movement": f"{moved.distance:.1f} in at {_degrees(moved)} degrees",
        "truncated": "yes, at the edge of the arm's reach" if row.truncated else "no",
        "successes/uses": f"{row.times_successful}/{row.times_used}, "
        f"probability {row.replication_probability:.3g}",
        "excluded": "yes, at 1/2 or less" if _excluded(row) else "no",
    }
    sheet = Sheet(tuple(facts), title=f"Row {stored.id} of the affordance tables", records=True)
    sheet.add(*map(one_line, facts.values()))
    return sheet


def _observations(row: Affordance) -> Sheet:
    """Return O^s and O^e, one component a line."""
    sheet = Sheet(
        ("component", "what", "O^s", "O^e"),
        title="Observation vectors before and after",
        caption="positions in inches, colours 0 to 255; wrist to object: the object from the wrist",
        left=("component", "what"),
    )
    components = zip(Observation._fields, row.start, row.end, strict=True)
    for number, (name, start, end) in enumerate(components, start=1):
        sheet.add(f"o{number}", name.replace("_", " "), _fixed(start, 2), _fixed(end, 2))
    return sheet


def _history(history: Sequence[Use]) -> Sheet | Text:
    """Return the steps that tried a row."""
    if not history:
        return Text("No stored trial tried it.")
    sheet = Sheet(
        ("trial", "shape", "step", "expected", "seen", "replicated", "successes/uses"),
        title=f"Tried {len(history)} time{'s' if len(history) != 1 else ''}",
        caption="shape: what the tool was then; expected, seen: inches at degrees; successes/uses: "
        "solve updates the stored ones, a trial of break-tool or reproduce counts from 1/1 for "
        "itself",
        left=("shape", "replicated"),
    )
    for step, trial in history:
        before, after = step.row, (step.times_successful_after, step.times_used_after)
        verdict = "yes" if step.replicated else "no"
        if step.status is None:
            verdict = f"no, {one_line(step.placing_status)}"
        sheet.add(
            str(step.trial_id),
            one_line(trial.shape),
            str(step.number),
            _moved(step.expected),
            _moved(step.seen),
            f"{verdict}, excluded" if step.died else verdict,
            f"{before.times_successful}/{before.times_used} -> {after[0]}/{after[1]}",
        )
    return sheet


def _tries(tries: Sequence[Tried]) -> Sheet:
    """Return the tries of verifications, which update the stored counters."""
    sheet = Sheet(
        ("verification", "try", "shape", "expected", "seen", "replicated", "successes/uses"),
        title=f"Tried by verify --update {len(tries)} time{'s' if len(tries) != 1 else ''}",
        left=("shape", "replicated"),
    )
    for one in tries:
        verdict = "yes" if one.replicated else "no, blocked" if one.blocked else "no"
        sheet.add(
            str(one.verification),
            str(one.number),
            one_line(one.shape),
            _moved(one.expected),
            _moved(one.seen),
            f"{verdict}, excluded" if one.died else verdict,
            f"{one.before[0]}/{one.before[1]} -> {one.after[0]}/{one.after[1]}",
        )
    return sheet


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
        "from_wrist": list(row.start.wrist_to_object),
        "region": region,
        "expected": [moved.dx, moved.dy],
        "movement": moved.distance,
        "direction": direction_degrees(moved.dx, moved.dy),
        "times_successful": row.times_successful,
        "times_used": row.times_used,
        "replication_probability": row.replication_probability,
        "excluded": _excluded(row),
    }


def _use_json(step: TriedStep, trial: TrialSpec) -> dict[str, Any]:
    """Return a step that tried a row as JSON types."""
    return {
        "trial": step.trial_id,
        "protocol": trial.protocol.value,
        "shape": trial.shape,
        "goal": trial.goal,
        "start": trial.start,
        "counters": trial.counters.value,
        "step": step.number,
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
    return row.replication_probability <= 0.5


def _moved(movement: Movement) -> str:
    """Return a movement as inches at degrees."""
    if movement.distance == 0.0:
        return "none"
    return f"{movement.distance:.1f} at {_degrees(movement)}"


def _degrees(movement: Movement) -> int:
    """Return the direction of a movement in whole degrees."""
    return whole_degrees(direction_degrees(movement.dx, movement.dy))


def _place(offset: Point) -> str:
    """Return where the attractor was from the wrist (in), to the right and away."""
    return f"{_fixed(offset.x, 1)}, {_fixed(offset.y, 1)}"


def _fixed(value: float, digits: int) -> str:
    """Return a number with so many digits, a plain 0 for the -0 that rounding may give."""
    return f"{round(value, digits) + 0.0:.{digits}f}"
