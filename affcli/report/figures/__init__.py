"""Figures for a paper, in one look, by matplotlib's object API: returned, never saved.

Each is imported when it is first used: matplotlib takes 0.3 s, and need not be installed.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_modules

if TYPE_CHECKING:
    from affcli.report.figures import (
        adaptation,
        affordances,
        canvas,
        learning,
        prediction,
        results,
        row,
        tools,
        trial,
        workspace,
    )

__all__ = [
    "adaptation",
    "affordances",
    "canvas",
    "learning",
    "prediction",
    "results",
    "row",
    "tools",
    "trial",
    "workspace",
]

__getattr__ = lazy_modules(__name__, __all__)
