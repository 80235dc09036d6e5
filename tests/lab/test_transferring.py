"""Carrying over to a new tool: saved by value, the same after a kill, in whole lives; and what is
refused (§8).
"""

import json
import re
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from affcli import registry
from affcli.behaviors.moving import EXTEND_ARM
from affcli.config import Settings, settings_with
from affcli.core import transfer
from affcli.core.identity import Component
from affcli.core.mask import Mask
from affcli.core.records import LearningRunInfo
from affcli.core.specs import TOLD, LearningSpec
from affcli.core.transfer import Borrowing, Transfer
from affcli.errors import AffcliError, BadInputError, DatabaseError, NotSeenError, UsageError
from affcli.lab.breaking import break_tool
from affcli.lab.choosing import learned_runs
from affcli.lab.conducting import begin, run
from affcli.lab.definition import experiment_of
from affcli.lab.learning import begun, interrupted, learn
from affcli.lab.replaying import replay_borrowing, replay_run, replay_trial
from affcli.lab.run_parts import RunParts, world_of
from affcli.lab.transferring import lenders_gone, mask_of, transfer_from, whence
from affcli.lab.verifying import replications, verification_spec
from affcli.store import Store, check, merge, open_store, run_sql
from tests.lab.quick import altered, now

MINUTES = 8.0
NEW = "garden-rake"
PARTS = RunParts.chosen(Settings())


def new_tool(store: Store, text: str, minutes: float = 0.0, tool: str = NEW) -> LearningSpec:
    """Return a run that borrows."""
    spec = PARTS.spec(tool, 3, 0, minutes / 60.0)
    return replace(spec, transfer=transfer_from(store, text))


def made_with_a_camera(store: Store, sql: str) -> list[bool]:
    """Return whether versions that are stored name the packages by which a camera sees."""
    versions = (json.loads(str(versions)).keys() for (versions,) in run_sql(store.path, sql).rows)
    return [{"opencv-python-headless", "scipy"} <= one for one in versions]


@pytest.fixture
def lenders(store: Store) -> tuple[LearningRunInfo, ...]:
    """Runs 1 and 2, with two of the paper's tools."""
    specs = (PARTS.spec(tool, 3, 0, MINUTES / 60.0) for tool in ("t-hook", "l-stick"))
    return tuple(learn(store, spec, now).info for spec in specs)


@pytest.mark.usefixtures("lenders")
def test_a_run_of_no_time_holds_what_it_borrowed_and_nothing_else(store: Store) -> None:
    told: list[str] = []
    begun(store, new_tool(store, "1,2"), now, None, told.append)
    info = learn(store, new_tool(store, "2, 1"), now).info
    assert told == [
        "run 1: took the mask of its t-hook by its spec; it is kept from now on",
        "run 2: took the mask of its l-stick by its spec; it is kept from now on",
    ]
    borrowed = store.transfers.of_run(info.id)
    assert (info.status, info.behaviors, info.robot_seconds) == ("done", 0, 0.0)
    assert [one.row.step for one in borrowed] == list(range(1 - info.rows, 1))
    assert {one.tool for one in borrowed} == {"t-hook", "l-stick"}
    table, _ = store.learning.table(info.id)
    assert tuple(table) == tuple(one.row for one in borrowed)
    rows = {stored.row.step: stored for stored in store.learning.rows(1)}
    for stored in store.learning.rows(info.id):
        found = whence(store, stored)
        assert found is not None
        one, lender = found
        assert lender == {"t-hook": 1, "l-stick": 2}[one.tool]
        if lender == 1:
            old, new = rows[one.step].row, stored.row
            assert abs(new.expected_movement.dx) == pytest.approx(abs(old.expected_movement.dx))
            assert new.expected_movement.dy == pytest.approx(old.expected_movement.dy)
    assert whence(store, rows[min(rows)]) is None
    assert made_with_a_camera(store, "select versions from learning_run") == [False, False, True]
    assert not any(found.wrong for found in check(store.path))


@pytest.mark.usefixtures("lenders")
def test_borrowed_rows_replicate_when_they_are_tried(store: Store) -> None:
    info = learn(store, new_tool(store, "1,2"), now).info
    spec = verification_spec(info, info.spec.held, 0, None, None, until_verdict=False)
    table, _ = store.learning.table(info.id)
    tries = [record.replicated for record, _ in replications(spec, info.spec, table)]
    assert len(tries) == info.rows
    assert sum(tries) >= 0.8 * info.rows


@pytest.mark.usefixtures("lenders")
def test_with_minutes_it_babbles_too_and_a_kill_changes_nothing(store: Store) -> None:
    """What it borrows is there from its beginning, and stays when a lender goes."""
    whole = learn(store, new_tool(store, "1,2", MINUTES), now).info
    borrowed = store.transfers.of_run(whole.id)
    own = [stored.row for stored in store.learning.rows(whole.id) if not stored.row.is_borrowed]
    assert own
    assert whole.rows == len(borrowed) + len(own)
    alone = learn(store, PARTS.spec(NEW, 3, 0, MINUTES / 60.0), now).info
    assert [stored.row for stored in store.learning.rows(alone.id)] == own
    assert [one for one in replay_run(store, whole, last=5) if one.differences] == []

    spec = new_tool(store, "1,2", 2.0 * MINUTES)
    started = begun(store, spec, now)
    assert (started.status, started.rows) == ("running", len(borrowed))
    assert lenders_gone(store, spec) == ""
    store.runs.delete(2)
    assert lenders_gone(store, spec) == (
        f"the {NEW}: 1 of the runs that it borrowed from was deleted; it goes on with the rows "
        "that it has"
    )
    (again,) = interrupted(store)
    assert again == spec
    done = learn(store, again, now).info
    assert store.transfers.of_run(done.id) == borrowed
    stored = next(one for one in store.learning.rows(done.id) if one.row.is_borrowed)
    assert whence(store, stored) is not None
    assert not any(found.wrong for found in check(store.path))
    with pytest.raises(UsageError, match="borrows from was deleted; name others: --transfer-from"):
        learn(store, replace(spec, seed=9), now)


@pytest.mark.usefixtures("lenders")
def test_what_was_borrowed_is_borrowed_again_and_held_against_the_record(store: Store) -> None:
    info = learn(store, new_tool(store, "1,2"), now).info
    assert replay_borrowing(store, info) == (info.rows, ())
    altered(
        store.path, "update affordance set movement = 99 where learning_run_id = 3 and step = 0"
    )
    altered(store.path, "update borrowed set shift_x = 99 where learning_run_id = 3 and step = 0")
    count, found = replay_borrowing(store, info)
    assert (count, [(one.number, one.column) for one in found]) == (
        info.rows,
        [(0, "movement"), (0, "shift_x")],
    )
    altered(store.path, "update learning_run set kept = 'trials' where id = 3")
    with pytest.raises(UsageError, match="run 3: its rows were not kept"):
        replay_borrowing(store, info)
    store.runs.delete(2)
    assert replay_borrowing(store, info) == (None, ())


@pytest.mark.usefixtures("lenders")
def test_a_tool_whose_rows_were_borrowed_can_break(store: Store) -> None:
    """Where a borrowed row was made is where it says, for nobody made it with this tool: what
    pushes away with the half that is gone is lost, and nothing that does so with the other.
    """
    info = learn(store, new_tool(store, "1,2"), now).info
    right = info.spec.held.without(["left bar", "left outer tine", "left inner tine"])
    lost = world_of(info.spec).lost_rows(info.spec, right, store.learning.row_starts(info.id))
    assert lost is not None
    pushing = [r.row for r in store.learning.rows(info.id) if r.row.exploratory.name == EXTEND_ARM]
    to_the_left = [row.start.wrist_to_object.x < -1.0 for row in pushing]
    assert [lost.lost(row) for row in pushing] == to_the_left
    assert 5 < sum(to_the_left) < len(pushing) - 5
    broken = next(break_tool(store, info, right, 0, now, Component("nested-query")))
    assert replay_trial(store, broken[0]).differences == ()


def test_a_mask_is_a_function_of_the_spec(store: Store) -> None:
    """And near what the tool is, though a camera saw it."""
    spec = PARTS.spec("longer-handle", 7, 0, 1.0)
    mask = mask_of(spec)
    assert mask == mask_of(replace(spec, hours=2.0, sensor="exact"))
    assert mask != mask_of(replace(spec, robot=1))
    store.learning.begin(spec, {}, now())
    assert store.transfers.mask(1) is None
    store.transfers.save_mask(1, mask)
    store.transfers.save_mask(1, mask.mirrored())
    assert store.transfers.mask(1) == mask
    with store.database.writing() as connection:
        connection.exec_driver_sql("UPDATE mask SET scale = 0.2")
    with pytest.raises(DatabaseError, match="the mask of learning run 1 holds a value that"):
        store.transfers.mask(1)
    x, y = np.meshgrid(0.1 * np.arange(-80, 80) + 0.05, 0.1 * np.arange(30, 200) + 0.05)
    inside = np.zeros(x.shape, dtype=bool)
    for left, near, right, far in (outline.bounds for outline in spec.held.outlines):
        inside |= (x >= left) & (x <= right) & (y >= near) & (y <= far)
    differing = mask.window(-80, 30, 160, 170) ^ inside.T
    assert differing.sum() * 0.01 < 1.5


def test_a_tool_that_is_not_in_view_has_no_mask() -> None:
    settings = settings_with({"camera": {"y": 44.0}, "tools": {"handle_length": 40.0}}, "a test")
    spec = RunParts.chosen(settings).spec("t-hook", 0, 0, 1.0)
    with pytest.raises(NotSeenError, match="does not see all of the t-hook"):
        mask_of(spec)


@pytest.mark.parametrize("name", registry.parts("tools"))
def test_the_camera_tells_each_tool_from_all_else(name: str) -> None:
    mask = mask_of(PARTS.spec(name, 1, 0, 1.0))
    assert isinstance(mask, Mask)
    assert mask.grid.sum() > 1000  # ten square inches


@pytest.mark.parametrize(
    ("text", "error", "says"),
    [
        ("", BadInputError, "--transfer-from : not of the form NAME,NAME:key=value,key=value"),
        ("1,,2", BadInputError, "--transfer-from 1,,2: not of the form"),
        ("1:limit", BadInputError, "--transfer-from 1:limit: not of the form"),
        ("t-hook", BadInputError, "--transfer-from t-hook: name runs by their numbers"),
        ("0", BadInputError, "--transfer-from 0: runs are numbered from 1"),
        ("9" * 18, UsageError, "no learning run 999999999999999999; they are numbered 1 to 3"),
        ("1:wide=3", BadInputError, "1:wide=3: no parameter wide; it has way, radius, limit"),
        ("1:limit=-1", BadInputError, "1:limit=-1: limit = -1.0 must lie in [0, 100] (in^2)"),
        ("1:way=near", BadInputError, "way = near must be one of local, whole"),
        ("3", UsageError, "--transfer-from: run 3 is not finished; go on with it first"),
        ("4", UsageError, "run 4 made no rows of its own with the stick; name another"),
        (
            "1:radius=20,limit=0,each=9",
            UsageError,
            "or allow more: --transfer-from 1:radius=20,limit=0.2,each=9",
        ),
    ],
)
@pytest.mark.usefixtures("lenders")
def test_what_cannot_be_borrowed_is_refused_in_one_line(
    store: Store, text: str, error: type[AffcliError], says: str
) -> None:
    store.learning.begin(PARTS.spec("stick", 3, 0, 1.0), {}, now())
    if text == "4":
        learn(store, PARTS.spec("stick", 3, 0, None, 1), now)
    before = run_sql(store.path, "select count(*) from learning_run").rows
    with pytest.raises(error, match=re.escape(says)) as told:
        learn(store, new_tool(store, text, tool="fork"), now)
    assert "\n" not in str(told.value)
    assert run_sql(store.path, "select count(*) from learning_run").rows == before


def test_a_tool_borrows_from_others_not_from_itself(store: Store) -> None:
    """Whoever learned with it; another shape under its name is another tool."""
    learn(store, PARTS.spec("l-stick", 7, 0, MINUTES / 60.0), now)
    with pytest.raises(UsageError) as told:
        learn(store, new_tool(store, "1", tool="l-stick"), now)
    assert str(told.value) == (
        "--transfer-from: run 1 was learned with the l-stick itself: a tool borrows from others; "
        "name another run, or let it learn for longer"
    )
    assert run_sql(store.path, "select count(*) from learning_run").rows == ((1,),)
    borrows = new_tool(store, "1", tool="l-stick")
    altered = replace(borrows, held=replace(borrows.held, parts=PARTS.tool("l-hook").parts))
    assert learn(store, altered, now).info.rows > 0


def test_a_table_that_was_told_lends_nothing(store: Store) -> None:
    """What a baseline is told, no robot may know."""
    spec = PARTS.spec("t-hook", 3, 0, None, 1)
    spec = replace(spec, explorer=Component.of(TOLD, {"friction": 0, "spacing": 2}))
    told = store.learning.begin(spec, {}, now())
    assert store.learning.append(told.id, 0, (), None, 0.0, done=True, now=now())
    with pytest.raises(UsageError, match="run 1 is no robot's: its table was computed; name one"):
        learn(store, new_tool(store, "1"), now)
    with pytest.raises(UsageError, match=r"^run 1 is no robot's: its table was computed"):
        learned_runs(store, None, 1, usable=True)
    assert learned_runs(store, None, 1)


@pytest.mark.parametrize(
    ("other", "what"),
    [
        ({"puck": {"mass": 0.2}}, "other settings"),
        ({}, "another repertoire"),
    ],
)
@pytest.mark.usefixtures("lenders")
def test_a_lender_must_be_of_the_same_kind(
    store: Store, other: dict[str, dict[str, float]], what: str
) -> None:
    settings = settings_with(other, "a test")
    parts = RunParts.chosen(settings, repertoire=["paper"] if other else ["extend-arm"])
    spec = replace(parts.spec(NEW, 3, 0, 0.0), transfer=transfer_from(store, "1"))
    with pytest.raises(UsageError, match=f"run 1 has {what} than this run; borrow from one"):
        learn(store, spec, now)


LIFE = """
[experiment]
name = "new"
robots = 2
seed = 5
tasks = ["extension-of-reach"]
[base]
tools = ["fork", "t-hook"]
minutes = 8
trial.max_steps = 3
[[condition]]
name = "scratch"
[[condition]]
name = "carried over"
transfer = "t-hook, l-stick:minutes=8,each=20"
minutes = 0
[[condition]]
name = "adapting"
transfer = "l-stick,t-hook:minutes=8,each=20"
minutes = 1
tasks = ["extension-of-reach", "adaptation"]
"""


def lived(path: Path, robots: Sequence[int] | None = None) -> None:
    """Let robots live in a database of their own."""
    experiment = experiment_of(tomllib.loads(LIFE), "a test")
    assert experiment_of(experiment.definition, "the stored form").key == experiment.key
    with open_store(path, create=True, write=True) as store:
        info = begin(store, experiment, now)
        assert list(run(store, experiment, info, 1, now, robots=robots))


@pytest.fixture(scope="module")
def two_lives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database in which two robots lived."""
    path = tmp_path_factory.mktemp("lives") / "whole.db"
    lived(path)
    return path


def test_the_robots_of_a_condition_borrow_from_what_each_learned(two_lives: Path) -> None:
    """None lends to itself; what lends is learned once, and all of it is in the database."""
    with open_store(two_lives, create=False, write=False) as store:
        for session, minutes in ((2, 0.0), (3, 1.0)):
            runs = store.learning.runs(session_id=session)
            borrowers = [one for one in runs if one.spec.transfer is not None]
            assert [(one.spec.tool, one.spec.robot) for one in borrowers] == [
                *(("fork", 0), ("t-hook", 0), ("fork", 1), ("t-hook", 1))
            ]
            for one in borrowers:
                assert one.spec.hours == pytest.approx(minutes / 60.0)
                borrowed = store.transfers.of_run(one.id)
                lenders = {"fork": {"t-hook", "l-stick"}, "t-hook": {"l-stick"}}[one.spec.tool]
                assert {row.tool for row in borrowed} == lenders
                there = store.transfers.lenders(sorted({row.lender for row in borrowed}))
                seen = {n: store.learning.run(n).spec for n in there.values()}
                assert {spec.robot for spec in seen.values()} == {one.spec.robot}
                assert store.transfers.mask(one.id) is not None
                assert all(store.transfers.mask(number) is not None for number in seen)
        learned = "select tool, count(*) from learning_run where transfer is null group by tool"
        assert run_sql(two_lives, learned).rows == (("fork", 2), ("l-stick", 2), ("t-hook", 2))
        used = made_with_a_camera(store, "select versions from session order by id")
        assert used == [False, True, True]
        trial = store.trials.trials(session_id=2)[0]
        assert replay_trial(store, trial.id).differences == ()
    assert not any(found.wrong for found in check(two_lives))


def test_the_tools_that_lend_are_in_the_key_by_value() -> None:
    """As those that are learned: a lender of other sizes makes it another experiment."""
    life = experiment_of(tomllib.loads(LIFE), "a test")
    lending = life.conditions[1].canonical()["transfer"]
    assert lending["tools"] == [PARTS.tool(name).canonical() for name in ("t-hook", "l-stick")]
    assert (lending["minutes"], lending["borrowing"]) == (8.0, {"each": 20})
    assert "transfer" not in life.conditions[0].canonical()


def test_a_default_that_changes_changes_no_stored_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if the limit had been 0.9 at first."""
    keys = ("0" * 64,)
    assert Transfer(keys, Borrowing()).canonical() == {"lenders": [*keys], "borrowing": {}}
    monkeypatch.setitem(transfer.CHANGED, "limit", (0.9,))
    old = Transfer.from_canonical({"lenders": [*keys], "borrowing": {"each": 9}})
    assert old == Transfer(keys, Borrowing(limit=0.9, each=9))
    assert old.canonical()["borrowing"] == {"each": 9}
    new = Transfer(keys, Borrowing())
    assert new.canonical()["borrowing"] == {"limit": 0.3}
    assert Transfer.from_canonical(new.canonical()) == new
    assert (str(new), str(old)) == ("1 run", "1 run:limit=0.9,each=9")


def test_no_time_is_one_time_however_it_is_written() -> None:
    """And so it is one experiment."""
    keys = {
        experiment_of(tomllib.loads(LIFE.replace("minutes = 0", said)), "a test").key
        for said in ("minutes = 0", "minutes = -0.0", "hours = 0.0")
    }
    assert len(keys) == 1


def test_robots_that_borrowed_are_brought_together_whole(two_lives: Path, tmp_path: Path) -> None:
    merged, parts = tmp_path / "merged.db", [tmp_path / f"{n}.db" for n in (0, 1)]
    for robot, path in enumerate(parts):
        lived(path, [robot])
    assert merge(parts, merged, now()).new == 2
    for counted in (
        "select count(*), sum(lender_step), sum(shift_x) from borrowed",
        "select count(*), sum(columns), sum(red) from mask",
    ):
        assert run_sql(merged, counted).rows == run_sql(two_lives, counted).rows
    assert not any(found.wrong for found in check(merged))


@pytest.mark.parametrize(
    ("said", "says"),
    [
        ('transfer = "t-hok"', "did you mean t-hook"),
        ('transfer = "t-hook,t-hook"', "a tool comes twice"),
        ('transfer = "t-hook:minutes=0"', "minutes = 0 must be more than 0"),
        ('transfer = "t-hook:limit=x"', "limit = x must be a number in [0, 100] (in^2)"),
        ('transfer = "t-hook"', "the t-hook has none to borrow from"),
        ("transfer = 3", "what is borrowed must be a line"),
        ("minutes = 0", "hours: 0 must be more than 0 where robots borrow nothing"),
        ('transfer = "stick"\nplanner = "oracle"', "oracle is told its table; leave it out"),
    ],
)
def test_what_an_experiment_cannot_borrow_is_refused(said: str, says: str) -> None:
    text = f'[experiment]\nname = "one"\nrobots = 1\n[base]\ntools = ["t-hook", "fork"]\n{said}\n'
    with pytest.raises(BadInputError, match=re.escape(says)) as told:
        experiment_of(tomllib.loads(text), "a test")
    assert "\n" not in str(told.value)
