"""Affordance tables and their rows, read for figures (Figs. 5 and 6)."""

from affcli import registry
from affcli.core.affordance import PROBABILITY_THRESHOLD, Affordance
from affcli.core.identity import Component
from affcli.core.records import LearningRunInfo
from affcli.errors import BadInputError, UsageError
from affcli.lab.run_parts import settings_of
from affcli.report import table_views
from affcli.report.captions import Words
from affcli.report.table_views import RowView, ShownTables
from affcli.store import Store


def table_of_run(store: Store, run: LearningRunInfo) -> ShownTables:
    """Return the table of a learning run as it is now."""
    rows = [stored.row for stored in store.learning.rows(run.id)]
    return table_views.run_shown(run, rows, _puck_radius(run))


def tables_compared(store: Store, one: LearningRunInfo, other: LearningRunInfo) -> ShownTables:
    """Return the tables of two learning runs.

    Raises:
        UsageError: they are the same run.
    """
    if one.id == other.id:
        raise UsageError(f"--compare {other.id}: that is the run itself; name another")
    first, second = ([row.row for row in store.learning.rows(run.id)] for run in (one, other))
    for run, rows in ((one, first), (other, second)):
        if not all(map(Affordance.is_placed, rows)):
            raise UsageError(
                f"run {run.id} comes from a log that does not say where the tool was: its rows "
                "have no like in another table; compare how often: affcli which"
            )
    radii = _puck_radius(one), _puck_radius(other)
    return table_views.runs_compared((one, other), (first, second), radii)


def tables_around_trial(store: Store, trial_id: int) -> ShownTables:
    """Return the table that a trial started from, and what it left of it.

    Raises:
        UsageError: there is no such trial.
    """
    trial = store.trials.trial(trial_id)
    run = store.learning.run(trial.run_id)
    threshold = _threshold(trial.spec.planner)
    return table_views.trial_shown(
        trial,
        run,
        store.learning.rows(run.id),
        store.trials.steps(trial_id),
        store.trials.excluded_before(trial_id, threshold),
        threshold,
        _puck_radius(run),
    )


def row_shown(store: Store, row_id: int) -> tuple[Words, RowView]:
    """Return a row of an affordance table with what is said of it.

    Raises:
        UsageError: there is no such row.
    """
    stored = store.learning.row(row_id)
    run = store.learning.run(stored.run_id)
    return table_views.row_shown(stored, run, _puck_radius(run))


def _threshold(planner: Component) -> float:
    """Return the replication probability at which a planner leaves a row out.

    Of one that this affcli lacks, what its record says; the paper's if it does not say.
    """
    try:
        return registry.planner(planner).threshold
    except BadInputError:
        said = dict(planner.params).get("threshold")
        return float(said) if isinstance(said, int | float) else PROBABILITY_THRESHOLD


def _puck_radius(run: LearningRunInfo) -> float:
    """Return the radius of the attractor of a learning run (in)."""
    return settings_of(run.spec).workspace.puck.radius
