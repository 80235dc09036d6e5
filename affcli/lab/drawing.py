"""Figures: what must be installed to draw them."""

import logging
import os
from importlib import import_module
from importlib.util import find_spec

from affcli.errors import UsageError

FIGURE_PACKAGES = ("matplotlib", "PIL")


def can_draw() -> bool:
    """Tell whether the packages which draw figures are installed."""
    return None not in map(find_spec, FIGURE_PACKAGES)


def require_figures() -> None:
    """Make sure that the packages which draw figures are installed, and load Matplotlib so that
    what is around the program decides nothing.

    A notebook exports the name of a backend, which programs that it starts may lack. Where nobody
    may write a cache, Matplotlib says so, each time.

    Raises:
        UsageError: one is missing.
    """
    if not can_draw():
        raise UsageError(
            "figures need Matplotlib and Pillow; install them: pip install 'affcli[figures]'"
        )
    os.environ.pop("MPLBACKEND", None)
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    import_module("matplotlib")
