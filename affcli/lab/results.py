"""Our results, read for the figure that shows them beside the paper's (§7)."""

from affcli.analysis.comparison import Results, results_of_many, results_of_single
from affcli.analysis.paper import other_parts
from affcli.errors import UsageError
from affcli.lab.overview import reproduction_of
from affcli.lab.sessions import finished_session
from affcli.store import Store


def results_in(store: Store, session: int | None) -> Results:
    """Return the results of a finished reproduction; without one, those of single robots.

    Choice: single robots are, for each tool, the latest finished learning run whose parts but for
    the tool are the paper's. Of each start the latest ``affcli solve`` counts, and the latest 16
    trials with the broken T-hook.

    Args:
        store: open.
        session: which reproduction; None for the latest.

    Raises:
        UsageError: it is no finished reproduction; or there is nothing to show at all.
    """
    found = finished_session(store, session, ["reproduce"])
    if found is not None:
        return results_of_many(reproduction_of(store, found.id))
    done = [run for run in store.learning.runs(status="done") if not other_parts(run.spec)]
    latest = {run.spec.tool: run.id for run in done}
    own = set(latest.values())
    solving, breaking = (
        [trial for trial in store.trials.trials(kind=kind) if trial.run_id in own]
        for kind in ("solve", "break-tool")
    )
    single = results_of_single(solving, breaking)
    if single is None:
        raise UsageError(
            "no finished reproduction and no trials of affcli solve yet; run affcli reproduce "
            "--robots 20, or affcli solve"
        )
    return single
