"""Tables and rows gathered for figures say what the store says."""

import itertools
import sqlite3
from collections import Counter
from contextlib import closing
from dataclasses import replace

import pytest

from affcli.analysis.row_status import RowStatus
from affcli.config import settings_with
from affcli.core.records import LearningRunInfo
from affcli.core.specs import Protocol
from affcli.core.tool import unknown_tool
from affcli.errors import UsageError
from affcli.lab.affordance_views import (
    row_shown,
    table_of_run,
    tables_around_trial,
    tables_compared,
)
from affcli.lab.film_strips import film_of
from affcli.report.figures.affordances import affordances_figure
from affcli.report.figures.row import row_figure
from affcli.report.figures.trial import trial_figure
from affcli.report.film import shown_of
from affcli.report.table_views import TableView
from affcli.store import Store
from tests.lab.quick import (
    IMPATIENT,
    INTERRUPTED,
    altered,
    breaking,
    counted,
    now,
    solving,
    spec_of,
    stored,
)

BLURRED = settings_with({"sensor": {"position_noise": 0.25}, "trial": {"max_steps": 6}}, "a test")


@pytest.fixture
def run(store: Store) -> LearningRunInfo:
    """A T-hook's learning run, in the store."""
    return stored(store, spec_of("t-hook", 300, settings=IMPATIENT))


def counts(view: TableView) -> Counter[RowStatus]:
    return Counter(fate for _, fate in view.rows)


def names(view: TableView) -> tuple[set[str], set[str]]:
    """Return the parts that a view's tool has, and those it has lost."""
    return {part.name for part in view.parts}, {part.name for part in view.missing}


def test_the_table_of_a_run_has_all_its_rows(store: Store, run: LearningRunInfo) -> None:
    shown = table_of_run(store, run)
    (view,) = shown.views
    assert [row for row, _ in view.rows] == [row.row for row in store.learning.rows(run.id)]
    assert counts(view) == {RowStatus.LIVE: run.rows}
    assert len(shown.calls) == 8
    assert shown.words.title == "What the T-hook affords"
    assert shown.words.caption.startswith(f"{run.rows} rows; run {run.id}: T-hook, seed 0, ")
    assert shown.words.caption.endswith("; not default: trial.max_steps = 6")


def test_rows_that_solving_excluded_are_told_apart(store: Store, run: LearningRunInfo) -> None:
    for row in store.learning.rows(run.id)[:5]:
        with closing(sqlite3.connect(store.path)) as driver, driver:
            driver.execute(f"UPDATE affordance SET times_used = 2 WHERE id = {row.id}")
    shown = table_of_run(store, run)
    assert [fate for _, fate in shown.views[0].rows][:5] == [RowStatus.EXCLUDED] * 5
    assert counts(shown.views[0]) == {RowStatus.LIVE: run.rows - 5, RowStatus.EXCLUDED: 5}
    assert shown.words.caption.startswith(f"{run.rows} rows, 5 of them excluded; ")


def test_a_trial_with_a_broken_tool_loses_the_rows_that_died_in_it(
    store: Store, run: LearningRunInfo
) -> None:
    counted(breaking(store, run, "l-hook", 0))
    trials = store.trials.trials(run_id=run.id)
    broken = [t for t in trials if t.spec.protocol is Protocol.TOOL_ADAPTATION]
    died = {t.id: {s.affordance_id for s in store.trials.steps(t.id) if s.died} for t in trials}
    assert any(died[t.id] for t in broken)
    for trial in trials:
        shown = tables_around_trial(store, trial.id)
        before, after = shown.views
        ids = [row.id for row in store.learning.rows(run.id)]
        assert counts(before) == {RowStatus.LIVE: run.rows}
        lost = {i for i, (_, fate) in zip(ids, after.rows, strict=True) if fate is RowStatus.LOST}
        assert lost == died[trial.id]
        assert counts(after)[RowStatus.KEPT] == run.rows - len(lost)
        whole = {"handle", "left bar", "right bar", "left hook", "right hook"}
        assert names(before) == (whole, set())
        missing = {"right bar", "right hook"} if trial in broken else set()
        assert names(after) == (whole - missing, missing)
        assert f"{len(lost)} lost" in shown.words.caption
        assert ("became L-hook" in shown.words.title) == (trial in broken)


def test_after_the_last_trial_of_solving_the_table_is_as_it_is_stored(store: Store) -> None:
    """Through a sensor so bad that rows die: what each trial found and left adds up."""
    run = stored(store, spec_of("t-hook", 300, settings=BLURRED))
    counted(solving(store, run, "1"))
    counted(solving(store, run, "3"))
    trials = store.trials.trials(run_id=run.id)
    assert any(store.trials.excluded_before(trial.id) for trial in trials)
    as_it_is = table_of_run(store, run).views[0]
    gone = {RowStatus.LOST, RowStatus.EXCLUDED}
    last = tables_around_trial(store, trials[-1].id).views[1]
    assert [f in gone for _, f in last.rows] == [f is RowStatus.EXCLUDED for _, f in as_it_is.rows]
    for one, following in itertools.pairwise(trials):
        left = tables_around_trial(store, one.id).views[1]
        found = tables_around_trial(store, following.id).views[0]
        assert [f in gone for _, f in left.rows] == [f is RowStatus.EXCLUDED for _, f in found.rows]


def test_two_runs_are_compared_each_over_its_own_tool(store: Store, run: LearningRunInfo) -> None:
    other = stored(store, spec_of("l-hook", 300, settings=IMPATIENT))
    shown = tables_compared(store, run, other)
    before, after = shown.views
    assert (before.heading, after.heading) == (f"Run {run.id}: T-hook", f"Run {other.id}: L-hook")
    assert set(counts(before)) <= {RowStatus.KEPT, RowStatus.LOST}
    assert set(counts(after)) <= {RowStatus.KEPT, RowStatus.WON}
    assert (len(before.rows), len(after.rows)) == (run.rows, other.rows)
    assert names(after)[1] == {"right bar", "right hook"}
    # What hangs on the right bar and hook alone the L-hook cannot have learned.
    pulls_on_the_right = [
        fate
        for row, fate in before.rows
        if row.exploratory.name == "contract arm" and row.start.wrist_to_object_x > 2.5
    ]
    assert pulls_on_the_right
    assert set(pulls_on_the_right) == {RowStatus.LOST}
    with pytest.raises(UsageError, match="that is the run itself"):
        tables_compared(store, run, run)


def test_an_unfinished_run_says_how_far_it_came(store: Store) -> None:
    spec = spec_of("t-hook", 600)
    info = store.learning.begin(spec, {}, now())
    assert table_of_run(store, info).words.caption == (
        f"0 rows; run {info.id}: T-hook, seed 0, 0 min 00 s so far (unfinished); default settings"
    )


def test_a_row_is_shown_with_the_tool_of_its_own_settings(
    store: Store, run: LearningRunInfo
) -> None:
    one = store.learning.rows(run.id)[2]
    words, view = row_shown(store, one.id)
    assert view.row == one.row
    assert view.tool.name == "t-hook"
    assert view.puck_radius == 1.5
    assert words.title == f"Row {one.id} of the T-hook's affordance table"
    assert words.caption.startswith(f"run {run.id}: T-hook, seed 0, ")


def test_a_tool_of_which_only_the_name_is_known_is_named_and_not_drawn(
    store: Store, run: LearningRunInfo
) -> None:
    spoon = replace(run, spec=replace(run.spec, held=unknown_tool("spoon")))
    shown = table_of_run(store, spoon)
    assert shown.words.title == "What the Spoon affords"
    assert shown.words.caption.endswith(
        "; not drawn, for this affcli does not know the shape: spoon"
    )
    assert (shown.views[0].parts, len(shown.views[0].rows)) == ((), run.rows)
    assert affordances_figure(shown.calls, shown.views, shown.key).axes


def test_an_interrupted_trial_shows_what_was_done(store: Store, run: LearningRunInfo) -> None:
    counted(solving(store, run, "2", "1"))
    altered(store.path, *INTERRUPTED)
    shown = tables_around_trial(store, 1)
    assert shown.words.title == "Trial 1: what the T-hook unlearned"
    assert "; unfinished, 2 steps so far; trial: seed 0; run 1: T-hook" in shown.words.caption


@pytest.mark.parametrize("planner", ["nested-query:threshold=0.3", "psychic:threshold=0.3"])
def test_a_trial_leaves_out_what_its_own_planner_leaves_out(planner: str, store: Store) -> None:
    """Also one that this affcli lacks: its record says at which probability."""
    run = stored(store, spec_of("t-hook", 300, settings=BLURRED))
    counted(solving(store, run, "1"))
    last = store.trials.trials(run_id=run.id)[-1].id
    usual = tables_around_trial(store, last)
    assert counts(usual.views[0])[RowStatus.EXCLUDED] > 0
    assert usual.key[RowStatus.LOST] == "lost: its probability fell to 1/2 or below in the trial"
    altered(store.path, f"UPDATE trial SET planner = '{planner}'")
    shown = tables_around_trial(store, last)
    assert counts(shown.views[0])[RowStatus.EXCLUDED] == 0
    assert shown.key[RowStatus.LOST] == "lost: its probability fell to 0.3 or below in the trial"


PINCHED = (
    f"UPDATE {table} SET binding_behavior = 'pinch', binding_params = '{{\"side\": 2}}'"
    for table in ("learning_run", "affordance")
)
"""What another affcli has that holds a tool by its side."""


def test_a_tool_of_which_it_is_not_known_how_it_is_held_is_left_out_and_named(
    store: Store, run: LearningRunInfo
) -> None:
    """Rows, arrows and steps are drawn all the same."""
    counted(solving(store, run, "2", "1"))
    altered(store.path, *PINCHED)
    left_out = "; tool not drawn, for this affcli does not know where it is held: pinch 2"
    words, view = row_shown(store, store.learning.rows(run.id)[2].id)
    assert (view.tool.name, view.tool.parts) == ("t-hook", ())
    assert words.caption.endswith(left_out)
    assert row_figure(view).axes
    shown = tables_around_trial(store, 1)
    assert shown.words.caption.endswith(left_out)
    assert shown.views[0].parts == ()
    film = film_of(store, 1)
    assert (film.parts, film.missing) == ((), ())
    assert film.title == "Trial 1: T-hook, goal 2, start 1"
    assert film.caption.endswith("; tool not drawn: held by pinch 2")
    assert trial_figure(film, shown_of(film.steps, None)).axes
