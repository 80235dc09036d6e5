"""Reading what the page shows: one robot's tools and trials, and what many robots gave."""

from collections.abc import Callable, Iterable, Sequence

from affcli.analysis.paper import TOOLS
from affcli.analysis.reproduction import Reproduction
from affcli.core.records import LearningRunInfo, TrialInfo
from affcli.core.replay import Replay
from affcli.core.specs import Counters
from affcli.core.trial import is_counted
from affcli.errors import AffcliError, UsageError, one_line
from affcli.lab.overview import reproduction_of
from affcli.lab.replaying import replay_trial
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.report.words import in_order
from affcli.store import Store


def content_of(
    store: Store,
    robot: int | None = None,
    session: int | None = None,
    done: Callable[[int, int], object] = lambda _, __: None,
) -> Content:
    """Return what the page shows.

    Args:
        store: open.
        robot: which robot of a reproduction; None for the one that learned by `learn`, if there is
            one, else the first of the latest reproduction.
        session: which reproduction; None for the latest.
        done: told how many trials have been replayed, and of how many.

    Raises:
        UsageError: there is nothing to show, or no such robot or reproduction.
    """
    result = _reproduction(store, session)
    name, runs, trials, left_out = _life(store, robot, session, result)
    tools = [
        LearnedRows(run, {row.id: row.row for row in store.learning.rows(run.id)}) for run in runs
    ]
    replays, not_replayed = [], {}
    for number, trial in enumerate(trials, 1):
        # What this affcli cannot do again is said on the page, and the rest is shown.
        try:
            replays.append(replay_trial(store, trial.id))
        except AffcliError as error:
            not_replayed[trial.id] = str(error)
        done(number, len(trials))
    versions = runs[-1].versions
    return Content(
        database=one_line(store.path.name),
        robot=name,
        reproduction=result,
        tools=tools,
        replays=replays,
        not_replayed=not_replayed,
        left_out=left_out,
        broken=_broken(tools, replays),
        versions={one_line(name): one_line(version) for name, version in versions.items()},
    )


def _reproduction(store: Store, session: int | None) -> Reproduction | None:
    """Return what the robots of a reproduction gave; of the latest with robots, None without."""
    saved = {s.id: store.sessions.saved_robots(s.id) for s in store.sessions.all("reproduce")}
    robots = {number: len(some) for number, some in saved.items() if some}
    if session is None and not robots:
        return None
    number = max(robots) if session is None else session
    if number not in robots:
        known = ", ".join(map(str, robots)) or "none"
        raise UsageError(f"session {session} is no reproduction with robots; there are: {known}")
    return reproduction_of(store, number, robots[number])


def _life(
    store: Store, robot: int | None, session: int | None, result: Reproduction | None
) -> tuple[str, Sequence[LearningRunInfo], Sequence[TrialInfo], int]:
    """Return who is to be shown: the name, what it learned, its trials, how many are left out."""
    latest = _latest_runs(store)
    if latest and robot is None and session is None:
        every = [t for run in latest for t in store.trials.trials(run_id=run.id)]
        trials = _latest(every, [run.id for run in latest])
        seeds = sorted({run.spec.seed for run in latest})
        name = f"the robot of seed {', '.join(map(str, seeds))}"
        return name, latest, trials, len(every) - len(trials)
    if result is None:
        where = one_line(store.path)
        if robot is not None:
            raise UsageError(f"no robot {robot} in {where}: there is no reproduction in it")
        begun = [str(run.id) for run in store.learning.runs(status="running")]
        if begun:
            raise UsageError(
                f"nothing learned in {where} yet: run {', '.join(begun)} is not finished; go on "
                "with the command that began it"
            )
        raise UsageError(f"nothing learned in {where}; first run: affcli learn --tool t-hook")
    number = robot or 0
    of = result.session
    runs = [r for r in store.learning.runs(session_id=of.id) if r.spec.robot == number]
    if not runs:
        raise UsageError(
            f"no robot {number} in session {of.id}; they are numbered 0 to {result.robots - 1}"
        )
    name = f"robot {number} of {result.robots}, seed {of.spec.seed}"
    of_robot = [t for run in runs for t in store.trials.trials(run_id=run.id)]
    return name, runs, sorted(of_robot, key=lambda t: t.id), 0


def _latest_runs(store: Store) -> list[LearningRunInfo]:
    """Return the latest finished learning run of each tool, the paper's tools first."""
    learned = dict.fromkeys(run.spec.tool for run in store.learning.runs(status="done"))
    tools = dict.fromkeys([*(tool for tool in TOOLS if tool in learned), *learned])
    return [run for run in map(store.learning.latest, tools) if run is not None]


def _latest(trials: Iterable[TrialInfo], runs: Sequence[int]) -> list[TrialInfo]:
    """Return the latest trial of each kind: by run, goal and start, whole tools first.

    Of the trials with a whole tool those of `solve`, which go on with the counters as they are,
    come before those that `break-tool` does beside the broken ones.
    """
    by_kind: dict[tuple[object, ...], TrialInfo] = {}
    for trial in sorted(trials, key=lambda t: (t.spec.counters is Counters.STORED, t.id)):
        spec = trial.spec
        kind = (spec.protocol, spec.tool, spec.shape, spec.task.task_set, spec.goal, spec.start)
        by_kind[(*kind, str(spec.planner), spec.sensor)] = trial
    goals = in_order(trial.spec.goal for trial in by_kind.values())
    starts = in_order(trial.spec.start for trial in by_kind.values())

    def place(trial: TrialInfo) -> tuple[object, ...]:
        spec = trial.spec
        which = (runs.index(trial.run_id), goals.index(spec.goal), starts.index(spec.start))
        return (spec.shape != spec.tool, *which, trial.id)

    return sorted(by_kind.values(), key=place)


def _broken(tools: Iterable[LearnedRows], replays: Iterable[Replay]) -> list[Broken]:
    """Return each tool that became another shape, with the trials that tell what came of it.

    Trials at other tasks, with another planner or through another sensor stand for themselves.
    """
    learned = {one.run.id: one for one in tools}
    adapted: dict[tuple[object, ...], list[Replay]] = {}
    for replay in replays:
        spec = replay.spec
        if spec.shape != spec.tool and is_counted(replay.outcome):
            by = replay.run_id, spec.shape, spec.task.task_set, str(spec.planner), spec.sensor
            adapted.setdefault(by, []).append(replay)
    return [Broken(learned[trials[0].run_id], trials) for trials in adapted.values()]
