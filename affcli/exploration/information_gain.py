"""Information gain: make the try of which it is least known whether it has an effect."""

import numpy as np

from affcli.exploration.focused import focused
from affcli.exploration.memory import Memory
from affcli.exploration.tries import Numbers, Tries

LEAST = 1e-12
"""A probability nearer to 0 or 1 is as good as known."""


def information(tries: Tries, memory: Memory, _: np.random.Generator) -> Numbers:
    """Return the entropy of T (nat): T follows from the contacts, so what T is expected to say of
    them is as much.
    """
    effect = np.clip(tries.effect(memory.contacts.contact), LEAST, 1.0 - LEAST)
    entropy: Numbers = -effect * np.log(effect) - (1.0 - effect) * np.log(1.0 - effect)
    return entropy


PARTS = (
    focused(
        "information-gain",
        "the try whose effect is least certain",
        "Stoytchev 2008, §8; after Lindley 1956",
        information,
    ),
)
