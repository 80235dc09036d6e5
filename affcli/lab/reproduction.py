"""The whole paper on many robots, as an experiment of one condition: five tools, 80 + 16 trials."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from affcli.core.identity import Component
from affcli.core.specs import REPRODUCE, RobotRecord, SessionSpec
from affcli.lab import conducting, experiment
from affcli.lab.experiment import ADAPTATION, ADAPTATION_TASKS, Condition, Experiment
from affcli.lab.run_parts import RunParts
from affcli.lab.versions import versions
from affcli.lab.workers import Pool
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import Store

HOURS = 1.0
"""§6: one hour of run time for every tool."""


@dataclass(frozen=True, slots=True)
class Reproduced:
    """What every robot of a reproduction is a function of, beside its number.

    Args:
        parts: what its learning runs carry.
        planner: how it chooses rows.
        seed: shared by all robots.
        hours: robot hours with each tool.
    """

    parts: RunParts
    planner: Component
    seed: int
    hours: float = HOURS

    def experiment(self, robots: int = 1) -> Experiment:
        """Return the experiment that it is. It has no name: its session is found by its key."""
        tasks = (ADAPTATION_TASKS, ADAPTATION)
        paper = Condition("paper", self.parts, self.planner, self.hours, tuple(TOOL_PARTS), tasks)
        return Experiment(REPRODUCE, "", robots, self.seed, (paper,), {})

    def session(self, robots: int) -> SessionSpec:
        """Return what a reproduction of so many robots is a function of."""
        (paper,) = self.experiment().conditions
        return paper.session(REPRODUCE, self.seed, robots)


def reproduced_again(session: SessionSpec) -> Reproduced:
    """Return what a stored reproduction was of, to go on with it."""
    return Reproduced(RunParts(**session.carried()), session.planner, session.seed)


def one_robot(what: Reproduced, robot: int) -> RobotRecord:
    """Return the life of one robot: a pure function of what is reproduced and its number."""
    return experiment.one_robot(what.experiment(), robot)


def reproduce(
    store: Store,
    what: Reproduced,
    robots: int,
    workers: int | Pool,
    now: Callable[[], str],
    warn: Callable[[str], object] = str,
) -> Iterator[int]:
    """Let `robots` independent robots learn and be tested; see `affcli.lab.conducting.conduct`.

    Yields:
        The session's id first, then how many robots are saved: at the beginning, and each time one
        more is.
    """
    whole = what.experiment(robots)
    (paper,) = whole.conditions
    made_with = versions(paper.world, paper.parts.sensor)
    session = store.sessions.begin(what.session(robots), made_with, now())
    yield session
    yield from conducting.conduct(store, whole, [session], range(robots), workers, now, warn)
    store.sessions.settle(session, now())
