"""The program where a package that it can do without is not installed."""

import subprocess
import sys

from tests.cli.program import PATIENCE, Arg, Ended, environment

WITHOUT = """
import sys
from importlib.machinery import PathFinder

hidden = sys.argv.pop(1)


class Finder(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        if name.partition(".")[0] == hidden:
            return None
        return super().find_spec(name, path, target)


sys.meta_path[sys.meta_path.index(PathFinder)] = Finder
from affcli.cli.main import main

sys.exit(main())
"""
"""The program where a package is not installed."""


def without(package: str, *args: Arg) -> Ended:
    """Run the program where a package is not installed."""
    ended = subprocess.run(
        [sys.executable, "-c", WITHOUT, package, *args],
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert "Traceback" not in ended.stderr, ended.stderr
    return Ended(ended.returncode, ended.stdout, ended.stderr)
