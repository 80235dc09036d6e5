"""Public names of a package, each imported when it is first used."""

from collections.abc import Callable, Mapping
from importlib import import_module


def lazy_names(package: str, homes: Mapping[str, str]) -> Callable[[str], object]:
    """Return a module's ``__getattr__`` that imports a name from its home when it is first used.

    Args:
        package: the package that offers the names.
        homes: the module of the package that each name lives in.
    """

    def get(name: str) -> object:
        """Return the name's value; AttributeError when the package has no such name."""
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(import_module(f"{package}.{homes[name]}"), name)

    return get
