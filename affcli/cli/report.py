"""``affcli report``: what the database holds, beside the paper."""

from affcli.cli.options import DEFAULT_DATABASE, AsJson, Database
from affcli.cli.terminal import show, show_json


def report(*, database: Database = DEFAULT_DATABASE, as_json: AsJson = False) -> None:
    """Show tools learned, rows by behavior, trials beside the paper's, and failures by kind."""
    from affcli.lab.overview import overview_of
    from affcli.report.overview import overview_json, overview_tables
    from affcli.store import open_store

    with open_store(database, create=False, write=False) as store:
        overview = overview_of(store)
    if as_json:
        show_json(overview_json(overview))
    else:
        show(*overview_tables(overview))
