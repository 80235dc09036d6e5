"""Make ``python -m affcli`` the same as ``affcli``."""

import sys

from affcli.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
