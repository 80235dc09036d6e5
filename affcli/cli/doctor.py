"""``affcli doctor``: is everything here that affcli needs, and what to do where it is not."""

from dataclasses import asdict

from affcli.cli.options import AsJson, Database
from affcli.cli.terminal import show_json, show_rows
from affcli.errors import DatabaseError, one_line
from affcli.lab.doctor import facts
from affcli.lab.suggesting import DEFAULT_DATABASE


def doctor(*, database: Database = DEFAULT_DATABASE, as_json: AsJson = False) -> int:
    """Say whether everything is here that affcli needs.

    Python, packages, SQLite, file system, disk space, permissions and the database; each with what
    to do. Exit code 3 when something must be repaired first.
    """
    found = facts(database)
    if as_json:
        show_json([asdict(fact) for fact in found])
    else:
        columns = ("what", "state", "found", "what to do")
        rows = [(one.what, one.state, one_line(one.value, 400), one.remedy) for one in found]
        show_rows(columns, rows, left=columns)
    return DatabaseError.exit_code if any(fact.state == "bad" for fact in found) else 0
