"""The worlds that affcli brings, by name; their engines load when a world is made."""

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from affcli.core.part import Part

TABLE, TABLE_VERSION = "table", 2
"""The version is raised when equal specs give other records: by another physics, for example."""


def table_world(settings: Any, task_sets: Mapping[str, Any]) -> Any:
    """Return the paper's table (`affcli.simulation.table_world.TableWorld`)."""
    return import_module("affcli.simulation.table_world").TableWorld(settings, task_sets)


PARTS = (
    Part(
        kind="worlds",
        name=TABLE,
        summary="the paper's table: a five-axis arm, a hockey puck, pushing in pymunk",
        source="Stoytchev 2008, §4",
        build=table_world,
        version=TABLE_VERSION,
    ),
)
