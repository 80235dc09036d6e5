"""The robot tests the table that the store holds, and may update it (§3.1, §8)."""

from collections.abc import Callable, Iterator
from itertools import islice

from affcli.config import Settings, settings_from_json, with_sensor
from affcli.core.affordance_table import AffordanceTable
from affcli.core.observation import SensorKind
from affcli.core.trial import Truth
from affcli.core.verification import (
    Evidence,
    ReplicationRecord,
    Verdict,
    VerificationSpec,
    decided_after,
)
from affcli.errors import UsageError
from affcli.lab.bench import VERIFICATION, Bench, stable_number, tool_named
from affcli.lab.plausible import learned_table
from affcli.lab.sensing import calibration_of
from affcli.lab.versions import versions
from affcli.procedures.verification import verify as verify_rows
from affcli.report.verification import Checked
from affcli.simulation.world import World
from affcli.store import LearningRunInfo, Store


def verification_spec(
    run: LearningRunInfo,
    shape: str,
    seed: int,
    sensor: SensorKind | None,
    tries: int | None,
    *,
    until_verdict: bool,
) -> VerificationSpec:
    """Return which verification is meant.

    Args:
        run: the learning run whose table is tested.
        shape: the shape that the robot truly holds.
        seed: of places, order and noise.
        sensor: through what the robot sees; None for what it learned with.
        tries: how many at most; None for as many as there are rows, so that each is tried once.
        until_verdict: end with the first verdict.

    Raises:
        UsageError: the table is blank.
    """
    if not run.rows:
        raise UsageError(
            f"run {run.id} of the {run.spec.tool} made no rows: there is nothing to verify; "
            "learn for longer"
        )
    kind = sensor or settings_from_json(run.spec.settings).sensor.kind
    many = run.rows if tries is None else tries
    return VerificationSpec(run.spec.tool, shape, seed, run.spec.robot, kind, many, until_verdict)


def replications(
    spec: VerificationSpec, settings: Settings, table: AffordanceTable
) -> Iterator[tuple[ReplicationRecord, Truth]]:
    """Run one verification; the table's counters change as it goes.

    How often the rows were used before is part of its random streams: the same seed gives a table
    that was updated meanwhile other places, not the same experience twice.

    Args:
        spec: which verification.
        settings: those of the learning run, but for the sensor, which `spec` names.
        table: what the robot learned of `spec.tool`.
    """
    settings = with_sensor(settings, spec.sensor)
    world = World(settings.workspace, settings.physics)
    names = (stable_number(spec.tool), stable_number(spec.shape))
    key = (VERIFICATION, spec.seed, spec.robot, *names, int(table.times_used.sum()))
    bench = Bench.of(settings, world, *key)
    believed = tool_named(settings, spec.tool)
    bench.experimenter.lay_out_verification(
        tool_named(settings, spec.shape).painted(believed.color)
    )
    records = verify_rows(
        bench.robot,
        bench.sensor,
        bench.experimenter,
        table,
        bench.behaviors.binding,
        bench.streams["choices"],
    )
    evidence = Evidence()
    for record in islice(records, spec.tries):
        yield record, bench.truth()
        evidence = evidence.after(record)
        if spec.until_verdict and evidence.verdict is not Verdict.UNDECIDED:
            return


def verify(
    store: Store,
    run: LearningRunInfo,
    spec: VerificationSpec,
    now: Callable[[], str],
    *,
    update: bool,
) -> Iterator[Checked]:
    """Try the rows of a stored table again, from the counters as they are in the store.

    Args:
        store: open; for writing when the table is updated.
        run: the learning run whose table is tested.
        spec: which verification.
        now: gives the time as ISO text.
        update: save each try together with the counters it changed, in one transaction; without
            it nothing is written.

    Yields:
        Each try; once it is saved, if it is.
    """
    settings = settings_from_json(run.spec.settings)
    # A camera that is not there, or cannot be calibrated, is found before anything is recorded.
    calibration = calibration_of(with_sensor(settings, spec.sensor), spec.seed, spec.robot)
    table, ids = learned_table(store, run, settings)
    learned = tool_named(settings, spec.tool)
    number = 0
    if update:
        made_with = versions(spec.sensor)
        number = store.begin_verification(run.id, spec, made_with, now(), calibration)
    done = []
    for record, truth in replications(spec, settings, table):
        row_id = ids[record.row.step]
        if update:
            store.save_replication(number, record, truth, row_id)
        done.append(record)
        nearest = learned.part_nearest(record.row.start.wrist_to_object)
        yield Checked(record, row_id, nearest.name)
    if update:
        store.end_verification(number, Evidence.of(done).verdict, decided_after(done), now())
