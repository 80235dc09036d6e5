"""Conditions read from a store: what their robots solved, compared, planned with and followed."""

import json
import math
from statistics import fmean

import pytest
import sqlalchemy as sa

from affcli.analysis.paired import summed
from affcli.analysis.power import Untold
from affcli.core.records import FailedRobot
from affcli.core.results import Cell
from affcli.core.trial import Outcome
from affcli.errors import UsageError
from affcli.lab.conditions import compared, counts_of, planned, sessions_named
from affcli.lab.courses import curves_of
from affcli.report.paired import comparison_tables
from affcli.store import Store
from affcli.store.columns import COLUMNS
from affcli.store.connection import insert_one
from affcli.store.tables import experiment, learning_run, session, trial
from tests.store.conditions import SECOND, stored_conditions
from tests.store.records import NOW, begun

REACH, ADAPTATION, TASKS = "extension of reach", "tool adaptation", "extension-of-reach"
ALL = Cell(REACH, TASKS)
STICK, HOOK = (Cell(REACH, TASKS, tool, tool, "1") for tool in ("stick", "t-hook"))
BROKEN = Cell(ADAPTATION, TASKS, "t-hook", "l-hook", "1")


def test_what_each_robot_solved_of_each_cell(store: Store) -> None:
    (first, *_) = sessions_named(store, stored_conditions(store))
    counts = counts_of(store, first).cells
    assert counts[STICK._replace(start="2")] == {r: (1, int(r >= SECOND)) for r in range(8)}
    by_goal = summed(counts, ("tool", "shape", "goal"))
    assert list(by_goal) == [STICK, HOOK, BROKEN]
    assert by_goal[STICK] == {r: (2, 1 if r < SECOND else 2) for r in range(8)}
    assert by_goal[HOOK] == dict.fromkeys(range(8), (2, 1))
    assert by_goal[BROKEN] == dict.fromkeys(range(8), (1, 1))
    by_start = summed(counts, ("start",))
    assert by_start[ALL._replace(start="2")] == {r: (2, int(r >= SECOND)) for r in range(8)}
    assert list(summed(counts)) == [ALL, Cell(ADAPTATION, TASKS)]


def test_robots_that_failed_are_in_no_pair_and_named(store: Store) -> None:
    conditions = sessions_named(store, stored_conditions(store))
    first = conditions[0].session.id
    for robot in (8, 9):
        store.sessions.save_failure(first, FailedRobot(robot, "ValueError", "no", 3), NOW)
    result = compared(store, conditions, None, ["tool"])
    assert (result.against.failed, result.others[0].failed) == ((8, 9), ())
    notes = str(comparison_tables(result)[-1].caption)
    assert f"failed, so in no pair: 2 robots of {conditions[0].name}: 8 to 9" in notes


def test_robots_of_any_number_are_counted(store: Store) -> None:
    """SQLite gives no value of more than some bytes here: not the numbers of all robots."""
    first, _ = stored_conditions(store, robots=2, conditions=2)
    before = store.results.solved_by_cell(first, ["tool"])
    names = ", ".join(name for name in COLUMNS["trial"] if name not in ("id", "robot"))
    with store.database.writing() as connection:
        connection.exec_driver_sql(
            "WITH RECURSIVE n(robot) AS (SELECT 2 UNION ALL SELECT robot + 1 FROM n "
            f"WHERE robot < 24999) INSERT INTO trial (robot, {names}) SELECT n.robot, {names} "
            f"FROM n, trial WHERE trial.robot = 1 AND session_id = {first}"
        )
    cells = store.results.solved_by_cell(first, ["tool"])
    assert list(cells) == list(before)
    for cell, counts in cells.items():
        assert list(counts) == list(range(25_000))
        assert counts[0] == before[cell][0]
        assert {counts[robot] for robot in range(1, 25_000)} == {before[cell][1]}


def test_robots_are_compared_with_the_first_condition_or_with_one_that_is_named(
    store: Store,
) -> None:
    conditions = sessions_named(store, stored_conditions(store))
    result = compared(store, conditions, None, ("tool",))
    assert [other.name for other in result.others] == ["session 2", "session 3"]
    (one,) = result.cells
    assert (one.condition, one.cell) == ("session 2", STICK._replace(goal=""))
    assert (one.mean, one.better, one.worse) == (SECOND / 8, SECOND, 0)
    assert one.p == 2 * 0.5**SECOND
    assert result.left_out == {"session 2": (8,), "session 3": (8, 9)}
    again = compared(store, conditions, "session 2", ("tool",))
    assert again.against.name == "session 2"
    assert [(d.condition, d.worse) for d in again.cells] == [("session 1", 4), ("session 3", 4)]
    with pytest.raises(UsageError, match="no condition 'session 9'; did you mean session"):
        compared(store, conditions, "session 9", ("tool",))


def test_sessions_have_the_names_that_their_experiment_gives_them_told_apart_by_their_minutes(
    store: Store,
) -> None:
    ids = stored_conditions(store)
    with store.database.writing() as connection:
        one, other = (
            insert_one(
                connection,
                experiment,
                {"name": name, "question": "", "key": "k", "versions": "{}"}
                | {"status": "done", "started_at": NOW, "definition": '{"condition": []}'},
            )
            for name in "ef"
        )
        named = ((one, "paper"), (one, "rough"), (other, "rough"))
        for own, (number, name) in zip(ids, named, strict=True):
            part = {"experiment_id": number, "condition": name, "kind": "experiment"}
            connection.execute(sa.update(session).filter_by(id=own).values(**part))
    names = [one.name for one in sessions_named(store, ids)]
    assert names == ["paper", "rough (session 2)", "rough (session 3)"]
    assert [one.name for one in sessions_named(store, ids[:2])] == ["paper", "rough"]
    for number, hours in ((one, 1.0), (other, 0.25)):
        said = {"name": "rough", "hours": hours, "repertoire": []}
        with store.database.writing() as connection:
            definition = json.dumps({"condition": [said]})
            connection.execute(
                sa.update(experiment).filter_by(id=number).values(definition=definition)
            )
    names = [one.name for one in sessions_named(store, ids)]
    assert names == ["paper", "rough, minutes=60", "rough, minutes=15"]
    assert [one.name for one in sessions_named(store, ids[:2])] == ["paper", "rough"]
    store.sessions.save_failure(ids[0], FailedRobot(8, "ValueError", "no", 3), NOW)
    assert [one.robots for one in sessions_named(store, ids)] == [7, 8, 10]


def test_a_robot_with_an_invalid_trial_is_left_out_where_it_was(store: Store) -> None:
    conditions = sessions_named(store, stored_conditions(store, conditions=2))
    with store.database.writing() as connection:
        invalid = sa.update(trial).where(trial.c.id == 1).values(outcome="invalid")
        connection.execute(invalid)
    counts = summed(counts_of(store, conditions[0]).cells, ("tool", "shape"))[
        STICK._replace(goal="")
    ]
    assert (counts[0], counts[1]) == ((1, 0), (2, 1))
    result = compared(store, conditions, None, ("tool",))
    assert result.left_out == {"session 2": (0, 8)}
    assert [one.robots for one in (*result.totals, *result.cells)] == [7, 8, 7]


def test_what_cannot_be_compared_is_named(store: Store) -> None:
    first, second = stored_conditions(store, 2, conditions=2)
    elsewhere = begun(store, "reproduce", seed=8)
    store.sessions.finish(elsewhere, "2026-01-02T03:04:05+00:00")
    with pytest.raises(UsageError, match="no robot in common: they are of seeds 7 and 8"):
        compared(store, sessions_named(store, [first, elsewhere]), None, ())
    with pytest.raises(UsageError, match="--session 1: named twice"):
        sessions_named(store, [first, first, second])
    with pytest.raises(UsageError, match="--session 2: named twice"):
        sessions_named(store, [first, second, second])
    with pytest.raises(UsageError, match="no session 99; they are numbered 1 to 3"):
        sessions_named(store, [first, 99])
    solving = begun(store, "solve")
    with pytest.raises(UsageError, match="is of affcli solve, not of reproduce"):
        sessions_named(store, [first, solving])
    unfinished = begun(store, "reproduce", seed=9)
    with pytest.raises(UsageError, match="is not finished"):
        sessions_named(store, [first, unfinished])


def test_a_condition_without_a_trial_that_counts_says_why(store: Store) -> None:
    conditions = sessions_named(store, stored_conditions(store, 2, conditions=2))
    first = conditions[0].session.id
    assert store.results.invalid(first) == (0, "")
    of_first = sa.update(trial).where(trial.c.session_id == first)
    with store.database.writing() as connection:
        connection.execute(of_first.values(outcome=Outcome.INVALID.value, last_reasons=None))
    found = store.results.invalid(first)
    assert found.why == "the simulation gave a number that is not finite"
    assert found.trials == len(store.trials.trials(session_id=first))
    for chosen in (conditions, conditions[:1]):
        with pytest.raises(UsageError) as refused:
            planned(store, chosen, (), (1.0,), 0.0, 0.8)
        assert str(refused.value) == (
            f"session 1 has no trial that counts: all {found.trials} are invalid ({found.why}): "
            "what is stored stays; repair that, and take another --db"
        )


def test_robots_needed_are_told_from_pairs_or_from_one_condition(store: Store) -> None:
    conditions = sessions_named(store, stored_conditions(store))
    plans, untold = planned(store, conditions[:2], ("tool",), (1.0,), 0.0, 0.8)
    assert [(one.cell, one.robots) for one in plans] == [(ALL, 8), (STICK._replace(goal=""), 8)]
    assert [one.level for one in plans] == [0.05 / 2, 0.05 / 3]
    assert Untold(Cell(ADAPTATION, TASKS), "too few robots differ") in untold
    assert plans[0].spread == pytest.approx(0.5345, abs=1e-4)
    (alone, *_), _ = planned(store, conditions[:1], ("protocol",), (1.0,), 0.5, 0.8)
    assert alone.spread == pytest.approx(0.5345, abs=1e-4)
    (apart, *_), _ = planned(store, conditions[:1], ("protocol",), (1.0,), 0.0, 0.8)
    assert (apart.needed[1.0] or 0) > (alone.needed[1.0] or 0)


def test_plans_are_of_the_trials_that_both_conditions_have(store: Store) -> None:
    conditions = sessions_named(store, stored_conditions(store, conditions=2))
    plans, _ = planned(store, conditions, ("start",), (1.0,), 0.0, 0.8)
    with store.database.writing() as connection:
        of_one = (trial.c.session_id == conditions[0].session.id, trial.c.tool == "t-hook")
        connection.execute(sa.update(trial).where(*of_one).values(tool="l-stick"))
    after, untold = planned(store, conditions, ("start",), (1.0,), 0.0, 0.8)
    (total, _), (before, _) = after, plans
    assert (total.cell, total.spread) == (before.cell, before.spread)  # the hook tells nothing
    apart = [one.cell.tool for one in untold if one.why == "not in both"]
    assert apart == ["l-stick", "", "t-hook"]
    four = sessions_named(store, stored_conditions(store, 4, conditions=2))
    assert planned(store, four, (), (1.0,), 0.0, 0.8)[0] == []
    whys = {one.why for one in planned(store, four, (), (1.0,), 0.0, 0.8)[1]}
    assert whys == {"fewer than 5 robots"}


def test_a_setting_that_differs_is_the_axis_of_the_curve(store: Store) -> None:
    conditions = sessions_named(store, stored_conditions(store))
    found = curves_of(store, conditions, "solved", None)
    assert (found.x, found.y) == ("sensor.position_noise (in)", "solved trials")
    reach, broken = found.lines
    assert (reach.panel, broken.panel) == (f"{REACH}, of 4", f"{ADAPTATION}, of 1")
    assert [point.x for point in reach.points] == [0.008, 0.06, 0.25]
    assert [point.mean for point in reach.points] == [2.5, 3.0, 2.6]
    assert [point.robots for point in reach.points] == [8, 9, 10]
    assert curves_of(store, conditions, "solved", "sensor.position_noise") == found
    (rows,) = curves_of(store, conditions, "rows", "sensor.position_noise").lines
    assert [point.mean for point in rows.points] == [20.0] * 3


def test_what_trials_took_and_how_far_their_steps_went_astray(store: Store) -> None:
    (first, *_) = sessions_named(store, stored_conditions(store))
    number = first.session.id
    took = {name: store.results.means_of_trials(number, name) for name in ("steps", "seconds")}
    astray = store.results.means_of_trials(number, "error")
    for cell in (ALL, Cell(ADAPTATION, TASKS)):
        own = [
            one
            for one in store.trials.trials()
            if one.session_id == number and one.spec.protocol == cell.protocol
        ]
        for robot in range(8):
            mine = [one for one in own if one.spec.robot == robot]
            won = [one for one in mine if one.outcome is Outcome.SOLVED]
            assert took["steps"][cell][robot] == fmean(one.steps or 0 for one in won)
            seconds = fmean(one.robot_seconds or 0.0 for one in won)
            assert took["seconds"][cell][robot] == pytest.approx(seconds)
            apart = [
                math.dist((use.seen.dx, use.seen.dy), (use.expected.dx, use.expected.dy))
                for one in mine
                for use in store.trials.steps(one.id)
            ]
            assert astray[cell][robot] == pytest.approx(fmean(apart))
    of_hook = store.results.means_of_trials(number, "steps", ["t-hook"])
    assert of_hook.keys() == took["steps"].keys()
    lines = curves_of(store, [first], "error", "minutes").lines
    assert [line.panel for line in lines] == [REACH, ADAPTATION]
    assert lines[0].points[0].robots == 8


def test_courses_follow_robots_over_minutes_or_rows(store: Store) -> None:
    conditions = sessions_named(store, stored_conditions(store))
    for x in ("minutes", "rows"):
        for y in ("rows", "share"):
            found = curves_of(store, conditions, y, x)
            assert [line.name for line in found.lines] == ["session 1", "session 2", "session 3"]
            for line in found.lines:
                xs = [point.x for point in line.points]
                assert xs == sorted(xs)
                assert len(xs) > 10
                assert all(0.0 <= p.mean <= (1.0 if y == "share" else 20.0) for p in line.points)
    lines = curves_of(store, conditions, "solved", "rows").lines
    assert [line.name for line in lines[::2]] == ["session 1", "session 2", "session 3"]
    assert [[point.x for point in line.points] for line in lines] == [[20.0]] * 6


def test_conditions_that_differ_in_how_long_robots_learn_share_a_line(store: Store) -> None:
    one, two, three = sessions_named(store, stored_conditions(store))
    with store.database.writing() as connection:
        longer = sa.update(learning_run).values(robot_seconds=learning_run.c.robot_seconds * 2.0)
        connection.execute(longer.where(learning_run.c.session_id == two.session.id))
    names = ("a, minutes=5", "a, minutes=10", "b, minutes=5")
    conditions = [c._replace(name=n) for c, n in zip((one, two, three), names, strict=True)]
    lines = curves_of(store, conditions, "solved", "minutes").lines
    found = [(line.name, line.course, [point.x for point in line.points]) for line in lines[::2]]
    assert found == [("a", True, [5.25, 10.5]), ("b", False, [5.25])]
    (of_stick, *_) = curves_of(store, conditions, "solved", "minutes", ["stick"]).lines
    assert of_stick.panel == f"{REACH}, of 2"
    assert [point.mean for point in of_stick.points] == [1.5, 2.0]
    again = [*conditions, three._replace(name="a, hours=1")]
    with pytest.raises(UsageError, match=r"a, hours=1: .* learned as long"):
        curves_of(store, again, "solved", "minutes")
    with pytest.raises(UsageError, match="no trials with"):
        curves_of(store, conditions, "solved", "minutes", ["l-hook"])


def test_a_grid_has_a_line_for_each_condition_beside_the_sweep(store: Store) -> None:
    (one, two, three) = sessions_named(store, stored_conditions(store))
    x = "sensor.position_noise"
    grid = [
        condition._replace(name=f"{name}position_noise={value}")
        for name, value, condition in (("a, ", 1, one), ("a, ", 2, two), ("b, ", 2, two))
    ]
    lines = curves_of(store, grid, "solved", x).lines
    found = [(line.name, [point.x for point in line.points]) for line in lines[::2]]
    assert found == [("a", [0.008, 0.06]), ("b", [0.06])]
    with pytest.raises(UsageError, match=f"{x} is .* in more than one condition"):
        curves_of(store, [one, three, three._replace(name="again")], "solved", x)


def test_a_value_that_several_conditions_have_is_named(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tests.store.conditions.NOISE", (None, 0.25, 0.25))
    conditions = sessions_named(store, stored_conditions(store, 1))
    with pytest.raises(UsageError) as refused:
        curves_of(store, conditions, "solved", "sensor.position_noise")
    assert str(refused.value) == (
        "sensor.position_noise is 0.25 in more than one condition; it differs: no other setting "
        "does"
    )


@pytest.mark.parametrize(
    ("y", "x", "refusal"),
    [
        ("height", None, "no measure 'height'"),
        ("solved", "sensor.positon_noise", "no axis .*; did you mean sensor.position_noise"),
        ("solved", "trial.max_steps", "is 60 in more than one condition; it differs: sensor.pos"),
        ("solved", "sensor.kind", "sensor.kind is no number"),
    ],
)
def test_what_a_curve_cannot_show_is_named(
    store: Store, y: str, x: str | None, refusal: str
) -> None:
    conditions = sessions_named(store, stored_conditions(store, 1))
    with pytest.raises(UsageError, match=refusal):
        curves_of(store, conditions, y, x)
