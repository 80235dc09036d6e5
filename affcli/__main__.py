"""The program: ``affcli``, or ``python -m affcli``."""

import os
import signal
import sys


def main() -> int:
    """Run the program and return its exit code."""
    # Python's own handler would end the first imports in a traceback; the program brings another.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # What is computed here is small. Each thread that NumPy's OpenBLAS begins for large matrices
    # takes memory, and where it cannot begin one it sends ctrl-C.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from affcli.cli.main import main as run  # noqa: PLC0415

    return run()


if __name__ == "__main__":
    sys.exit(main())
