"""A tool that breaks: the robot does not know, and adapts (§7.2)."""

from collections.abc import Callable, Iterator

from affcli.config import settings_from_json, with_sensor
from affcli.core.observation import SensorKind
from affcli.core.trial import Protocol, TrialRecord
from affcli.lab.plausible import check_starts, learned_table
from affcli.lab.sensing import calibration_of
from affcli.lab.trials import LostAffordances, trial_specs, whole_trial
from affcli.lab.versions import versions
from affcli.simulation.world import World
from affcli.store import LearningRunInfo, Store


def break_tool(
    store: Store,
    run: LearningRunInfo,
    shape: str,
    seed: int,
    now: Callable[[], str],
    sensor: SensorKind | None = None,
) -> Iterator[tuple[int, TrialRecord]]:
    """Do the 16 trials with the broken tool, and the same 16 with the whole one beside them.

    Each trial starts from the table as learned and keeps its counters in its own steps; the stored
    table stays as it is.

    Args:
        store: open for writing.
        run: the learning run whose table is used.
        shape: what is left of the tool; it keeps the tool's colour, so the robot is not told.
        seed: of the sensor's noise.
        now: gives the time as ISO text.
        sensor: through what the robot sees; None for what it learned with.

    Yields:
        Each trial with its number in the store, once it is saved; the broken tool's first.
    """
    settings = with_sensor(settings_from_json(run.spec.settings), sensor)
    # A camera that is not there, or cannot be calibrated, is found before anything is recorded.
    calibration_of(settings, seed, run.spec.robot)
    kind = settings.sensor.kind
    table, ids = learned_table(store, run, settings, as_learned=True)
    world = World(settings.workspace, settings.physics)
    starts = store.row_starts(run.id)
    check_starts(run.id, starts, table)
    lost = LostAffordances(settings, shape, starts)
    text = settings.to_json()
    session = store.begin_session("break-tool", seed, 1, text, versions(kind), now())
    tool, robot = run.spec.tool, run.spec.robot
    for protocol, held, judge in (
        (Protocol.TOOL_ADAPTATION, shape, lost),
        (Protocol.EXTENSION_OF_REACH, tool, None),
    ):
        for spec in trial_specs(protocol, tool, held, seed, robot, kind):
            trial = whole_trial(spec, settings, table, world, judge)
            (number,) = store.save_trials(session, run.id, [trial], ids)
            yield number, trial
    store.finish_session(session, now())
