"""The program: ``affcli``, or ``python -m affcli``."""

import signal
import sys


def main() -> int:
    """Run the program and return its exit code."""
    # Python's own handler would end the first imports in a traceback; the program brings another.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from affcli.cli.main import main as run  # noqa: PLC0415

    return run()


if __name__ == "__main__":
    sys.exit(main())
