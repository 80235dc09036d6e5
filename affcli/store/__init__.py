"""The only room that knows the database: one SQLite file, its schema made by ``migrations/``.

What other rooms use stands in ``__all__``. Each name is imported when it is first asked for, so
``affcli sql`` needs no SQLAlchemy, and opening a database of the right schema no Alembic.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from affcli.store.adaptation import StepSums, TrialGroup
    from affcli.store.copying import backup
    from affcli.store.health import Finding, check
    from affcli.store.info import DatabaseInfo, database_info
    from affcli.store.learning import LearningRunInfo, LearningStep
    from affcli.store.opening import open_store, upgrade
    from affcli.store.packing import PackedRobot, pack_robot
    from affcli.store.place import Fact, State, place_facts
    from affcli.store.progress import LearningInterval
    from affcli.store.query import QueryResult, run_sql
    from affcli.store.records import StoredRow, TrialInfo
    from affcli.store.repository import Store
    from affcli.store.results import (
        BehaviorGroup,
        OutcomeCount,
        RowUse,
        StoredStep,
        SuccessCount,
        TrialResult,
    )
    from affcli.store.scenes import StepScene
    from affcli.store.selection import Column, Comparison, Relation, RowFilter
    from affcli.store.trials import SessionInfo, SessionKind

__all__ = [
    "BehaviorGroup",
    "Column",
    "Comparison",
    "DatabaseInfo",
    "Fact",
    "Finding",
    "LearningInterval",
    "LearningRunInfo",
    "LearningStep",
    "OutcomeCount",
    "PackedRobot",
    "QueryResult",
    "Relation",
    "RowFilter",
    "RowUse",
    "SessionInfo",
    "SessionKind",
    "State",
    "StepScene",
    "StepSums",
    "Store",
    "StoredRow",
    "StoredStep",
    "SuccessCount",
    "TrialGroup",
    "TrialInfo",
    "TrialResult",
    "backup",
    "check",
    "database_info",
    "open_store",
    "pack_robot",
    "place_facts",
    "run_sql",
    "upgrade",
]

_HOMES = {
    "adaptation": ("StepSums", "TrialGroup"),
    "copying": ("backup",),
    "health": ("Finding", "check"),
    "info": ("DatabaseInfo", "database_info"),
    "learning": ("LearningRunInfo", "LearningStep"),
    "opening": ("open_store", "upgrade"),
    "packing": ("PackedRobot", "pack_robot"),
    "place": ("Fact", "State", "place_facts"),
    "progress": ("LearningInterval",),
    "query": ("QueryResult", "run_sql"),
    "records": ("StoredRow", "TrialInfo"),
    "repository": ("Store",),
    "results": (
        *("BehaviorGroup", "OutcomeCount", "RowUse", "StoredStep", "SuccessCount", "TrialResult"),
    ),
    "scenes": ("StepScene",),
    "selection": ("Column", "Comparison", "Relation", "RowFilter"),
    "trials": ("SessionInfo", "SessionKind"),
}
"""Which file each public name lives in."""


def __getattr__(name: str) -> object:
    """Import a public name when it is first asked for."""
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"affcli.store.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
