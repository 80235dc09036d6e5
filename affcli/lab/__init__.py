"""The composition root: wires the rooms; one file a use case, each with one function to call.

Each is imported when it is first used: a command's help does without SQLAlchemy and pymunk.
"""

from typing import TYPE_CHECKING

from affcli.lazy import lazy_modules

if TYPE_CHECKING:
    from affcli.lab import (
        adaptation,
        affordance_views,
        bench,
        breaking,
        film_strips,
        filming,
        learning,
        learning_curves,
        overview,
        page,
        photographs,
        predicting,
        replaying,
        reproduction,
        results,
        sensing,
        solving,
        table,
        verifying,
        viewing,
    )

__all__ = [
    "adaptation",
    "affordance_views",
    "bench",
    "breaking",
    "film_strips",
    "filming",
    "learning",
    "learning_curves",
    "overview",
    "page",
    "photographs",
    "predicting",
    "replaying",
    "reproduction",
    "results",
    "sensing",
    "solving",
    "table",
    "verifying",
    "viewing",
]

__getattr__ = lazy_modules(__name__, __all__)
