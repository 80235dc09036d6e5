"""A part by name: what it is, its parameters with unit and limits, its source, how it is made."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from affcli.core.identity import Component, Value, shown
from affcli.errors import BadInputError, one_line

Kind = Literal[
    "tools", "bindings", "behaviors", "explorers", "planners", "sensors", "tasks", "worlds"
]
"""What a part is one of."""


@dataclass(frozen=True, slots=True)
class Param:
    """One parameter of a part.

    Args:
        name: of the parameter.
        default: its value where none is given; None where the settings of a run decide.
        unit: of its value; empty for a share or a count.
        low, high: the limits within which it lies.
        meaning: what it is, in words.
        whole: it is a whole number.
    """

    name: str
    default: float | None
    unit: str
    low: float
    high: float
    meaning: str
    whole: bool = False

    def checked(self, value: Value, owner: str) -> float:
        """Return the value as a float; BadInputError naming key, limits and unit if it is wrong."""
        number = isinstance(value, int | float) and not isinstance(value, bool)
        fits = number and self.low <= float(value) <= self.high
        if not fits or (self.whole and float(value) != round(float(value))):
            unit = f" {self.unit}" if self.unit else ""
            wanted = "a whole number " if self.whole else ""
            raise BadInputError(
                f"{owner}:{self.name}={one_line(shown(value), 40)}: must be {wanted}in "
                f"[{self.low:g}, {self.high:g}]{unit}"
            )
        return float(value)


@dataclass(frozen=True, slots=True)
class Part:
    """One entry of the registry.

    Args:
        kind: what it is one of.
        name: by which it is asked for and recorded.
        summary: what it is, in a sentence.
        source: where it comes from: ``Stoytchev 2008, §6.2``, or who added it.
        build: makes it; called with what its kind needs and then with its parameters by name.
        params: its parameters.
        version: raised when the same parameters give other results.
    """

    kind: Kind
    name: str
    summary: str
    source: str
    build: Callable[..., Any]
    params: tuple[Param, ...] = ()
    version: int = 1

    def component(self, given: Mapping[str, Value]) -> Component:
        """Return the component of these parameters: without those that are the default.

        Raises:
            BadInputError: an unknown parameter, or a value out of its limits.
        """
        known = {param.name: param for param in self.params}
        differing: dict[str, Value] = {}
        for name, value in given.items():
            if name not in known:
                has = f"it has {', '.join(known)}" if known else "it has none"
                raise BadInputError(f"{self.name}: no parameter {one_line(name, 40)}; {has}")
            checked = known[name].checked(value, self.name)
            if checked != known[name].default:
                differing[name] = checked
        return Component.of(self.name, differing, self.version)

    def values(self, component: Component) -> dict[str, Any]:
        """Return all parameters by name: those of the component, else the defaults.

        One whose default the settings decide is left out unless it is given.
        """
        own = self.component(dict(component.params))
        given = dict(own.params)
        values = {p.name: given.get(p.name, p.default) for p in self.params}
        whole = {p.name for p in self.params if p.whole}
        return {
            name: int(value) if name in whole else value
            for name, value in values.items()
            if value is not None
        }
