"""A stored trial, gathered for its film strip."""

from affcli.core.geometry import Pose
from affcli.core.records import TrialInfo
from affcli.core.tool import hold_of
from affcli.errors import UsageError
from affcli.lab.run_parts import require_shape, settings_of
from affcli.report.film import FilmedTrial
from affcli.store import Store


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
    steps = store.trials.steps(trial_id)
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
