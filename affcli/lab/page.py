"""Reading what the page shows: some robots' tools and trials, and what many robots gave."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from affcli.analysis.experiment import ExperimentResult
from affcli.analysis.paper import TOOLS
from affcli.analysis.reproduction import Reproduction
from affcli.core.records import LearningRunInfo, SessionInfo, TrialInfo
from affcli.core.replay import Replay
from affcli.core.specs import EXPERIMENT, Counters, Keep
from affcli.core.trial import is_counted
from affcli.errors import AffcliError, UsageError, one_line
from affcli.lab.drawing import can_draw, require_figures
from affcli.lab.learning_curves import curves_of, curves_of_robots
from affcli.lab.overview import experiments_of, reproduction_of
from affcli.lab.predicting import predict, prediction_spec
from affcli.lab.replaying import replay_trial
from affcli.report import figures
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.report.words import in_order
from affcli.store import Store

MOST_ROBOTS = 5
"""So many robots of a reproduction, or runs of one tool, are on a page: a tool's rows take some
20 kB. Films, some 1 MB for a robot's 96 trials, are there only of robots that were asked for."""
PUSHES = 200
"""So many fresh pushes a table is asked about; half a second for each."""


@dataclass(frozen=True, slots=True)
class _Shown:
    """Who is to be shown.

    Args:
        name: whose trials can be replayed, in words.
        filmed, others: their learning runs, and those of others to choose from.
        trials, their_trials: of the former and of the latter.
        left_out: trials that are not shown, for later ones of their kind are.
        not_shown: robots that are not shown at all.
    """

    name: str
    filmed: Sequence[LearningRunInfo]
    others: Sequence[LearningRunInfo]
    trials: Sequence[TrialInfo]
    their_trials: Sequence[TrialInfo]
    left_out: int = 0
    not_shown: int = 0


def content_of(
    store: Store,
    robots: Sequence[int] = (),
    session: int | None = None,
    done: Callable[[int, int], object] = lambda _, __: None,
    runs: Sequence[int] = (),
) -> Content:
    """Return what the page shows.

    Args:
        store: open.
        robots: whose trials are replayed, of a reproduction; when none is named, those of the
            robot that learned by `learn`, if there is one, else of the first robot.
        session: which reproduction; None for the latest.
        done: told how many trials have been replayed, and of how many.
        runs: whose trials are replayed, of learning runs, instead of the latest one of each tool.

    Raises:
        UsageError: there is nothing to show, no such robot, run or reproduction; or too many.
    """
    if len(set(robots)) > MOST_ROBOTS:
        raise UsageError(f"--robot: of {MOST_ROBOTS} robots at most the films fit into a page")
    result = _reproduction(store, session)
    shown = _own(store, runs) if runs or not (robots or session) else None
    if shown is None:
        of = _session_of_experiment(store) if result is None else result.session
        shown = _of_many(store, robots, of)
    replays, not_replayed = [], {}
    for number, trial in enumerate(shown.trials, 1):
        # What this affcli cannot do again is said on the page, and the rest is shown.
        try:
            replays.append(replay_trial(store, trial.id))
        except AffcliError as error:
            not_replayed[trial.id] = str(error)
        done(number, len(shown.trials))
    tools = [_with_predictions(store, _learned(store, run)) for run in shown.filmed]
    others = [replace(_learned(store, run), filmed=False) for run in shown.others]
    every = [*shown.filmed, *shown.others]
    made = shown.filmed[-1] if shown.filmed else store.experiments.all()[-1]
    timed = [run for run in every if run.robot_seconds > 0.0]
    experiments = experiments_of(store)
    bands = (
        curves_of_robots(store, every[0].session_id)[1]
        if timed == every and every and every[0].session_id is not None
        else []
    )
    return Content(
        database=one_line(store.path.name),
        robot=shown.name,
        reproduction=result,
        tools=[*tools, *others],
        replays=replays,
        not_replayed=not_replayed,
        left_out=shown.left_out,
        broken=_broken(tools, replays),
        versions={one_line(k): one_line(v) for k, v in made.versions.items()},
        others=shown.their_trials,
        curves={curve.run.id: curve for curve in curves_of(store, timed)} if timed else {},
        bands={one.tool: one for one in bands},
        verifications=store.results.verifications(run.id for run in every),
        not_shown=shown.not_shown,
        experiments=experiments,
        drawn=_drawn(experiments),
    )


def _drawn(experiments: Iterable[ExperimentResult]) -> dict[str, bytes]:
    """Return the figure of each comparison; none where the packages for figures are not there."""
    if not can_draw():
        return {}
    require_figures()
    most = figures.compare.MOST_CONDITIONS
    return {
        one.name: figures.canvas.encoded(figures.compare.compare_figure(one.comparison), ".svg")
        for one in experiments
        if one.comparison is not None and len(one.comparison.others) <= most
    }


def _session_of_experiment(store: Store) -> SessionInfo | None:
    """Return the first condition of the latest experiment of whose robots all is kept."""
    sessions = {session.id: session for session in store.sessions.all(EXPERIMENT)}
    for one in reversed(store.experiments.all()):
        first = sessions[one.conditions[0][1]]
        if store.experiments.kept(one.id) is Keep.ALL:
            return first
    return None


def _reproduction(store: Store, session: int | None) -> Reproduction | None:
    """Return what the robots of a reproduction gave; of the latest with robots, None without."""
    every = (session.id for session in store.sessions.all("reproduce"))
    robots = [number for number in every if store.sessions.saved_robots(number)]
    if session is None and not robots:
        return None
    number = max(robots) if session is None else session
    if number not in robots:
        known = ", ".join(map(str, robots)) or "none"
        raise UsageError(f"session {session} is no reproduction with robots; there are: {known}")
    return reproduction_of(store, number)


def _own(store: Store, numbers: Sequence[int]) -> _Shown | None:
    """Return the learning runs asked for, or the latest of each tool, and others of these tools.

    None when none is asked for and nothing was learned by `learn`.
    """
    filmed = [store.learning.run(number) for number in dict.fromkeys(numbers)]
    for run in filmed:
        if run.status != "done":
            raise UsageError(f"run {run.id} is not finished; go on with it first: --resume")
    if len(filmed) > MOST_ROBOTS:
        raise UsageError(f"--run: of {MOST_ROBOTS} runs at most the films fit into a page")
    done = store.learning.runs(status="done")
    latest = {run.spec.tool: run for run in done}
    filmed = filmed or [latest[tool] for tool in dict.fromkeys([*TOOLS, *latest]) if tool in latest]
    if not filmed:
        return None
    ids, others = [run.id for run in filmed], []
    for tool in dict.fromkeys(run.spec.tool for run in filmed):
        room = MOST_ROBOTS - sum(run.spec.tool == tool for run in filmed)
        more = [run for run in reversed(done) if run.spec.tool == tool and run.id not in ids]
        others += more[:room]
    stored = [
        [trial for run in some for trial in store.trials.trials(run_id=run.id)]
        for some in (filmed, others)
    ]
    mine, theirs = _latest(stored[0], filmed), _latest(stored[1], others)
    names = list(dict.fromkeys(_robot(run) for run in filmed))
    own = all(run.session_id is None for run in filmed)
    whose = f"the robot{'s' if len(names) > 1 else ''} of " if own else ""
    return _Shown(
        *(whose + ", ".join(names), filmed, others, mine, theirs),
        left_out=sum(map(len, stored)) - len(mine) - len(theirs),
        not_shown=sum(run not in others and run.id not in ids for run in done),
    )


def _of_many(store: Store, robots: Sequence[int], of: SessionInfo | None) -> _Shown:
    """Return the robots of a session that were asked for, else its first, and some others."""
    if of is None:
        where = one_line(store.path)
        if robots:
            raise UsageError(f"no robot {robots[0]} in {where}: there is no reproduction in it")
        begun = [str(run.id) for run in store.learning.runs(status="running")]
        if begun:
            raise UsageError(
                f"nothing learned in {where} yet: run {', '.join(begun)} is not finished; go on "
                "with the command that began it"
            )
        if named := ", ".join(one_line(one.name) for one in experiments_of(store)):
            return _Shown(
                f"the results of {named}: what robots learned was not kept", (), (), (), ()
            )
        raise UsageError(f"nothing learned in {where}; first run: affcli learn --tool t-hook")
    runs: dict[int, list[LearningRunInfo]] = {}
    for run in store.learning.runs(session_id=of.id):
        runs.setdefault(run.spec.robot, []).append(run)
    asked = list(dict.fromkeys(robots)) or [min(runs)]
    for number in asked:
        if number not in runs:
            raise UsageError(
                f"no robot {number} in session {of.id}; they are numbered 0 to {max(runs)}"
            )
    more = [number for number in sorted(runs) if number not in asked][: MOST_ROBOTS - len(asked)]
    filmed, others = ([run for number in some for run in runs[number]] for some in (asked, more))
    # What other conditions did with the same tables is not of this one.
    others_did = {s.id for s in store.sessions.all(EXPERIMENT)} - {of.id}
    trials, theirs = (
        sorted(
            (
                trial
                for run in some
                for trial in store.trials.trials(run_id=run.id)
                if trial.session_id not in others_did
            ),
            key=lambda trial: trial.id,
        )
        for some in (filmed, others)
    )
    names = f"robot{'s' if len(asked) > 1 else ''} {', '.join(map(str, asked))}"
    under = "" if of.condition is None else f" under {one_line(of.condition)}"
    name = f"{names} of {len(runs)}{under}, seed {of.spec.seed}"
    return _Shown(
        name, filmed, others, trials, theirs, not_shown=len(runs) - len(asked) - len(more)
    )


def _robot(run: LearningRunInfo) -> str:
    """Return whose a learning run is, in words that tell it from the others of a page."""
    if run.spec.logged:
        return "a log"
    return f"seed {run.spec.seed}" if run.session_id is None else f"robot {run.spec.robot}"


def _learned(store: Store, run: LearningRunInfo) -> LearnedRows:
    """Return what a learning run left."""
    rows = {row.id: row.row for row in store.learning.rows(run.id)}
    return LearnedRows(run, rows, _robot(run))


def _with_predictions(store: Store, learned: LearnedRows) -> LearnedRows:
    """Return a table with what it says of fresh pushes; with the reason where that cannot be."""
    run = learned.run
    if run.spec.logged:
        return replace(learned, not_asked="it comes from a log: affcli predict asks of its trials")
    try:
        spec = prediction_spec(run, run.spec.held, 0, None, PUSHES)
        return replace(learned, pushes=list(predict(store, run, spec)))
    except AffcliError as error:
        return replace(learned, not_asked=str(error))


def _latest(trials: Iterable[TrialInfo], runs: Sequence[LearningRunInfo]) -> list[TrialInfo]:
    """Return the latest trial of each kind: by run, goal and start, whole tools first.

    Of the trials with a whole tool those of `solve`, which go on with the counters as they are,
    come before those that `break-tool` does beside the broken ones.
    """
    by_kind: dict[tuple[object, ...], TrialInfo] = {}
    for trial in sorted(trials, key=lambda t: (t.spec.counters is Counters.STORED, t.id)):
        spec = trial.spec
        kind = trial.run_id, spec.protocol, spec.shape, str(spec.planner), spec.sensor
        by_kind[(*kind, spec.task.task_set, spec.goal, spec.start)] = trial
    order = [run.id for run in runs]
    goals = in_order(trial.spec.goal for trial in by_kind.values())
    starts = in_order(trial.spec.start for trial in by_kind.values())

    def place(trial: TrialInfo) -> tuple[object, ...]:
        spec = trial.spec
        which = (order.index(trial.run_id), goals.index(spec.goal), starts.index(spec.start))
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
