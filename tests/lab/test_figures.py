"""What figures of testing trials gather, against the stored records counted one by one."""

import sys
from dataclasses import replace
from statistics import fmean

import pytest

from affcli.analysis.paper import other_parts
from affcli.config import Settings, settings_with
from affcli.core.behavior import GRASP, BehaviorCall
from affcli.core.records import LearningRunInfo
from affcli.core.specs import Protocol
from affcli.core.trial import Outcome
from affcli.errors import UsageError
from affcli.lab.adaptation import adaptation_in
from affcli.lab.drawing import require_figures
from affcli.lab.film_strips import film_of
from affcli.lab.overview import overview_of, reproduction_of
from affcli.lab.results import results_in
from affcli.lab.sessions import finished_session
from affcli.report.captions import results_words
from affcli.report.overview import overview_tables
from affcli.store import Store
from tests.lab.quick import (
    IMPATIENT,
    INTERRUPTED,
    LEISURELY,
    altered,
    breaking,
    counted,
    now,
    reproducing,
    solving,
    spec_of,
    stored,
    taken,
)
from tests.report.drawn import drawn

UNHURRIED = settings_with({"motion": {"hold": 10.0}, "trial": {"max_steps": 12}}, "a test")
"""An hour holds some hundred and fifty behaviors: enough to try in vain what was lost."""


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return stored(store, spec_of("t-hook", 250, settings=IMPATIENT))


def test_a_film_has_the_steps_as_they_are_stored(store: Store, run: LearningRunInfo) -> None:
    counted(breaking(store, run, "l-hook", 0))
    for info in store.trials.trials():
        film = film_of(store, info.id)
        assert film.steps == store.trials.steps(info.id)
        assert [s.number for s in film.steps] == list(range(1, (info.steps or 0) + 1))
        assert not any(shown.replicated and not shown.moved for shown in film.steps)
        broken = info.spec.protocol is Protocol.TOOL_ADAPTATION
        assert [part.name for part in film.missing] == ["right bar", "right hook"] * broken
        assert film.ending == info.outcome
        assert film.goal == info.spec.task.goal
        if film.steps:
            assert film.steps[0].true_start == pytest.approx(film.puck, abs=1e-9)


def test_steps_that_a_trial_does_not_have_are_refused(store: Store, run: LearningRunInfo) -> None:
    counted(solving(store, run, "1", "1"))
    (info,) = store.trials.trials()
    assert film_of(store, info.id, (1, info.steps or 0)).steps
    for wanted in ((1, 99), (99, 99)):
        with pytest.raises(UsageError, match=f"it has steps 1 to {info.steps}"):
            film_of(store, info.id, wanted)
    with pytest.raises(UsageError, match="no trial 2; they are numbered 1 to 1"):
        film_of(store, 2)


def test_an_unfinished_trial_has_the_steps_there_are(store: Store, run: LearningRunInfo) -> None:
    counted(solving(store, run, "1", "1"))
    altered(store.path, *INTERRUPTED)
    film = film_of(store, 1)
    assert film.ending is None
    assert len(film.steps) == 2
    assert film.course == "not ended, 2 steps so far"


def naive_course(store: Store, session: int, shape: str) -> list[list[tuple[bool, float]]]:
    """Return for each trial its steps: whether the row was lost; the mean probability after it."""
    course = []
    for info in store.trials.trials(session_id=session):
        if (info.spec.tool, info.spec.shape) != ("t-hook", shape):
            continue
        rows = store.learning.rows(info.run_id)
        chance = {row.id: 1.0 for row in rows if row.row.start.wrist_to_object_x > 0.0}
        steps = []
        for step in store.trials.steps(info.id):
            if step.affordance_id in chance:
                chance[step.affordance_id] = step.times_successful_after / step.times_used_after
            steps.append((bool(step.lost), fmean(chance.values())))
        course.append(steps)
    return course


@pytest.mark.parametrize("kind", ["break-tool", "reproduce"])
def test_the_course_is_that_of_the_stored_steps(kind: str, store: Store) -> None:
    """The broken T-hook lacks its right side."""
    if kind == "break-tool":
        run = stored(store, spec_of("t-hook", 400, settings=Settings()))
        counted(breaking(store, run, "l-hook", 0))
    else:
        counted(reproducing(store, UNHURRIED, 2, 5))
    course = adaptation_in(store, None)
    broken = naive_course(store, course.session.id, "l-hook")
    whole = naive_course(store, course.session.id, "t-hook")
    assert course.trials == len(broken)
    longest = max(map(len, broken))
    assert [share.number for share in course.shares] == list(range(1, longest + 1))
    for share in course.shares:
        running = [steps[share.number - 1][0] for steps in broken if len(steps) >= share.number]
        assert share.trials == len(running)
        assert share.share == pytest.approx(fmean(running))
    for trials, means in ((broken, course.broken), (whole, course.whole)):
        assert [mean.number for mean in means] == list(range(longest + 1))
        for mean in means:
            last = [([1.0] + [p for _, p in steps])[: mean.number + 1][-1] for steps in trials]
            assert mean.mean == pytest.approx(fmean(last))
    assert course.broken[-1].mean < course.whole[-1].mean <= 1.0
    assert any(share.share > 0.0 for share in course.shares)


def test_a_tool_that_broke_on_both_sides_has_no_missing_side(
    store: Store, run: LearningRunInfo
) -> None:
    counted(breaking(store, run, "t-stick", 0))
    course = adaptation_in(store, None)
    assert course.broken == course.whole == ()
    assert course.shares


def test_a_tool_that_was_never_learned_to_move_anything_has_no_course(store: Store) -> None:
    run = stored(store, spec_of("t-hook", 1, seed=2, settings=IMPATIENT))
    counted(breaking(store, run, "l-hook", 0))
    with pytest.raises(UsageError, match="no trial with the broken tool took a step; learn the"):
        adaptation_in(store, None)


def test_the_latest_finished_session_of_a_kind_is_taken(store: Store, run: LearningRunInfo) -> None:
    assert finished_session(store, None, ["break-tool"]) is None
    counted(breaking(store, run, "l-hook", 0))
    counted(breaking(store, run, "stick", 1))
    taken(breaking(store, run, "l-hook", 2), 1)
    assert adaptation_in(store, None).shape == "stick"
    assert adaptation_in(store, 1).shape == "l-hook"
    with pytest.raises(UsageError, match="session 3 is not finished; run affcli break-tool again"):
        adaptation_in(store, 3)
    with pytest.raises(UsageError, match="no session 4; they are numbered 1 to 3"):
        adaptation_in(store, 4)
    with pytest.raises(UsageError, match="session 1 is of affcli break-tool, not of reproduce; r"):
        results_in(store, 1)


def test_results_of_a_reproduction(store: Store) -> None:
    taken(reproducing(store, LEISURELY, 2, 0), 2)
    with pytest.raises(UsageError, match="session 1 is not finished; give the same affcli reprod"):
        results_in(store, 1)
    counted(reproducing(store, LEISURELY, 2, 0))
    result, results = reproduction_of(store, 1), results_in(store, None)
    assert {cell: list(beside.counts) for cell, beside in results.cells.items()} == result.cells
    assert results.total is not None
    assert list(results.total.counts) == result.totals


def test_results_of_single_robots(store: Store, run: LearningRunInfo) -> None:
    """Of each start the latest trial counts; an earlier learning run does not."""
    with pytest.raises(UsageError, match="no trials of affcli solve yet; run affcli reproduce"):
        results_in(store, None)
    counted(solving(store, run, "1"))
    again = stored(store, spec_of("t-hook", 251, settings=IMPATIENT))
    counted(solving(store, again, "3", "1"))
    counted(solving(store, again, "3", "2"))
    counted(solving(store, again, "3", "3"))
    counted(solving(store, again, "3", "3", seed=1))
    counted(breaking(store, again, "l-hook", 0))
    results = results_in(store, None)
    tried = {cell: beside.tried for cell, beside in results.cells.items() if beside.tried}
    assert tried == {("t-hook", "3"): 3}
    ended = {(t.spec.start, t.session_id): t.outcome for t in store.trials.trials(run_id=again.id)}
    latest = [ended["1", 2], ended["2", 3], ended["3", 5]]
    assert list(results.cells["t-hook", "3"].counts) == [latest.count(Outcome.SOLVED)]
    assert results_words(results).caption == (
        f"one robot a tool: run {again.id}: T-hook, seed 0, sensor noisy"
    )
    assert results.broken is not None
    assert results.total is None


def test_a_later_run_with_other_parts_does_not_hide_the_paper_s(
    store: Store, run: LearningRunInfo
) -> None:
    counted(solving(store, run, "1", "1"))
    held = replace(spec_of("t-hook", 60), binding=BehaviorCall.of(GRASP, {"grasp_point": 2.0}))
    other = store.learning.begin(held, {}, now())
    store.learning.append(other.id, 0, (), None, 0.0, done=True, now=now())
    latest = store.learning.latest("t-hook")
    assert latest is not None
    assert (latest.id, sorted(other_parts(latest.spec))) == (other.id, ["binding"])
    results = results_in(store, None)
    assert results.runs == {"noisy": {run.id: run.spec}}
    assert results.cells["t-hook", "1"].tried == 1


def test_a_break_at_other_tasks_leaves_the_paper_s_in_the_report(
    store: Store, run: LearningRunInfo
) -> None:
    """Of the same one done again, the last counts."""
    for _ in range(3):
        counted(breaking(store, run, "l-hook", 0))
    altered(store.path, "UPDATE trial SET task_set = 'far-corners' WHERE session_id = 3")
    breakings = overview_of(store).breakings
    assert [(one.session, one.task_set, one.papers) for one in breakings] == [
        (2, "extension-of-reach", True),
        (3, "far-corners", False),
    ]
    words = drawn(overview_tables(overview_of(store)), 200).split("Tools that broke")[1]
    assert "paper, t-hook that became l-hook, extension-of-reach: 16 of 16" in words
    assert "far-corners" in words


def test_a_break_that_was_stopped_takes_no_finished_ones_place(
    store: Store, run: LearningRunInfo
) -> None:
    taken(breaking(store, run, "l-hook", 0), 1)
    (begun,) = overview_of(store).breakings
    assert (begun.session, begun.broken.trials, begun.finished) == (1, 1, False)
    assert "l-hook (unfinished)" in drawn(overview_tables(overview_of(store)), 200)
    counted(breaking(store, run, "l-hook", 0))
    taken(breaking(store, run, "l-hook", 0), 2)
    overview = overview_of(store)
    (whole,) = overview.breakings
    assert (whole.session, whole.broken.trials, whole.whole.trials) == (2, 16, 16)
    assert whole.finished
    assert overview.trials == 32
    assert "unfinished" not in drawn(overview_tables(overview), 200).split("Tools that broke")[1]


def test_without_matplotlib_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    require_figures()
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(UsageError, match=r"install them: pip install 'affcli\[figures\]'"):
        require_figures()
