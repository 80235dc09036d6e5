"""Affordances of tools, learned by a simulated robot that babbles (after Stoytchev, 2008).

A laboratory is a database. From Python:

    import affcli

    lab = affcli.Laboratory("my.db")
    run = lab.learn("t-hook", minutes=5)         # a robot plays with a tool
    rows = lab.rows(tool="t-hook").array()       # its affordance table, a NumPy structured array
    trials = lab.solve(goal=2, tool="t-hook")    # and uses it
    lab.experiment("experiments/extension_of_reach/friction.toml", workers=8)
    lab.compare("friction")                      # did it matter?
    lab.query("select * from affordance_table").pandas()

Each method of `Laboratory` does what the command of its name does (``affcli --help``), and returns
typed records (`LearningRunInfo`, `Invention`, `SolvedTrial`, `ExperimentResult`, `Comparison`,
`Effect`) and `Rows`. Errors are one line each: `AffcliError`, and of it `UsageError`,
`BadInputError`, `DatabaseError`. A notebook that goes from a blank table to a plot of one's own is
``experiments/tutorial/tutorial.ipynb``. All of it loads when it is first used.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0.dev0"

__all__ = ["Laboratory", "Rows", "__version__"]
"""What the help is about; the names of records and errors are there too."""

_HOMES = {
    "analysis.experiment": ("ExperimentResult",),
    "analysis.paired": ("Comparison",),
    "api.laboratory": ("Laboratory",),
    "api.rows": ("Rows",),
    "core.effects": ("Effect",),
    "core.invention": ("Invention",),
    "core.records": ("LearningRunInfo",),
    "errors": ("AffcliError", "BadInputError", "DatabaseError", "UsageError"),
    "lab.solving": ("SolvedTrial",),
}
"""Which file each public name lives in."""


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for."""
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """Return the public names, loaded or not."""
    return sorted({*globals(), *(name for names in _HOMES.values() for name in names)})
