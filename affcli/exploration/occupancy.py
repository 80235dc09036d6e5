"""Occupancy: find out where the attractor can be and where not; new rows first."""

import numpy as np

from affcli.exploration.focused import focused
from affcli.exploration.memory import Memory
from affcli.exploration.tries import Numbers, Tries


def occupancy(tries: Tries, memory: Memory, _: np.random.Generator) -> Numbers:
    """Prefer tries that are likely to make a row, where there are few of the same behavior."""
    near = memory.rows.near(tries.call, tries.x, tries.y)
    return tries.effect(memory.contacts.contact) / (1.0 + near)


PARTS = (
    focused(
        "occupancy",
        "where the attractor can be to the wrist and not be: new rows first",
        "Stoytchev 2008, §8; after Moravec and Elfes 1985",
        occupancy,
    ),
)
