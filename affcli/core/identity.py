"""What makes two runs the same: named parts with what differs in them, and a key by hash.

A run is a pure function of its spec. The spec names each part by a `Component`: a versioned name
and the parameters that differ from the part's defaults. So a new parameter with a default changes
no key. The key of a spec is the SHA-256 of its canonical JSON.
"""

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from affcli.core.setting import Value
from affcli.errors import BadInputError, one_line

LONGEST_TEXT = 2_000
"""Letters of a part written as text; the longest that affcli writes has some 100."""

_NAME = re.compile(r"[a-z0-9][a-z0-9._-]*")
_KEY = re.compile(r"[a-z][a-z0-9_]*")
_PACKAGE = re.compile(r"[a-z0-9][a-z0-9-]{0,60}-[0-9][a-z0-9.+!]{0,40}")


@dataclass(frozen=True, slots=True)
class Component:
    """A part by its name, its version, and the parameters that differ from its defaults.

    Args:
        name: as the registry knows it: ``nested-query``.
        params: (name, value) pairs in alphabetical order, only those that are not the default.
        version: raised when the same parameters give other results.
        package: that it comes from, with its version, as `package_text` writes it; empty for parts
            of affcli itself.
    """

    name: str
    params: tuple[tuple[str, Value], ...] = ()
    version: int = 1
    package: str = ""

    @classmethod
    def of(
        cls, name: str, params: Mapping[str, Value], version: int = 1, package: str = ""
    ) -> "Component":
        """Build a component from a mapping of parameters."""
        return cls(name, tuple(sorted(params.items())), version, package)

    @classmethod
    def parse(cls, text: str) -> "Component":
        """Return the component that ``name:key=value,key=value`` stands for.

        A version other than 1 follows the name, and then the package of a plug-in with its version:
        ``name@2@package-1.0:key=value``.

        Raises:
            BadInputError: the text is not of this form.
        """
        form = f"{one_line(text, 60)!r} is not of the form name:key=value,key=value"
        head, colon, tail = text[: LONGEST_TEXT + 1].partition(":")
        name, *marks = head.split("@")
        version = int(marks.pop(0)) if marks and _is_version(marks[0]) else 1
        package = marks.pop(0) if marks and _PACKAGE.fullmatch(marks[0]) else ""
        if len(text) > LONGEST_TEXT or not _NAME.fullmatch(name) or marks:
            raise BadInputError(form)
        params: dict[str, Value] = {}
        for pair in tail.split(",") if colon else ():
            key, equals, value = pair.partition("=")
            if not (equals and value and _KEY.fullmatch(key)) or key in params:
                raise BadInputError(form)
            params[key] = _value(value)
        return cls.of(name, params, version, package)

    def __str__(self) -> str:
        """Write the component as `parse` reads it."""
        version = "" if self.version == 1 else f"@{self.version}"
        head = self.name + version + (f"@{self.package}" if self.package else "")
        pairs = [f"{key}={shown(value)}" for key, value in self.params]
        return f"{head}:{','.join(pairs)}" if pairs else head

    def canonical(self) -> dict[str, Any]:
        """Return the component as JSON types, for the key of a spec.

        A whole number is written without a fraction: 1 and 1.0 are equal, and so are their keys. A
        part of affcli itself has no package.
        """
        params = {
            key: int(value) if isinstance(value, float) and value.is_integer() else value
            for key, value in self.params
        }
        package = {"package": self.package} if self.package else {}
        return {"name": self.name, "params": params, "version": self.version, **package}


def package_text(name: str, version: str) -> str:
    """Return a package with its version as a component has them: ``my-planner-1.0``.

    As packages are compared: in lower case, with one kind of dash. What is no version begins with
    0.
    """
    plain = re.sub(r"[^a-z0-9.+!]+", ".", version.lower())[:36]
    numbered = plain if plain[:1].isdecimal() else f"0.{plain.strip('.')}"
    return f"{re.sub(r'[^a-z0-9]+', '-', name.lower()).strip('-')[:60]}-{numbered}"


def _is_version(text: str) -> bool:
    """Tell whether a text is the version of a part."""
    return text.isdecimal() and len(text) < 6


def shown(value: Value) -> str:
    """Write a parameter's value as short as it can be read back exactly."""
    if isinstance(value, str):
        return value
    short = f"{value:g}"
    return short if float(short) == value else repr(value)


def canonical_json(value: Any) -> str:
    """Return `value` as canonical JSON: equal values give equal text."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def key_of(canonical: Mapping[str, Any]) -> str:
    """Return the key of a spec: the SHA-256 of its canonical form (64 hexadecimal digits)."""
    return hashlib.sha256(canonical_json(canonical).encode()).hexdigest()


def stream_number(name: str) -> int:
    """Return the word of 32 bits by which a name enters the key of a random stream.

    It is the same everywhere and always.
    """
    return int.from_bytes(hashlib.sha256(name.encode()).digest()[:4], "big")


def _value(text: str) -> Value:
    """Return a number where the text is one, else the text."""
    if text.isdecimal() and text.isascii():
        return int(text)
    try:
        return text if "_" in text else float(text)  # Python takes 1_0 for a number
    except ValueError:
        return text
