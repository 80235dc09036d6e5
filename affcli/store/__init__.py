"""The only room that knows the database: one SQLite file, its schema made by ``migrations/``.

What other rooms use stands in ``__all__``. Each name is imported when it is first asked for, so
``affcli sql`` needs no SQLAlchemy, and opening a database of the right schema no Alembic.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from affcli.store.copying import backup
    from affcli.store.environment import Fact, State, environment_facts
    from affcli.store.health import DatabaseInfo, Finding, check, database_info
    from affcli.store.merging import Merged, merge
    from affcli.store.opening import Store, open_store, upgrade
    from affcli.store.packing import PackedRobot, pack_robot
    from affcli.store.query import QueryResult, run_sql
    from affcli.store.waiting import tell_of_waiting

__all__ = [
    "DatabaseInfo",
    "Fact",
    "Finding",
    "Merged",
    "PackedRobot",
    "QueryResult",
    "State",
    "Store",
    "backup",
    "check",
    "database_info",
    "environment_facts",
    "merge",
    "open_store",
    "pack_robot",
    "run_sql",
    "tell_of_waiting",
    "upgrade",
]

_HOMES = {
    "copying": ("backup",),
    "waiting": ("tell_of_waiting",),
    "environment": ("Fact", "State", "environment_facts"),
    "health": ("DatabaseInfo", "Finding", "check", "database_info"),
    "merging": ("Merged", "merge"),
    "opening": ("Store", "open_store", "upgrade"),
    "packing": ("PackedRobot", "pack_robot"),
    "query": ("QueryResult", "run_sql"),
}
"""Which file each public name lives in."""


def __getattr__(name: str) -> object:
    """Import a public name when it is first asked for."""
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"affcli.store.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
