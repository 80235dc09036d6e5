"""What a database holds, read for the reports."""

from dataclasses import replace

from affcli.analysis.experiment import ConditionResult, ExperimentResult, tallies
from affcli.analysis.overview import Breaking, Overview, breaking_of, goal_counts
from affcli.analysis.paired import Comparison, in_common
from affcli.analysis.reproduction import Reproduction, failures_in
from affcli.core.records import ExperimentInfo, LearningRunInfo
from affcli.core.specs import Protocol
from affcli.lab.conditions import condition_of, counts_of
from affcli.store import Store


def reproduction_of(store: Store, session_id: int) -> Reproduction:
    """Return what the robots of a reproduction gave, as many as are saved.

    Args:
        store: open.
        session_id: the reproduction.
    """
    session = next(one for one in store.sessions.all() if one.id == session_id)
    return Reproduction.of(
        session,
        store.sessions.saved_robots(session_id),
        store.results.success_counts(session.id),
        store.results.outcome_counts([session.id]),
        store.results.losses(session.id, Protocol.TOOL_ADAPTATION)[0],
        store.sessions.failed_robots(session_id),
    )


def overview_of(store: Store) -> Overview:
    """Return what the database holds: learned tools, trials, finished reproductions."""
    runs = [run for run in store.learning.runs() if not _is_twin(store, run)]
    latest: dict[tuple[object, ...], Breaking] = {}  # of the same one done again, the last finished
    for session in store.sessions.all("break-tool"):
        losses = {protocol: store.results.losses(session.id, protocol) for protocol in Protocol}
        one = breaking_of(session, store.trials.trials(session_id=session.id), losses)
        if one is None:
            continue
        which = (one.run, one.seed, one.tool, one.shape, one.sensor, one.planner, one.task_set)
        before = latest.get(which)
        if one.finished or before is None or not before.finished:
            latest[which] = one
    counted = [s.id for s in store.sessions.all("solve")] + [b.session for b in latest.values()]
    failed = failures_in(store.results.outcome_counts(counted))
    return Overview(
        [(run, store.results.behavior_groups(run.id)) for run in runs],
        goal_counts(store.trials.trials(kind="solve"), runs),
        list(latest.values()),
        failed.kinds,
        failed.trials,
        [
            reproduction_of(store, session.id)
            for session in store.sessions.all("reproduce")
            if session.status == "done"
        ],
        failed.invalid,
        experiments_of(store),
    )


def experiments_of(store: Store) -> list[ExperimentResult]:
    """Return what the experiments that have robots gave, with their conditions compared."""
    every = (experiment_of(store, one) for one in store.experiments.all())
    return [replace(one, comparison=_comparison(store, one)) for one in every if one.learning_runs]


def experiment_of(store: Store, info: ExperimentInfo) -> ExperimentResult:
    """Return what the robots of an experiment gave."""
    first = info.conditions[0][1]
    return ExperimentResult(
        info.name,
        info.question,
        len(store.sessions.saved_robots(first)),
        store.experiments.learned().get(info.name, 0),
        [
            ConditionResult(
                name,
                session,
                tallies(store.results.solved_by_cell(session, ())),
                store.results.invalid(session),
                failures_in(store.results.outcome_counts([session])).kinds,
            )
            for name, session in info.conditions
        ],
        store.sessions.failed_robots(first),
    )


def _comparison(store: Store, one: ExperimentResult) -> Comparison | None:
    """Return the conditions of an experiment compared with the first of them.

    None where no other did the same tasks.
    """
    sessions = {session.id: session for session in store.sessions.all()}
    first, *others = (condition_of(store, c.name, sessions[c.session]) for c in one.results)
    base = counts_of(store, first)
    every = [counts_of(store, other) for other in others]
    alike = [c for c in every if in_common(base, c) and base.cells.keys() & c.cells.keys()]
    return Comparison.of(base, alike, ()) if alike else None


def _is_twin(store: Store, run: LearningRunInfo) -> bool:
    """Tell whether a run was interrupted and has been done beside it, as an older affcli could."""
    same = None if run.status == "done" else store.learning.find(run.spec)
    return same is not None and same.id != run.id and same.status == "done"
