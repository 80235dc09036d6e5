"""The robot tests the table in the store: verdicts, counters, and what is recorded (§3.1, §8)."""

from dataclasses import replace
from itertools import islice

import pytest

from affcli.analysis.regions import region_of
from affcli.analysis.verification import JudgedTry
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.records import LearningRunInfo
from affcli.core.specs import VerificationSpec
from affcli.core.verification import Evidence, ReplicationRecord, Verdict
from affcli.errors import DatabaseError, UsageError
from affcli.lab.run_parts import RunParts
from affcli.lab.verifying import replications, verification_spec, verify
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import Store, check, open_store, run_sql
from tests import factories
from tests.factories import EXACT, tool_named
from tests.lab.parts import SILENT, register
from tests.lab.quick import IMPATIENT, learned, now, solving, spec_of, stored, table_from


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return stored(store, spec_of("t-hook", 400, settings=IMPATIENT))


def spec_for(
    run: LearningRunInfo,
    shape: str = "t-hook",
    tries: int | None = None,
    seed: int = 0,
    *,
    until_verdict: bool = False,
) -> VerificationSpec:
    held = tool_named(shape)
    return verification_spec(run, held, seed, None, tries, until_verdict=until_verdict)


def verified(store: Store, run: LearningRunInfo, spec: VerificationSpec) -> list[JudgedTry]:
    """Verify and update; return all tries."""
    return list(verify(store, run, spec, now, update=True))


def records_of(tries: list[JudgedTry]) -> list[ReplicationRecord]:
    return [one.record for one in tries]


def rows_of(store: Store, run: LearningRunInfo) -> list[Affordance]:
    return list(store.learning.table(run.id)[0])


def simulated(tool: str, shape: str) -> list[ReplicationRecord]:
    """Try every row of a table once, without a store and without noise."""
    run = spec_of(tool, 400, settings=EXACT)
    table = table_from(learned(run))
    spec = factories.verification_spec(run, held=tool_named(shape), tries=len(table))
    return [record for record, _ in replications(spec, run, table)]


@pytest.mark.parametrize("tool", sorted(TOOL_PARTS))
def test_what_an_intact_tool_afforded_it_affords_anywhere_on_the_table(tool: str) -> None:
    """Without noise. What fails all the same hardly touched the attractor, or met a corner."""
    records = simulated(tool, tool)
    failed = [record for record in records if not record.replicated]
    assert len(failed) <= 0.03 * len(records)
    assert Evidence.of(records).verdict in {Verdict.HOLDS, Verdict.UNDECIDED}
    assert all(record.execution is not None for record in records)


@pytest.mark.parametrize("tool", ["stick", "t-hook"])
def test_tries_without_noise_stand_to_the_tool_as_their_rows_did(tool: str) -> None:
    for record in simulated(tool, tool):
        assert record.start.wrist_to_object == pytest.approx(
            record.row.start.wrist_to_object, abs=1e-5
        )
        assert record.execution is not None
        assert record.execution.call == record.row.exploratory


def test_rows_of_lost_parts_fail_and_those_of_kept_parts_replicate() -> None:
    whole = tool_named("t-hook")
    left: list[bool] = []
    right: list[bool] = []
    for record in simulated("t-hook", "l-hook"):
        part = region_of(whole, record.row)
        if part != "handle":
            (left if part.startswith("left") else right).append(record.replicated)
    assert len(left) > 10
    assert len(right) > 10
    assert sum(left) >= 0.97 * len(left)
    assert sum(right) < 0.5 * len(right)


def test_a_broken_tool_is_found_out_and_then_the_table_holds_for_it(
    store: Store, run: LearningRunInfo
) -> None:
    """§3.1: inconsistencies "can be used to update the tool's representation"."""
    first = verified(store, run, spec_for(run, "l-hook"))
    assert Evidence.of(records_of(first)).verdict is Verdict.CHANGED
    dead = [row for row in rows_of(store, run) if row.replication_probability <= 0.5]
    assert len(dead) == sum(one.record.died for one in first)
    again = verified(store, run, spec_for(run, "l-hook"))
    assert Evidence.of(records_of(again)).failures <= 0.05 * len(again)
    assert sum(not one.record.live for one in again) == len(dead)
    stored = run_sql(store.path, "select verdict, shape, tries from verification order by id")
    second = Evidence.of(records_of(again)).verdict
    assert stored.rows == (
        ("tool has changed", "l-hook", len(first)),
        (second.value, "l-hook", len(again)),
    )


def test_it_ends_with_the_first_verdict_if_asked_to(store: Store, run: LearningRunInfo) -> None:
    spec = spec_for(run, "l-hook", 500, until_verdict=True)
    tries = list(verify(store, run, spec, now, update=False))
    records = records_of(tries)
    assert Evidence.of(records).verdict is Verdict.CHANGED
    assert Evidence.of(records[:-1]).verdict is Verdict.UNDECIDED
    assert len(records) < 100


def test_every_row_is_tried_once_unless_told_how_many(store: Store, run: LearningRunInfo) -> None:
    tries = list(verify(store, run, spec_for(run), now, update=False))
    assert sorted(one.affordance_id for one in tries) == sorted(
        store.learning.table(run.id)[1].values()
    )
    for many in (1, 7, 2 * run.rows + 3):
        some = list(verify(store, run, spec_for(run, tries=many), now, update=False))
        assert len(some) == many


def test_stored_counters_are_those_of_steps_and_tries_together(
    store: Store, run: LearningRunInfo
) -> None:
    list(solving(store, run, "2"))
    verified(store, run, spec_for(run, "l-hook", 90))
    list(solving(store, run, "4"))
    tries = verified(store, run, spec_for(run, tries=33))
    assert not any(finding.wrong for finding in check(store.path))
    used = sum(row.times_used - 1 for row in rows_of(store, run))
    ((steps, replications_kept),) = run_sql(
        store.path, "select (select count(*) from step), (select count(*) from replication)"
    ).rows
    assert isinstance(steps, int)
    assert replications_kept == 90 + len(tries)
    assert used == steps + replications_kept


def test_what_is_recorded_is_what_was_done(store: Store, run: LearningRunInfo) -> None:
    list(solving(store, run, "1", "2"))
    uses = sum(row.times_used for row in rows_of(store, run))
    tries = verified(store, run, spec_for(run, "l-hook", 40, seed=5))
    about = run_sql(
        store.path,
        "select learning_run_id, shape, seed, sensor, tries_wanted, until_verdict, uses_before,"
        " after_trial, tries, verdict, robot_seconds from verification",
    ).rows
    verdict = Evidence.of(records_of(tries)).verdict
    clock = tries[-1].record.clock
    assert about == ((run.id, "l-hook", 5, "noisy", 40, 0, uses, 1, 40, verdict.value, clock),)
    columns = (
        "affordance_id, clock, replicated, seen_dx, seen_dy, expected_dx, expected_dy,"
        " times_used_before, times_used_after, times_successful_before, times_successful_after,"
        " live, died, placing_status, start_object_x, end_object_y, wrist_start_x, wrist_end_y"
    )
    kept = run_sql(store.path, f"select {columns} from replication order by number").rows
    for row, (record, affordance_id, _) in zip(kept, tries, strict=True):
        moved = record.execution or record.placing
        assert row == (
            *(affordance_id, record.clock, record.replicated),
            *(record.seen.dx, record.seen.dy, record.expected.dx, record.expected.dy),
            *(record.row.times_used, record.times_used_after),
            *(record.row.times_successful, record.times_successful_after),
            *(record.live, record.live and record.died, record.placing.status.value),
            *(record.start.object_x, record.end.object_y),
            *(moved.wrist_start.x, moved.wrist_end.y),
        )


def test_true_places_lie_beside_those_seen(store: Store, run: LearningRunInfo) -> None:
    """For science, never for the robot: within five times the noise; any angle."""
    verified(store, run, spec_for(run, tries=60))
    ((off, low, high),) = run_sql(
        store.path,
        "select max(abs(true_start_x - start_object_x) + abs(true_end_y - end_object_y)),"
        " min(true_start_angle), max(true_start_angle) from replication",
    ).rows
    assert isinstance(off, float)
    assert 0.0 < off < 0.1
    assert (low, high) != (0.0, 0.0)


def test_without_update_nothing_is_written(store: Store, run: LearningRunInfo) -> None:
    before = store.path.read_bytes()
    with open_store(store.path, create=False, write=False) as reading:
        tries = list(verify(reading, run, spec_for(run, "l-hook"), now, update=False))
    assert Evidence.of(records_of(tries)).failures > 0
    assert store.path.read_bytes() == before


def test_a_verification_that_is_stopped_leaves_nothing(store: Store, run: LearningRunInfo) -> None:
    """Its tries and the counters that they changed are one whole."""
    running = verify(store, run, spec_for(run), now, update=True)
    assert len(list(islice(running, 5))) == 5
    running.close()  # type: ignore[attr-defined]  # it is a generator
    for table in ("verification", "replication"):
        assert run_sql(store.path, f"select count(*) from {table}").rows == ((0,),)
    assert not any(finding.wrong for finding in check(store.path))


def test_others_wait_until_a_verification_is_done(store: Store, run: LearningRunInfo) -> None:
    mine = verify(store, run, spec_for(run), now, update=True)
    next(mine)
    with open_store(store.path, create=False, write=False) as other:
        assert {row.times_used for row in other.learning.table(run.id)[0]} == {1}
    with (
        pytest.raises(DatabaseError, match="locked"),
        open_store(store.path, create=False, write=True, timeout=0.1) as other,
    ):
        verified(other, run, spec_for(run, seed=1))
    list(mine)
    with open_store(store.path, create=False, write=True) as other:
        verified(other, run, spec_for(run, seed=1))
    assert not any(finding.wrong for finding in check(store.path))


def test_the_same_table_and_seed_give_the_same_tries(store: Store, run: LearningRunInfo) -> None:
    def tries(seed: int) -> list[JudgedTry]:
        return list(verify(store, run, spec_for(run, tries=30, seed=seed), now, update=False))

    assert tries(4) == tries(4)
    assert records_of(tries(4)) != records_of(tries(5))


def test_the_same_seed_again_gives_an_updated_table_new_experience(
    store: Store, run: LearningRunInfo
) -> None:
    """Or the same pushes would be counted twice."""
    first = verified(store, run, spec_for(run, tries=30))
    second = verified(store, run, spec_for(run, tries=30))
    places = {one.record.start.object_position for one in first}
    assert not places & {one.record.start.object_position for one in second}


def test_counters_of_the_table_change_as_it_goes() -> None:
    run = spec_of("t-hook", 400, settings=IMPATIENT)
    table = table_from(learned(run))
    twin = AffordanceTable(list(table))
    spec = factories.verification_spec(run, held=tool_named("l-hook"), seed=3, tries=50)
    records = [record for record, _ in replications(spec, run, twin)]
    assert int(twin.times_used.sum()) == int(table.times_used.sum()) + 50
    successes = sum(record.replicated for record in records)
    assert int(twin.times_successful.sum()) == int(table.times_successful.sum()) + successes


def test_a_blank_table_cannot_be_verified(store: Store) -> None:
    blank = stored(store, spec_of("stick", 2, settings=IMPATIENT))
    blank = replace(blank, rows=0)
    with pytest.raises(UsageError, match=r"made no rows: there is nothing to verify"):
        spec_for(blank, "stick")


def test_the_sensor_is_that_of_learning_unless_told(store: Store) -> None:
    run, stick = stored(store, spec_of("stick", 60)), tool_named("stick")
    assert verification_spec(run, stick, 0, None, 1, until_verdict=False).sensor == "noisy"
    assert verification_spec(run, stick, 0, "exact", 1, until_verdict=False).sensor == "exact"


def test_regions_are_parts_of_the_tool_as_it_was_learned(
    store: Store, run: LearningRunInfo
) -> None:
    tries = list(verify(store, run, spec_for(run, "l-hook"), now, update=False))
    assert {one.region for one in tries} == {part.name for part in run.spec.held.parts}


def test_rows_of_another_grasp_are_tried_with_their_own() -> None:
    """The tool is grasped anew first; without noise what an intact tool afforded it affords."""
    parts = RunParts.chosen(EXACT, binding="grasp:grasp_point=4,angle=15")
    other = parts.spec("t-hook", 0, 0, None, 300)
    table = table_from(learned(other))
    run = replace(other, binding=spec_of().binding)
    spec = factories.verification_spec(run, tries=len(table))
    records = [record for record, _ in replications(spec, run, table)]
    assert [record.regrasped for record in records] == [True, *[False] * (len(records) - 1)]
    assert sum(record.replicated for record in records) >= 0.97 * len(records) > 10


def test_a_world_that_cannot_tell_is_verified_by_what_was_seen(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    register(monkeypatch, SILENT)
    parts = RunParts.chosen(IMPATIENT, world="silent")
    run = stored(store, parts.spec("t-hook", 0, 0, None, 300))
    tries = verified(store, run, spec_for(run, tries=20))
    assert any(one.record.replicated for one in tries)
    kept = "select count(*), count(true_start_x), count(true_end_angle) from replication"
    assert run_sql(store.path, kept).rows == ((20, 0, 0),)
