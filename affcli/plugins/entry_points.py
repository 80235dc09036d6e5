"""What the installed packages offer, read without importing any of it."""

from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points

from affcli.core.identity import package_text
from affcli.core.part import Kind
from affcli.errors import PartFailedError, one_line

GROUP = "affcli."
"""Before the kind of a part, it is the group of its entry points."""


@dataclass(frozen=True, slots=True)
class Offer:
    """A part that a package offers.

    Args:
        kind: what it is one of.
        name: by which it is asked for.
        value: where it is, ``module:attribute``.
        package: the package with its version, as in `Component`.
    """

    kind: Kind
    name: str
    value: str
    package: str

    @property
    def words(self) -> str:
        """What it is called in messages."""
        return f"{self.kind.removesuffix('s')} {one_line(self.name, 40)} of {self.package}"

    def refused(self, why: str) -> PartFailedError:
        """Return the error that says why it cannot be used."""
        return PartFailedError(f"{self.words}: {why}")

    @property
    def entry_point(self) -> EntryPoint:
        """Its entry point, to be loaded."""
        return EntryPoint(self.name, self.value, GROUP + self.kind)


def offers(kind: Kind) -> list[Offer]:
    """Return what packages offer of a kind, by name."""
    found = [
        Offer(kind, one.name, one.value, package_text(one.dist.name, one.dist.version))
        for one in entry_points(group=GROUP + kind)
        if one.dist is not None
    ]
    return sorted(found, key=lambda one: (one.name, one.package))
