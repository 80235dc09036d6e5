"""A tool that breaks: the robot does not know, and adapts (§7.2)."""

from collections.abc import Callable, Iterator

from affcli import registry
from affcli.core.identity import Component
from affcli.core.observation import SensorKind
from affcli.core.records import LearningRunInfo
from affcli.core.specs import Protocol, TrialRecord
from affcli.core.tool import Tool
from affcli.lab.believing import require_own
from affcli.lab.run_parts import tasks_of, world_of
from affcli.lab.solving import session_spec
from affcli.lab.trials import trial_specs, whole_trial
from affcli.lab.versions import versions
from affcli.store import Store


def break_tool(
    store: Store,
    run: LearningRunInfo,
    left: Tool,
    seed: int,
    now: Callable[[], str],
    planner: Component,
    sensor: SensorKind | None = None,
    task_set: str = registry.DEFAULTS["task"],
) -> Iterator[tuple[int, TrialRecord, float]]:
    """Do the trials with the broken tool, and the same ones with the whole one beside them.

    Each trial starts from the table as learned and keeps its counters in its own steps; the stored
    table stays as it is.

    Args:
        store: open for writing.
        run: the learning run whose table is used.
        left: the tool that is left; it takes the colour of the one that was learned, so the robot
            is not told.
        seed: of the sensor's noise.
        now: gives the time as ISO text.
        planner: how the robot chooses rows.
        sensor: through what it sees; None for what it learned with.
        task_set: which tasks.

    Yields:
        Each trial with its number in the store, once it is saved, and the share that is done; the
        broken tool's first.

    Raises:
        UsageError: there are no such tasks.
        BadInputError: a part that this affcli lacks.
    """
    learned = run.spec
    world, kind = world_of(learned), sensor or learned.sensor
    tasks = tasks_of(world, task_set, seed)
    table, ids = store.learning.table(run.id, as_learned=True)
    lost = world.lost_rows(learned, left, store.learning.row_starts(run.id))
    planned = [
        (trial_specs(protocol, learned, held, tasks, seed, kind, planner, world), judge)
        for protocol, held, judge in (
            (Protocol.TOOL_ADAPTATION, left, lost),
            (Protocol.EXTENSION_OF_REACH, learned.held, None),
        )
    ]
    first = planned[0][0][0]
    # A planner or a camera that is not there is found before anything is recorded.
    require_own(planner)
    registry.planner(planner)
    _ = world.trial(first, learned).calibration
    spec = session_spec("break-tool", run, first)
    session = store.sessions.begin(spec, versions(world, kind), now())
    judged = [(trial, judge) for specs, judge in planned for trial in specs]
    for done, (trial, judge) in enumerate(judged, 1):
        record = whole_trial(trial, learned, table, world, judge)
        (number,) = store.trials.save_all(session, run.id, [record], ids)
        yield number, record, done / len(judged)
    store.sessions.finish(session, now())
