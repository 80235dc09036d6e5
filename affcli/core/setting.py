"""A setting: a field of a dataclass that says what it means, its unit and what it may be."""

from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

from affcli.errors import BadInputError, one_line

LARGEST, SMALLEST = 1e6, 1e-3
"""No length, speed, time or count of this laboratory lies beyond them."""

Value = float | int | str
"""What a setting can be. A stored setting is one of these in JSON."""

V = TypeVar("V", bound=Value)


@dataclass(frozen=True, slots=True)
class Setting:
    """What a setting means, and what it may be.

    Args:
        default: its value when nothing else is said; a whole number makes it a count.
        unit: of its value, as ``in`` or ``in/s``; empty without one.
        meaning: one or two sentences for a person.
        low, high: the least and the largest number it may be.
        choices: the words it may be; empty for a number.
    """

    default: Value
    unit: str
    meaning: str
    low: float
    high: float
    choices: tuple[str, ...] = ()

    @property
    def limits(self) -> str:
        """Return what it may be in words: ``0 to 10``, or the choices."""
        numbers = f"{self.low:g} to {self.high:g}"
        return ", ".join(self.choices) or numbers.replace("e+0", "e").replace("e-0", "e-")

    def refusal(self, value: object) -> str:
        """Return why it may not be `value`, as ``must lie in [0, 10] (in)``; empty if it may."""
        if self.choices:
            return "" if value in self.choices else f"must be one of {', '.join(self.choices)}"
        limits = f"in [{self.low:g}, {self.high:g}]" + (f" ({self.unit})" if self.unit else "")
        whole = isinstance(self.default, int)
        if isinstance(value, bool) or not isinstance(value, int if whole else int | float):
            return f"must be {'a whole number' if whole else 'a number'} {limits}"
        return "" if self.low <= value <= self.high else f"must lie {limits}"

    def checked(self, value: object, place: str) -> Value:
        """Return `value` in the one form that equal values have: a length 2 is 2.0.

        Args:
            value: what someone wrote.
            place: where, for the message: ``config my.toml: sensor.position_noise``.

        Raises:
            BadInputError: it may not be that; the message tells the limits and the unit.
        """
        refusal = self.refusal(value)
        if refusal:
            raise BadInputError(f"{place} = {one_line(value)} {refusal}")
        return self.canonical(value)

    def canonical(self, value: Any) -> Value:
        """Return a value that it may be in the one form that equal values have."""
        kind = type(self.default)
        # Adding zero makes -0.0 into 0.0: they are equal, and so must be their texts.
        return kind(value) + 0.0 if kind is float else kind(value)


def setting(
    default: V,
    unit: str,
    meaning: str,
    *,
    low: float | None = None,
    high: float = LARGEST,
    choices: tuple[str, ...] = (),
) -> V:
    """Return the field of a dataclass that is a `Setting`.

    Without `low` a count is at least 1 and any other number at least `SMALLEST`.
    """
    least = (1 if isinstance(default, int) else SMALLEST) if low is None else low
    about = Setting(default, unit, meaning, least, high, choices)
    return field(default=default, metadata={"setting": about})


def settings_of(part: type[Any]) -> dict[str, Setting]:
    """Return the settings of a dataclass by the names of their fields."""
    return {f.name: f.metadata["setting"] for f in fields(part) if "setting" in f.metadata}
