"""A stored trial, gathered for its film strip."""

from affcli.core.behavior import BehaviorCall
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Pose
from affcli.core.records import StoredStep, TrialInfo
from affcli.core.tool import hold_of
from affcli.errors import UsageError, one_line
from affcli.lab.run_parts import require_shape, settings_of
from affcli.report.film import FilmedStep, FilmedTrial
from affcli.store import Store

LONGEST_BEHAVIOR = 20
"""Letters of a behavior's name and distance; those of affcli have 17 at most."""


def film_of(store: Store, trial_id: int, wanted: tuple[int, int] | None = None) -> FilmedTrial:
    """Return a trial with its steps, finished or not.

    Args:
        store: open.
        trial_id: which.
        wanted: the numbers of a first and a last step that it must have; None for any.

    Raises:
        UsageError: there is no such trial, or no such step in it.
        DatabaseError: it is not known what its tools look like.
    """
    info = store.trials.trial(trial_id)
    for tool in (info.learned.held, info.spec.held):
        require_shape(tool, f"trial {trial_id}: ")
    steps = tuple(map(_filmed, store.trials.steps(trial_id)))
    if wanted is not None:
        _require_steps(trial_id, wanted, len(steps))
    spec, learned = info.spec, info.learned
    workspace, hold = settings_of(learned).workspace, hold_of(learned.binding)
    believed, held = learned.held.held(hold), spec.held.held(hold)
    return FilmedTrial(
        title=_title(info),
        ending=None if info.outcome is None else info.outcome.value,
        parts=held.parts,
        missing=believed.parts_missing_in(held),
        goal=spec.task.goal,
        wrist=Pose(*workspace.wrist_start),
        puck=spec.task.start,
        puck_radius=workspace.puck.radius,
        table=workspace.table,
        steps=steps,
    )


def _filmed(step: StoredStep) -> FilmedStep:
    """Return a step as a panel shows it."""
    return FilmedStep(
        number=step.number,
        behavior=_plain(step.row.exploratory),
        row=step.affordance_id,
        wrist_start=step.wrist_start,
        wrist_end=step.wrist_end,
        # Where a world does not tell the truth, what was seen stands for it.
        puck_start=step.true_start or step.seen_start,
        puck_end=step.true_end or step.seen_end,
        expected=step.expected,
        seen=step.seen,
        moved=step.seen_distance > MOVEMENT_THRESHOLD,
        replicated=step.replicated,
        blocked=step.status is None,
        excluded=step.died,
        lost=step.lost,
        successful=step.times_successful_after,
        used=step.times_used_after,
    )


def _plain(call: BehaviorCall) -> str:
    """Return a behavior in letters that every font has, short enough for a panel."""
    return one_line(str(call).encode("ascii", "backslashreplace").decode(), LONGEST_BEHAVIOR)


def _require_steps(trial_id: int, wanted: tuple[int, int], count: int) -> None:
    """Refuse steps that the trial does not have."""
    if wanted[1] > count:
        known = f"it has steps 1 to {count}" if count else "it has none"
        missing = max(wanted[0], count + 1)
        raise UsageError(f"no step {missing} in trial {trial_id}; {known}")


def _title(info: TrialInfo) -> str:
    """Return which trial it is."""
    spec = info.spec
    tool = spec.tool if spec.tool == spec.shape else f"{spec.tool}, broken: {spec.shape}"
    return f"Trial {info.id}: {tool}, goal {spec.goal}, start {spec.start}"
