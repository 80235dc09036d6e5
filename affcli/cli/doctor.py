"""``affcli doctor``: is all here that affcli needs, and what to do where it is not."""

from dataclasses import asdict

from affcli.cli.options import DEFAULT_DATABASE, AsJson, Database
from affcli.cli.terminal import show, show_json
from affcli.errors import DatabaseError, one_line


def doctor(*, database: Database = DEFAULT_DATABASE, as_json: AsJson = False) -> int:
    """Say whether all is here that affcli needs.

    Python, packages, SQLite, file system, disk space, permissions and the database; each with what
    to do. Exit code 3 when something must be mended first.
    """
    from affcli.lab.doctor import facts
    from affcli.report.sheet import Sheet

    found = facts(database)
    if as_json:
        show_json([asdict(fact) for fact in found])
    else:
        columns = ("what", "state", "found", "what to do")
        table = Sheet(columns, left=columns)
        for fact in found:
            table.add(fact.what, fact.state, one_line(fact.value, 400), fact.remedy)
        show(table)
    return DatabaseError.exit_code if any(fact.state == "bad" for fact in found) else 0
