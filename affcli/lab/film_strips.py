"""A stored trial, gathered for its film strip."""

from affcli.core.behavior import BehaviorCall
from affcli.core.geometry import Pose
from affcli.core.tool import Tool, known_hold
from affcli.errors import UsageError
from affcli.lab.run_parts import require_shape, settings_of
from affcli.report.captions import trial_words
from affcli.report.film import FilmedTrial, Held
from affcli.report.words import call_words
from affcli.store import Store


def film_of(store: Store, trial_id: int, wanted: tuple[int, int] | None = None) -> FilmedTrial:
    """Return a trial with its steps, finished or not.

    Without its tool when this affcli does not know how that was held; the caption says so.

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
    workspace, hold = settings_of(learned).workspace, known_hold(learned.binding)
    title, caption = trial_words(info, store.learning.run(info.run_id))
    unknown = f"; tool not drawn: held by {call_words(learned.binding)}" if hold is None else ""
    bindings = dict.fromkeys([learned.binding, *(step.row.binding for step in steps)])
    held = {binding: _held(binding, spec.held, learned.held) for binding in bindings}
    at_start = held.pop(learned.binding)
    return FilmedTrial(
        title=title,
        caption=caption + unknown,
        ending=None if info.outcome is None else info.outcome.value,
        parts=at_start.parts,
        missing=at_start.missing,
        goal=spec.task.goal,
        wrist=Pose(*workspace.wrist_start),
        puck=spec.task.start,
        puck_radius=workspace.puck.radius,
        table=workspace.table,
        steps=steps,
        regrasped=held,
    )


def _held(binding: BehaviorCall, shape: Tool, believed: Tool) -> Held:
    """Return what was held by a binding behavior; nothing when it is not known how that holds."""
    hold = known_hold(binding)
    if hold is None:
        return Held((), ())
    held = shape.held(hold)
    return Held(held.parts, believed.held(hold).parts_missing_in(held))


def _require_steps(trial_id: int, wanted: tuple[int, int], count: int) -> None:
    """Refuse steps that the trial does not have."""
    if wanted[1] > count:
        known = f"it has steps 1 to {count}" if count else "it has none"
        missing = max(wanted[0], count + 1)
        raise UsageError(f"no step {missing} in trial {trial_id}; {known}")
