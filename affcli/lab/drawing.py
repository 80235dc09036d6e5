"""Figures: what must be installed to draw them."""

from importlib.util import find_spec

from affcli.errors import UsageError
from affcli.report.figures.loading import load_matplotlib

FIGURE_PACKAGES = ("matplotlib", "PIL")


def require_figures() -> None:
    """Make sure that the packages which draw figures are installed, and load Matplotlib.

    Raises:
        UsageError: one is missing.
    """
    missing = [name for name in FIGURE_PACKAGES if find_spec(name) is None]
    if missing:
        raise UsageError(
            "figures need Matplotlib and Pillow; install them: pip install 'affcli[figures]'"
        )
    load_matplotlib()
