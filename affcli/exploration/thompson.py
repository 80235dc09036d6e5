"""Thompson sampling: draw what the contacts may be like, and believe it for one try."""

import numpy as np

from affcli.exploration.focused import focused
from affcli.exploration.memory import Memory
from affcli.exploration.tries import Numbers, Tries


def believed(tries: Tries, memory: Memory, rng: np.random.Generator) -> Numbers:
    """Prefer tries that have an effect if the contacts are as drawn; of those the first drawn."""
    contact = memory.contacts.contact
    return tries.effect((rng.random(contact.shape) < contact).astype(float))


PARTS = (
    focused(
        "thompson",
        "a try that has an effect if the contacts are as drawn from what is known of them",
        "Stoytchev 2008, §8; after Thompson 1933",
        believed,
    ),
)
