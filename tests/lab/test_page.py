"""What the page gathers: which robot, which of its trials, and what is left out (§6, §7)."""

from html import escape
from itertools import islice
from pathlib import Path

import pytest

from affcli import registry
from affcli.analysis.breaking import missing_side
from affcli.analysis.prediction import scores
from affcli.core.identity import Component
from affcli.core.records import LearningRunInfo
from affcli.core.specs import Counters, Protocol
from affcli.core.trial import Outcome
from affcli.errors import DatabaseError, UsageError
from affcli.lab.overview import overview_of
from affcli.lab.page import PUSHES, content_of
from affcli.lab.predicting import predict, prediction_spec
from affcli.lab.reproduction import Reproduced, reproduce
from affcli.lab.run_parts import RunParts
from affcli.lab.verifying import verification_spec, verify
from affcli.report.page.content import Content
from affcli.report.page.rendering import render
from affcli.store import Store, open_store
from tests.lab.quick import (
    IMPATIENT,
    INTERRUPTED,
    LEISURELY,
    PLANNER,
    altered,
    breaking,
    counted,
    learned,
    now,
    reproducing,
    solving,
    spec_of,
    stored,
    table_from,
    taken,
)


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A run of the T-hook whose trials end soon."""
    return stored(store, spec_of(behaviors=400, settings=IMPATIENT))


def gathered(path: Path) -> Content:
    """Return the page's content of a database that was changed meanwhile."""
    with open_store(path, create=False, write=False) as again:
        return content_of(again)


def shown(content: Content) -> list[tuple[str, str, str]]:
    """Return shape, goal and start of the trials in their order."""
    return [(r.spec.shape, r.spec.goal, r.spec.start) for r in content.replays]


def test_a_robot_that_only_learned(store: Store, run: LearningRunInfo) -> None:
    content = content_of(store)
    assert content.robot == "the robot of seed 0"
    assert content.database == "lab.db"
    assert (content.replays, content.broken, content.left_out) == ([], [], 0)
    assert content.reproduction is None
    (tool,) = content.tools
    assert (tool.run.id, tool.run.spec.tool, tool.run.behaviors) == (run.id, "t-hook", 400)
    assert tool.rows == {row.id: row.row for row in store.learning.rows(run.id)}
    assert len(tool.rows) == run.rows
    assert "settings: trial.max_steps = 6" in render(content, "")
    assert "<h1>" in render(content, "")


def test_the_latest_trial_of_each_kind_in_the_order_of_the_paper_s_table(
    store: Store, run: LearningRunInfo
) -> None:
    stick = stored(store, spec_of("stick", behaviors=300, settings=IMPATIENT))
    counted(solving(store, run, "2", "2"))
    counted(solving(store, run, "2", "1"))
    counted(solving(store, [run, stick], "1", "3"))
    counted(solving(store, run, "2", "1", seed=5))
    content = content_of(store)
    assert shown(content) == [
        *(("stick", "1", "3"), ("t-hook", "1", "3")),
        *(("t-hook", "2", "1"), ("t-hook", "2", "2")),
    ]
    assert [replay.spec.seed for replay in content.replays] == [0, 0, 5, 0]
    assert content.left_out == 1
    assert [tool.run.spec.tool for tool in content.tools] == ["stick", "t-hook"]
    assert content.robot == "the robot of seed 0"


def test_trials_of_solve_come_before_those_of_break_tool(
    store: Store, run: LearningRunInfo
) -> None:
    """The latter do the whole tool's trials too, beside those with the broken one."""
    counted(solving(store, run, "2", "1"))
    counted(solving(store, run, "2", "2"))
    counted(breaking(store, run, "l-hook", 0))
    content = content_of(store)
    whole, adapted = content.replays[:16], content.replays[16:]
    assert [r.spec.shape for r in whole] == ["t-hook"] * 16
    assert [r.spec.shape for r in adapted] == ["l-hook"] * 16
    stored = [r for r in whole if r.spec.counters is Counters.STORED]
    assert [(r.spec.goal, r.spec.start) for r in stored] == [("2", "1"), ("2", "2")]
    assert content.left_out == 2
    (broken,) = content.broken
    spec = broken.trials[0].spec
    assert (spec.tool, spec.shape) == ("t-hook", "l-hook")
    assert missing_side(broken.learned.run.spec.held, spec.held) > 0
    assert list(broken.trials) == adapted
    assert broken.learned.rows == {row.id: row.row for row in store.learning.rows(run.id)}


def test_every_shape_that_a_tool_became_is_told_of(store: Store, run: LearningRunInfo) -> None:
    for shape in ("l-hook", "stick", "l-hook"):
        counted(breaking(store, run, shape, 0))
    content = content_of(store)
    assert sorted(broken.trials[0].spec.shape for broken in content.broken) == ["l-hook", "stick"]
    assert [len(broken.trials) for broken in content.broken] == [16, 16]
    assert len(content.replays) == 48
    assert content.left_out == 16 + 2 * 16
    page = render(content, "")
    assert page.count("that became the") == 2


def test_a_tool_that_broke_is_told_of_by_planner(store: Store, run: LearningRunInfo) -> None:
    """And by task set and sensor: trials of one kind say nothing of another."""
    other = Component.of("nested-query", {"share": 0.05})
    for planner in (PLANNER, other):
        counted(breaking(store, run, planner=planner))
    content = content_of(store)
    planners = [{str(t.spec.planner) for t in broken.trials} for broken in content.broken]
    assert sorted(planners, key=str) == [{"nested-query"}, {"nested-query:share=0.05"}]
    assert [len(broken.trials) for broken in content.broken] == [16, 16]
    said = render(content, "")
    assert "The t-hook that became the l-hook</h3>" in said
    assert "The t-hook that became the l-hook, nested-query:share=0.05</h3>" in said
    assert said.count("(paper: 16 of 16)") == 1


def test_the_latest_run_of_a_tool_is_shown_with_its_films_and_others_without(
    store: Store, run: LearningRunInfo
) -> None:
    counted(solving(store, run, "2", "1"))
    again = stored(store, spec_of(behaviors=400, seed=3, settings=IMPATIENT))
    content = content_of(store)
    assert [(tool.run.id, tool.filmed) for tool in content.tools] == [
        *((again.id, True), (run.id, False)),
    ]
    assert content.replays == []
    (listed,) = content.others
    assert content.left_out == 0
    assert (listed.run_id, listed.spec.goal, listed.spec.start) == (run.id, "2", "1")
    assert content.robot == "the robot of seed 3"
    # Trials of one kind of two runs do not stand for each other.
    counted(solving(store, run, "2", "1"))
    counted(solving(store, again, "2", "1"))
    both = content_of(store, runs=[run.id, again.id])
    assert [replay.run_id for replay in both.replays] == [run.id, again.id]
    assert both.left_out == 1
    listed = store.trials.trial(2)
    asked = content_of(store, runs=[run.id])
    assert [(tool.run.id, tool.filmed) for tool in asked.tools] == [
        *((run.id, True), (again.id, False)),
    ]
    assert [replay.trial_id for replay in asked.replays] == [listed.id]
    assert [trial.run_id for trial in asked.others] == [again.id]
    page = render(content, "")
    assert "<option>seed 3</option><option>seed 0</option>" in page
    assert "Films are here of the robot of seed 3" in page
    assert f'data-robot="seed 0" data-tool="t-hook" data-run="{run.id}"' in page
    assert page.count('class="filmed"') == 0


def test_at_most_five_robots_are_on_a_page(store: Store) -> None:
    """And it is said how many more there are."""
    for seed in range(7):
        stored(store, spec_of(behaviors=60, seed=seed, settings=IMPATIENT))
    content = content_of(store)
    assert [tool.run.id for tool in content.tools] == [7, 6, 5, 4, 3]
    assert content.not_shown == 2
    assert "2 more are in the database." in render(content, "")
    with pytest.raises(UsageError, match="--run: of 5 runs at most"):
        content_of(store, runs=range(1, 7))
    with pytest.raises(UsageError, match="--robot: of 5 robots at most"):
        content_of(store, robots=range(6))


def test_what_the_table_is_worth_is_on_the_page(store: Store, run: LearningRunInfo) -> None:
    """Fresh pushes predicted, a verification that was recorded, how learning went."""
    spec = verification_spec(run, run.spec.held, 0, None, 5, until_verdict=False)
    counted(verify(store, run, spec, now, update=True))
    content = content_of(store)
    (tool,) = content.tools
    fresh = prediction_spec(run, run.spec.held, 0, None, PUSHES)
    assert tool.pushes == list(predict(store, run, fresh))
    (found,) = content.verifications
    assert (found.run_id, found.tool, found.shape, found.verdict) == (
        *(run.id, "t-hook", "t-hook", "undecided"),
    )
    assert (found.live, found.decided_after) == (5, None)
    assert content.curves[run.id].rows[-1] == run.rows
    page = render(content, "")
    score = scores(tool.pushes)[-1]
    assert f"Of 200 fresh pushes with the t-hook, {score.moved} moved the puck" in page
    assert f"its table foretold {score.hits} of these" in page
    assert "the robot found: undecided" in page
    assert f"{run.rows} rows of 400 behaviors" in page


def test_a_table_without_rows_is_not_asked(store: Store) -> None:
    specs = (spec_of("stick", behaviors=1, seed=seed, settings=IMPATIENT) for seed in range(20))
    stored(store, next(spec for spec in specs if not table_from(learned(spec))))
    content = content_of(store)
    assert content.tools[0].pushes == ()
    assert "Run 1 not asked for predictions: run 1 of the stick made no rows" in render(content, "")


def test_a_run_that_is_still_learning_is_not_shown(store: Store) -> None:
    """With nothing else there is nothing to show, and the message says why."""
    begun = spec_of("stick", behaviors=300, settings=IMPATIENT)
    store.learning.begin(begun, {"affcli": "0"}, now())
    with pytest.raises(UsageError, match="run 1 is not finished; go on with the command that"):
        content_of(store)
    done = stored(store, spec_of(behaviors=60, settings=IMPATIENT))
    assert [tool.run.id for tool in content_of(store).tools] == [done.id]


def test_an_interrupted_trial_is_shown_as_far_as_it_came(
    store: Store, run: LearningRunInfo
) -> None:
    counted(solving(store, run, "1", "1"))
    altered(store.path, *INTERRUPTED)
    content = gathered(store.path)
    (replay,) = content.replays
    assert (replay.end, len(replay.steps), replay.differences) == (None, 2, ())
    page = render(content, "")
    assert "<td>interrupted</td><td>2</td>" in page
    assert "no trial of this one counts yet" in page


def test_an_interrupted_trial_with_a_broken_tool_tells_nothing_of_it(
    store: Store, run: LearningRunInfo
) -> None:
    counted(islice(breaking(store, run, "l-hook", 0), 3))
    altered(store.path, "UPDATE trial SET outcome = NULL WHERE id = 3")
    content = gathered(store.path)
    assert len(content.replays) == 3
    adapted = [r for r in content.replays if r.spec.protocol is Protocol.TOOL_ADAPTATION]
    ended = [r for r in adapted if r.end is not None]
    assert len(ended) == len(adapted) - 1
    assert [list(broken.trials) for broken in content.broken] == [ended]
    assert "interrupted" in render(content, "")


def test_while_trials_are_replayed_it_is_said_how_many_are(
    store: Store, run: LearningRunInfo
) -> None:
    counted(solving(store, run, "2", "1"))
    counted(solving(store, run, "2", "2"))
    counted(solving(store, run, "2", "3"))
    said: list[tuple[int, int]] = []
    content_of(store, done=lambda done, trials: said.append((done, trials)))
    assert said == [(1, 3), (2, 3), (3, 3)]


@pytest.fixture
def reproduced(store: Store) -> Store:
    """A reproduction of two leisurely robots, and the first robot of another one."""
    counted(reproducing(store, LEISURELY, 2, 7))
    counted(reproducing(store, LEISURELY, 1, 8))
    return store


def test_of_reproductions_the_first_robot_of_the_latest_is_shown(reproduced: Store) -> None:
    content = content_of(reproduced)
    assert content.robot == "robot 0 of 1, seed 8"
    assert content.reproduction is not None
    assert (content.reproduction.session.id, content.reproduction.robots) == (2, 1)
    assert len(content.replays) == 96
    assert content.left_out == 0
    assert [tool.run.spec.tool for tool in content.tools] == [
        *("stick", "l-stick", "l-hook", "t-stick", "t-hook"),
    ]
    assert [len(broken.trials) for broken in content.broken] == [16]


def test_another_robot_of_another_reproduction_can_be_asked_for(reproduced: Store) -> None:
    content = content_of(reproduced, robots=[1], session=1)
    assert content.robot == "robot 1 of 2, seed 7"
    assert {replay.spec.robot for replay in content.replays} == {1}
    assert all(replay.differences == () for replay in content.replays)
    assert content.reproduction is not None
    assert content.reproduction.session.id == 1
    solved = sum(r.end is not None and r.end.outcome is Outcome.SOLVED for r in content.replays)
    assert solved == content.reproduction.totals[1] + content.reproduction.broken[1]


def test_a_robot_of_one_s_own_comes_before_those_of_a_reproduction(reproduced: Store) -> None:
    """Its page shows what the reproduction gave, too."""
    run = stored(reproduced, spec_of(behaviors=60, settings=IMPATIENT))
    content = content_of(reproduced)
    assert content.robot == "the robot of seed 0"
    assert [tool.run.id for tool in content.tools] == [run.id]
    assert content.reproduction is not None
    assert content_of(reproduced, robots=[0]).robot == "robot 0 of 1, seed 8"
    assert content_of(reproduced, session=1).robot == "robot 0 of 2, seed 7"


def test_a_baseline_s_page_shows_its_trials_and_says_that_it_is_no_robot_s_own(
    store: Store,
) -> None:
    """Nothing was learned: there is no course of learning to show."""
    parts = RunParts.chosen(IMPATIENT)
    oracle = Reproduced(parts, registry.component("planners", "oracle:spacing=2"), 7)
    counted(reproduce(store, oracle, 1, 1, now))
    content = content_of(store)
    assert (content.curves, content.bands) == ({}, {})
    assert (len(content.replays), content.not_replayed) == (96, {})
    assert "table computed, no robot&#39;s own" in render(content, "")


def test_a_half_finished_reproduction_is_shown_with_the_robots_that_are_saved(
    store: Store,
) -> None:
    taken(reproducing(store, LEISURELY, 5, 7), 4)
    content = content_of(store)
    assert content.robot == "robot 0 of 2, seed 7"
    assert content.reproduction is not None
    assert content.reproduction.robots == 2
    assert {len(counts) for counts in content.reproduction.cells.values()} == {2}
    assert "2 robots are too few to say cell by cell" in render(content, "")


def test_a_reproduction_without_a_robot_is_none(store: Store) -> None:
    taken(reproducing(store, LEISURELY, 2, 7), 1)
    with pytest.raises(UsageError, match=r"nothing learned in .*; first run: affcli learn"):
        content_of(store)


def test_what_is_not_there_is_said(reproduced: Store) -> None:
    with pytest.raises(UsageError, match="no robot 2 in session 1; they are numbered 0 to 1"):
        content_of(reproduced, robots=[2], session=1)
    with pytest.raises(UsageError, match=r"session 9 is no reproduction .*; there are: 1, 2"):
        content_of(reproduced, session=9)


def test_a_trial_that_cannot_be_done_again_is_left_out_with_the_reason(
    store: Store, run: LearningRunInfo
) -> None:
    """A planner, a tool and a behavior of another affcli take away no more than they must."""
    counted(solving(store, run, "2", "1"))
    counted(solving(store, run, "2", "2"))
    before = store.path.read_bytes()
    for statement, says in (
        (
            "UPDATE trial SET planner = 'clairvoyant:depth=2' WHERE id = 1",
            "planner clairvoyant:depth=2: this affcli has no such part",
        ),
        ("UPDATE trial SET shape_key = NULL WHERE id = 1", "does not know what a t-hook looks"),
        ("UPDATE trial SET world = 'table@7' WHERE id = 1", "made in version 7 of the world"),
    ):
        altered(store.path, statement)
        content = gathered(store.path)
        assert [replay.trial_id for replay in content.replays] == [2]
        (reason,) = content.not_replayed.values()
        assert says in reason
        without_number = escape(reason.removeprefix("trial 1: "))
        assert f"Trial 1 left out: {without_number}" in render(content, "")
        store.path.write_bytes(before)


def test_a_tool_of_which_only_the_name_is_known_is_shown_without_its_outline(
    store: Store, run: LearningRunInfo
) -> None:
    stick = stored(store, spec_of("stick", behaviors=300, settings=IMPATIENT))
    counted(solving(store, [run, stick], "1", "3"))
    spoon = "UPDATE learning_run SET tool = 'spoon', tool_key = NULL"
    altered(store.path, f"{spoon} WHERE id = {run.id}")
    content = gathered(store.path)
    assert [tool.run.spec.tool for tool in content.tools] == ["stick", "spoon"]
    assert [replay.spec.tool for replay in content.replays] == ["stick"]
    page = render(content, "")
    assert "Not drawn, for this affcli does not know the shape: spoon." in page
    drawn = [figure.count('class="wood"') for figure in page.split("</figure>")[:-1]]
    assert set(drawn) == {0, 1}


def test_what_cannot_be_read_is_refused(store: Store, run: LearningRunInfo) -> None:
    altered(store.path, "UPDATE learning_run SET versions = '7'")
    with pytest.raises(DatabaseError, match="learning run 1 holds"):
        gathered(store.path)


def test_a_run_that_was_done_beside_an_interrupted_one_is_listed_alone(
    store: Store, run: LearningRunInfo
) -> None:
    """An older affcli could begin it again; both are the same robot with the same tool."""
    begun = store.learning.begin(spec_of(behaviors=400, seed=9, settings=IMPATIENT), {}, now())
    with open_store(store.path, create=False, write=False) as again:
        assert [one.id for one, _ in overview_of(again).learned] == [run.id, begun.id]
    altered(store.path, f"UPDATE learning_run SET seed = 0 WHERE id = {begun.id}")
    with open_store(store.path, create=False, write=False) as again:
        assert [one.id for one, _ in overview_of(again).learned] == [run.id]
