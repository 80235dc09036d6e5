"""The robot tests the table that the store holds, and may update it (§3.1, §8)."""

from collections.abc import Callable, Iterator
from contextlib import nullcontext
from itertools import islice

from affcli.analysis.regions import region_of
from affcli.analysis.verification import JudgedTry
from affcli.core.affordance_table import AffordanceTable
from affcli.core.observation import SensorKind
from affcli.core.records import LearningRunInfo
from affcli.core.specs import LearningSpec, VerificationSpec
from affcli.core.tool import Tool
from affcli.core.trial import Truth
from affcli.core.verification import Evidence, ReplicationRecord, Verdict
from affcli.errors import UsageError
from affcli.lab.run_parts import world_of
from affcli.lab.versions import versions
from affcli.procedures.verification import verify as verify_rows
from affcli.store import Store


def verification_spec(
    run: LearningRunInfo,
    held: Tool,
    seed: int,
    sensor: SensorKind | None,
    tries: int | None,
    *,
    until_verdict: bool,
) -> VerificationSpec:
    """Return which verification is meant.

    Args:
        run: the learning run whose table is tested.
        held: the tool that the robot truly holds.
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
    many = run.rows if tries is None else tries
    kind = sensor or run.spec.sensor
    return VerificationSpec(
        run.spec.tool, held, seed, run.spec.robot, kind, many, until_verdict=until_verdict
    )


def replications(
    spec: VerificationSpec, learned: LearningSpec, table: AffordanceTable
) -> Iterator[tuple[ReplicationRecord, Truth | None]]:
    """Run one verification; the table's counters change as it goes.

    How often the rows were used before is part of its random streams: the same seed gives a table
    that was updated meanwhile other places, not the same experience twice.

    Args:
        spec: which verification.
        learned: how the table was learned.
        table: what the robot learned of `spec.tool`.
    """
    uses = int(table.times_used.sum())
    setting = world_of(learned).verification(spec, learned, uses)
    records = verify_rows(
        setting.robot,
        setting.sensor,
        setting.experimenter,
        table,
        setting.binding,
        setting.choices,
    )
    evidence = Evidence()
    for record in islice(records, spec.tries):
        yield record, setting.truth()
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
) -> Iterator[JudgedTry]:
    """Try the rows of a stored table again, from the counters as they are in the store.

    Args:
        store: open; for writing when the table is updated.
        run: the learning run whose table is tested.
        spec: which verification.
        now: gives the time as ISO text.
        update: save the tries together with the counters they changed, all in one transaction
            when the last is done; others who use the table wait. Without it nothing is written.

    Yields:
        Each try.
    """
    world = world_of(run.spec)
    # A camera that is not there, or cannot be calibrated, is found before anything is recorded.
    calibration = world.verification(spec, run.spec, 0).calibration
    with store.turn() if update else nullcontext():
        table, ids = store.learning.table(run.id)
        began, done = now(), []
        for record, truth in replications(spec, run.spec, table):
            row_id = ids[record.row.step]
            done.append((record, truth, row_id))
            yield JudgedTry(record, row_id, region_of(run.spec.held, record.row))
        if update:
            made_with = versions(world, spec.sensor)
            store.verifications.save(run.id, spec, done, made_with, began, now(), calibration)
