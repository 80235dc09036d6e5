"""Gathering what the page shows: one robot's tools and trials, and what many robots gave."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from affcli.config import differences, settings_from_json
from affcli.core.replay import Replay
from affcli.core.tool import TOOL_PARTS
from affcli.core.trial import Counters
from affcli.errors import UsageError, one_line
from affcli.lab.bench import missing_side, tool_named
from affcli.lab.overview import reproduction_of
from affcli.lab.plausible import check_rows, check_trial, not_written
from affcli.lab.replaying import replay_trial
from affcli.report.page.content import Broken, Content, LearnedRows
from affcli.report.reproduction import Reproduction
from affcli.store import LearningRunInfo, SessionInfo, Store, TrialInfo


@dataclass(frozen=True, slots=True)
class _Life:
    """One robot: what it learned and which of its trials are shown."""

    name: str
    runs: list[LearningRunInfo]
    trials: list[TrialInfo]
    left_out: int


def content_of(
    store: Store,
    robot: int | None = None,
    session: int | None = None,
    done: Callable[[int, int], None] = lambda _, __: None,
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
    life = _life(store, robot, session, result)
    tools = [_learned(store, run) for run in life.runs]
    replays = []
    for number, trial in enumerate(life.trials, 1):
        replays.append(replay_trial(store, trial.id))
        done(number, len(life.trials))
    return Content(
        database=one_line(store.path.name),
        robot=life.name,
        reproduction=result,
        tools=tools,
        replays=replays,
        left_out=life.left_out,
        broken=_broken(store, replays),
        versions={
            one_line(name): one_line(version) for name, version in life.runs[-1].versions.items()
        },
    )


def _reproduction(store: Store, session: int | None) -> Reproduction | None:
    """Return what the robots of a reproduction gave; of the latest with robots, None without."""
    found = _session(store, session)
    if found is None:
        return None
    robots = store.saved_robots(found.id)
    # They are saved in the order of their numbers.
    if robots != set(range(len(robots))):
        raise not_written(f"session {found.id}")
    return reproduction_of(store, found.id, len(robots))


def _session(store: Store, session: int | None) -> SessionInfo | None:
    """Return a reproduction that has robots; the latest for None."""
    sessions = [s for s in store.sessions("reproduce") if store.saved_robots(s.id)]
    if session is None:
        return sessions[-1] if sessions else None
    found = [s for s in sessions if s.id == session]
    if not found:
        known = ", ".join(str(s.id) for s in sessions) or "none"
        raise UsageError(f"session {session} is no reproduction with robots; there are: {known}")
    return found[0]


def _life(
    store: Store, robot: int | None, session: int | None, result: Reproduction | None
) -> _Life:
    """Return the robot that is to be shown."""
    latest = [run for run in map(store.latest_run, TOOL_PARTS) if run is not None]
    if latest and robot is None and session is None:
        every = [t for run in latest for t in store.trials(run_id=run.id)]
        trials = _latest(every)
        seeds = sorted({run.spec.seed for run in latest})
        name = f"the robot of seed {', '.join(map(str, seeds))}"
        return _Life(name, latest, trials, len(every) - len(trials))
    if result is None:
        where = one_line(store.path)
        if robot is not None:
            raise UsageError(f"no robot {robot} in {where}: there is no reproduction in it")
        begun = [str(run.id) for run in store.learning_runs(status="running")]
        if begun:
            raise UsageError(
                f"nothing learned in {where} yet: run {', '.join(begun)} is not finished; go on "
                "with the command that began it"
            )
        raise UsageError(f"nothing learned in {where}; first run: affcli learn --tool t-hook")
    number = robot or 0
    runs = [r for r in store.learning_runs(session_id=result.session) if r.spec.robot == number]
    if not runs:
        raise UsageError(
            f"no robot {number} in session {result.session}; they are numbered 0 to "
            f"{result.robots - 1}"
        )
    name = f"robot {number} of {result.robots}, seed {result.seed}"
    of_robot = [t for run in runs for t in store.trials(run_id=run.id)]
    return _Life(name, runs, sorted(of_robot, key=lambda t: t.id), 0)


def _latest(trials: Iterable[TrialInfo]) -> list[TrialInfo]:
    """Return the latest trial of each kind, in the order of the paper's table.

    Of the trials with a whole tool those of `solve`, which go on with the counters as they are,
    come before those that `break-tool` does beside the broken ones.
    """
    by_kind: dict[tuple[object, ...], TrialInfo] = {}
    for trial in sorted(trials, key=lambda t: (t.spec.counters is Counters.STORED, t.id)):
        spec = trial.spec
        by_kind[spec.protocol, spec.tool, spec.shape, spec.goal, spec.start] = trial
    tools = list(TOOL_PARTS)

    def place(trial: TrialInfo) -> tuple[int, ...]:
        spec = trial.spec
        check_trial(trial.id, spec)
        return (spec.shape != spec.tool, tools.index(spec.tool), spec.goal, spec.start)  # type: ignore[arg-type]

    return sorted(by_kind.values(), key=place)


def _broken(store: Store, replays: Iterable[Replay]) -> list[Broken]:
    """Return each tool that became another shape, with the trials that tell what came of it."""
    adapted: dict[tuple[int, str], list[Replay]] = {}
    for replay in replays:
        if replay.spec.shape != replay.spec.tool and replay.end is not None:
            adapted.setdefault((replay.run_id, replay.spec.shape), []).append(replay)
    found = []
    for (run, shape), trials in adapted.items():
        settings = settings_from_json(store.learning_run(run).spec.settings)
        tool = trials[0].spec.tool
        found.append(
            Broken(
                tool_named(settings, tool),
                tool_named(settings, shape),
                missing_side(settings, tool, shape),
                {row.id: row.row for row in store.affordances(run)},
                trials,
            )
        )
    return found


def _learned(store: Store, run: LearningRunInfo) -> LearnedRows:
    """Return what one learning run left."""
    settings = settings_from_json(run.spec.settings)
    if run.spec.tool not in TOOL_PARTS:
        raise not_written(f"learning run {run.id}")
    rows = {row.id: row.row for row in store.affordances(run.id)}
    check_rows(run.id, settings, rows.values())
    return LearnedRows(
        run=run.id,
        tool=tool_named(settings, run.spec.tool),
        seed=run.spec.seed,
        robot=run.spec.robot,
        behaviors=run.behaviors,
        resets=run.resets,
        robot_seconds=run.robot_seconds,
        settings=differences(settings),
        rows=rows,
    )
