"""``affcli table list``: the rows of the affordance tables, filtered."""

from affcli import lab
from affcli.cli.database import opened
from affcli.cli.options import AsJson, Database
from affcli.cli.table_choice import (
    AllRuns,
    Behavior,
    Limit,
    Probability,
    Region,
    Run,
    Tool,
)
from affcli.cli.terminal import say, show, show_json
from affcli.errors import one_line
from affcli.lab.suggesting import DEFAULT_DATABASE
from affcli.report.rows import rows_json, rows_table


def list_rows(
    *,
    tool: Tool = None,
    run: Run = None,
    all_runs: AllRuns = False,
    behavior: Behavior = None,
    probability: Probability = None,
    region: Region = None,
    limit: Limit = None,
    database: Database = DEFAULT_DATABASE,
    as_json: AsJson = False,
) -> None:
    """List rows of the affordance tables.

    Of the latest finished learning run of each tool, or of --tool, unless --run or --all-runs says
    otherwise.
    """
    with opened(database) as store:
        runs, wanted = lab.choosing.chosen_rows(
            store,
            tool=tool,
            run=run,
            all_runs=all_runs,
            behavior=behavior,
            probability=probability,
            region=region,
            limit=limit,
        )
        rows = lab.table.listed_rows(store, runs, wanted, region)
    if as_json:
        show_json(rows_json(rows))
    else:
        named = {one.id: f"run {one.id} ({one_line(one.spec.tool, 60)})" for one in runs}
        words = ", ".join(named[number] for number in sorted(named))
        title = "Rows of all runs" if all_runs else f"Rows of {words}"
        show(rows_table(rows, title, with_runs=all_runs))
    if not rows:
        say("no rows")
