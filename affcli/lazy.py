"""Modules of a package, each imported when it is first used."""

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType


def lazy_modules(package: str) -> Callable[[str], ModuleType]:
    """Return a package's ``__getattr__``, which imports a module of it when it is first used.

    So who uses the package imports it at the top, and waits for a library, or has it at all, only
    where it is needed.
    """

    def module(name: str) -> ModuleType:
        """Return a module of the package; AttributeError when it has none of this name."""
        if find_spec(f"{package}.{name}") is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return import_module(f"{package}.{name}")

    return module
