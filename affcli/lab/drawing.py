"""What figures need beside affcli itself."""

from importlib.util import find_spec

from affcli.errors import UsageError


def require_figures() -> None:
    """Make sure that matplotlib is installed.

    Raises:
        UsageError: it is missing.
    """
    if find_spec("matplotlib") is None:
        raise UsageError("figures need matplotlib; install it: pip install 'affcli[figures]'")
