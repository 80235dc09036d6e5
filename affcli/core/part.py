"""A part by name: what it is, its parameters with unit and limits, its source, how it is made."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from affcli.core.identity import Component
from affcli.core.setting import Setting, Value
from affcli.errors import BadInputError, one_line

Kind = Literal[
    "tools", "bindings", "behaviors", "explorers", "planners", "sensors", "tasks", "worlds"
]
"""What a part is one of."""


@dataclass(frozen=True, slots=True)
class Part:
    """One entry of the registry.

    Args:
        kind: what it is one of.
        name: by which it is asked for and recorded.
        summary: what it is, in a sentence.
        source: where it comes from: ``Stoytchev 2008, §6.2``, or who added it.
        build: makes it; called with what its kind needs and then with its parameters by name. (Of a
            sensor it is only named here: `simulation.sensing` makes the three that there are.)
        params: its parameters by name.
        version: raised when the same parameters give other results.
        told: it is told what no robot sees, and stands beside robots to be compared with them.
        package: that it comes from, as in `Component`; empty for parts of affcli itself.
    """

    kind: Kind
    name: str
    summary: str
    source: str
    build: Callable[..., Any]
    params: Mapping[str, Setting] = field(default_factory=dict)
    version: int = 1
    told: bool = False
    package: str = ""

    def checked(self, given: Mapping[str, Value]) -> dict[str, Value]:
        """Return parameters that someone gave, each in the one form that equal values have.

        Raises:
            BadInputError: an unknown parameter; a value out of its limits, which are named with the
                unit.
        """
        for name in given:
            if name not in self.params:
                has = f"it has {', '.join(self.params)}" if self.params else "it has none"
                raise BadInputError(f"{self.name}: no parameter {one_line(name, 40)}; {has}")
        return {
            name: self.params[name].checked(value, f"{self.name}: {name}")
            for name, value in given.items()
        }

    def component(self, given: Mapping[str, Value]) -> Component:
        """Return the component of these parameters: without those that are the default.

        Raises:
            BadInputError: as `checked`.
        """
        differing = {
            name: value
            for name, value in self.checked(given).items()
            if value != self.params[name].default
        }
        return Component.of(self.name, differing, self.version, self.package)

    def values(self, component: Component) -> dict[str, Value]:
        """Return all parameters by name: those of the component, else the defaults."""
        usual = {name: one.default for name, one in self.params.items()}
        return {**usual, **self.checked(dict(component.params))}
