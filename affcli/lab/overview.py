"""What a database holds, read for the reports."""

from affcli.analysis.overview import Breaking, ExperimentRuns, Overview, breaking_of, goal_counts
from affcli.analysis.reproduction import Reproduction, failures_in
from affcli.core.records import ExperimentInfo, LearningRunInfo
from affcli.core.specs import Protocol
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
    latest: dict[tuple[object, ...], Breaking] = {}  # of the same one done again, the last
    for session in store.sessions.all("break-tool"):
        losses = {protocol: store.results.losses(session.id, protocol) for protocol in Protocol}
        one = breaking_of(session, store.trials.trials(session_id=session.id), losses)
        if one is not None:
            which = (one.run, one.seed, one.tool, one.shape, one.sensor)
            latest[*which, one.planner, one.task_set] = one
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


def experiments_of(store: Store) -> list[ExperimentRuns]:
    """Return the experiments that have robots, oldest first."""
    learned = store.experiments.learned()
    return [
        ExperimentRuns(one.name, len(one.conditions), learned[one.name], _failed(store, one))
        for one in store.experiments.all()
        if one.name in learned
    ]


def _failed(store: Store, one: ExperimentInfo) -> tuple[int, ...]:
    """Return the numbers of the robots of an experiment that failed."""
    return tuple(robot.robot for robot in store.sessions.failed_robots(one.conditions[0][1]))


def _is_twin(store: Store, run: LearningRunInfo) -> bool:
    """Tell whether a run was interrupted and has been done beside it, as an older affcli could."""
    same = None if run.status == "done" else store.learning.find(run.spec)
    return same is not None and same.id != run.id and same.status == "done"
