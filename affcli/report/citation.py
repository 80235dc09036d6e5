"""How to cite the paper and this software, in BibTeX.

`CITATION.cff` says the same of the software to GitHub and Zenodo; it is not in the wheel.
"""

from collections.abc import Iterable, Mapping

from affcli import __version__
from affcli.core.log import LogSource
from affcli.errors import one_line

PAPER = {
    "author": "Stoytchev, Alexander",
    "title": "Learning the Affordances of Tools Using a Behavior-Grounded Approach",
    "booktitle": "Towards Affordance-Based Robot Control",
    "series": "Lecture Notes in Artificial Intelligence",
    "volume": "4760",
    "publisher": "Springer",
    "year": "2008",
}
SOFTWARE = {
    "author": "{affcli contributors}",
    "title": "affcli: a command-line lab for learning the affordances of tools",
    "version": __version__,
    "year": "2026",
}
LONGEST_NOTE = 2_000
"""Letters of what is said of a log."""
SPECIAL = "\\{}$&#%_^~"
"""Characters that mean something to TeX; a version or a name is written without them."""


def bibtex(made_with: Iterable[Mapping[str, str]] = (), logs: Iterable[LogSource] = ()) -> str:
    """Return the two entries, and one of each log.

    Args:
        made_with: names and versions of what results were made with; each set of them stands once
            in the note of the software's entry.
        logs: that were imported; each stands once.
    """
    sets = dict.fromkeys(
        ", ".join(f"{_plain(name)} {_plain(version)}" for name, version in one.items())
        for one in made_with
    )
    note = {"note": f"Results made with {'; and with '.join(sets)}"} if sets else {}
    return "\n".join(
        (
            _entry("incollection", "stoytchev2008affordances", PAPER),
            _entry("software", "affcli", {**SOFTWARE, **note}),
            *(_entry("misc", f"log{n}", one) for n, one in enumerate(_distinct(logs), 1)),
        )
    )


def _distinct(logs: Iterable[LogSource]) -> list[dict[str, str]]:
    """Return what is said of each log, once."""
    found = []
    for log in logs:
        said = {"title": log.source, "note": log.citation, "howpublished": log.licence}
        fields = {name: _plain(text, LONGEST_NOTE) for name, text in said.items() if text}
        if fields not in found:
            found.append(fields)
    return found


def _entry(kind: str, key: str, fields: Mapping[str, str]) -> str:
    lines = [f"  {name} = {{{value}}}," for name, value in fields.items()]
    return "\n".join([f"@{kind}{{{key},", *lines, "}\n"])


def _plain(text: str, longest: int = 60) -> str:
    """Return text from a database without what TeX would take for a command."""
    return "".join(" " if letter in SPECIAL else letter for letter in one_line(text, longest))
