"""Goal babbling: set a goal for the attractor, and make the try that should meet it best."""

import math

import numpy as np

from affcli.exploration.focused import focused
from affcli.exploration.memory import Memory
from affcli.exploration.tries import Numbers, Tries

LEAST, MOST = 0.5, 5.0
"""Length of the movements that it wants (in): what T detects, and what the paper's behaviors do."""


def nearness(tries: Tries, memory: Memory, rng: np.random.Generator) -> Numbers:
    """Draw a movement of the attractor in any direction; prefer tries expected to end near it."""
    length, turn = rng.random(2).tolist()
    length, turn = LEAST + length * (MOST - LEAST), 2.0 * math.pi * turn
    goal = length * np.array([math.cos(turn), math.sin(turn)])
    error = np.hypot(*(tries.movement(memory.contacts.contact) - goal).T)
    near = memory.rows.near(tries.call, tries.x, tries.y)
    close: Numbers = 1.0 / (1.0 + error) / (1.0 + near)
    return close


PARTS = (
    focused(
        "goal-babbling",
        "a movement of the attractor is wanted, and the try made that should come nearest to it",
        "Stoytchev 2008, §8; after Rolf, Steil and Gienger 2010",
        nearness,
    ),
)
