"""Matplotlib, loaded so that what is around the program decides nothing."""

import logging
import os
from importlib import import_module


def load_matplotlib() -> None:
    """Import Matplotlib for a program whose figures are written to files and never shown.

    A notebook exports the name of a backend, which programs that it starts may lack. Where nobody
    may write a cache, Matplotlib says so, each time.
    """
    os.environ.pop("MPLBACKEND", None)
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    import_module("matplotlib")
