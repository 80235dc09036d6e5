"""Baselines in the place of robots: what they are told, as tables that trials start from."""

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from affcli import registry
from affcli.baselines.planners import ORACLE, PUSH_PLANNER
from affcli.core.identity import Component
from affcli.core.motion import Slide
from affcli.core.specs import TOLD, LearningSpec, LearningStep, Parts
from affcli.core.tool import Tool
from affcli.errors import BadInputError, UsageError
from affcli.lab.run_parts import settings_of

if TYPE_CHECKING:
    from affcli.baselines.beliefs.pushes import Belief


def require_own(planner: Component) -> None:
    """Refuse a planner that is no robot's own where a robot uses what it learned."""
    if registry.is_told(planner):
        raise UsageError(
            f"{planner.name} is no robot's own: it plans on pushes that it is told, not on a table "
            "that was learned; name it in an experiment (affcli experiment)"
        )


def require_believable(planner: Component, parts: Parts) -> None:
    """Refuse a baseline where pushes cannot be computed before any is done: each is of a straight
    slide, against a puck that answers alike however it is turned.

    Raises:
        BadInputError: a behavior is anything else, or the puck's centre of mass is off its middle
            and the baseline is not to believe otherwise.
    """
    if not registry.is_told(planner):
        return
    for behavior in parts.repertoire:
        if [type(segment) for segment in behavior.motion] != [Slide]:
            raise BadInputError(
                f"repertoire: {planner.name} is told straight slides alone; leave out "
                f"{behavior.call}"
            )
    values = registry.recorded("planners", planner).values(planner)
    if settings_of(parts).workspace.puck.mass_offset and not values.get("even"):
        raise BadInputError(
            f"planner: {planner.name} is told the pushes of a puck that is even, and how this one "
            f"lies changes with every push; name {PUSH_PLANNER}:even=1, or leave out "
            "puck.mass_offset"
        )


def told_spec(learned: LearningSpec, planner: Component, held: Tool | None = None) -> LearningSpec:
    """Return what the table of a baseline is a function of.

    Args:
        learned: the learning run in whose place it stands.
        planner: which baseline.
        held: the tool that is truly held, which the oracle knows; None where it did not break.
    """
    believed = learned.held
    if held is not None and planner.name == ORACLE:
        # Under the name and the colour by which the robot would know it.
        believed = replace(held.painted(learned.held.color), name=learned.held.name)
    values = registry.recorded("planners", planner).values(planner)
    words = {"spacing": values["spacing"], "friction": values.get("friction", 0.0)}
    # What was told before one could be told of an even puck has this name.
    explorer = Component.of(TOLD, words | ({"even": 1} if values.get("even") else {}))
    told = replace(learned, held=believed, explorer=explorer, hours=None, behaviors=1)
    return replace(told, behaviors=len(_pushes(told)))


class ToldRun:
    """The table of a baseline in the form of a learning run; it takes no robot time.

    Args:
        spec: what `told_spec` gave.

    Attributes:
        calibration: none: nothing was seen.
        seconds: robot seconds that it took.
    """

    calibration = None
    seconds = 0.0

    def __init__(self, spec: LearningSpec) -> None:
        self._spec = spec

    def steps(self) -> Iterator[LearningStep]:
        """Yield each push that is believed to move the attractor."""
        yield from _pushes(self._spec)


def _pushes(spec: LearningSpec) -> tuple[LearningStep, ...]:
    """Return the pushes that a baseline is told."""
    # The physics engine: it is loaded only where there is a baseline.
    from affcli.baselines.beliefs.pushes import pushes

    return pushes(belief_of(spec))


def belief_of(spec: LearningSpec) -> "Belief":
    """Return what a baseline believes whose table is a function of `spec`; of several grasps it
    takes the first.
    """
    from affcli.baselines.beliefs.pushes import Belief

    settings, told = settings_of(spec), dict(spec.explorer.params)
    belief = Belief(
        *(spec.held, spec.binding, spec.repertoire, settings.workspace, settings.physics),
        *(settings.babbling, float(told["spacing"])),
    )
    return belief.told(float(told["friction"]), even=bool(told.get("even", 0)))
