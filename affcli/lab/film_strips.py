"""A stored trial, gathered for its film strip."""

from collections.abc import Iterable
from itertools import chain

from affcli.config import settings_from_json
from affcli.core.behavior import BehaviorCall
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Pose
from affcli.core.task import goal_regions, start_positions
from affcli.core.tool import ToolName, paper_tools
from affcli.core.trial import TrialSpec
from affcli.errors import UsageError, one_line
from affcli.lab.plausible import check_numbers, check_trial
from affcli.report.film import FilmedStep, FilmedTrial
from affcli.store import Store, StoredStep, TrialInfo

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
        DatabaseError: it holds what affcli did not write.
    """
    info = store.trial(trial_id)
    steps = tuple(map(_filmed, store.trial_steps(trial_id)))
    if wanted is not None:
        _require_steps(trial_id, wanted, len(steps))
    settings, spec = settings_from_json(info.settings), info.spec
    layout = settings.workspace.layout
    _require_known(trial_id, spec, steps)
    tools = paper_tools(settings.workspace.tools)
    believed, held = tools[ToolName(spec.tool)], tools[ToolName(spec.shape)]
    return FilmedTrial(
        title=_title(info),
        ending=None if info.outcome is None else info.outcome.value,
        parts=held.parts,
        missing=believed.parts_missing_in(held),
        goal=goal_regions(layout)[spec.goal],
        wrist=Pose(*settings.workspace.wrist_start, 0.0),
        puck=start_positions(layout)[spec.start],
        puck_radius=settings.workspace.puck.radius,
        table=settings.workspace.table,
        steps=steps,
    )


def _filmed(step: StoredStep) -> FilmedStep:
    """Return a step as a panel shows it."""
    return FilmedStep(
        number=step.number,
        behavior=_plain(step.row.exploratory),
        row=step.affordance_id,
        wrist_start=Pose(*step.wrist_start, 0.0),
        wrist_end=Pose(*step.wrist_end, 0.0),
        puck_start=step.true_start,
        puck_end=step.true_end,
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


def _require_known(trial_id: int, spec: TrialSpec, steps: Iterable[FilmedStep]) -> None:
    """Refuse tools and places that no trial of affcli has."""
    check_trial(trial_id, spec)
    for step in steps:
        places = (step.wrist_start, step.wrist_end, step.puck_start, step.puck_end)
        movements = (*step.expected, *step.seen)
        check_numbers(f"trial {trial_id}", (*chain.from_iterable(places), *movements))


def _title(info: TrialInfo) -> str:
    """Return which trial it is."""
    spec = info.spec
    tool = spec.tool if spec.tool == spec.shape else f"{spec.tool}, broken: {spec.shape}"
    return f"Trial {info.id}: {tool}, goal {spec.goal}, start {spec.start}"
