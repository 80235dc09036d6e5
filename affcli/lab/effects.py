"""Which tool moves the attractor where: over all that was tried with each."""

from collections.abc import Sequence

from affcli.core.behavior import BehaviorCall
from affcli.core.effects import Effect, Way
from affcli.core.records import LearningRunInfo
from affcli.store import Store


def effects_of(
    store: Store,
    runs: Sequence[LearningRunInfo],
    way: Way,
    inches: float,
    behavior: BehaviorCall | None = None,
) -> list[tuple[LearningRunInfo, Effect]]:
    """Return how often each behavior of some runs moved the attractor so far, the best first.

    Args:
        store: open.
        runs: the learning runs.
        way: where to.
        inches: by more than so much.
        behavior: only this one; without parameters whatever they were. None for all.
    """
    found = [
        (run, effect)
        for run in runs
        for effect in store.results.effects(run.id, way, inches)
        if behavior is None
        or effect.call == behavior
        or (effect.call.name == behavior.name and not behavior.params)
    ]
    return sorted(found, key=lambda one: (-one[1].moved / one[1].tried, -one[1].tried, one[0].id))
