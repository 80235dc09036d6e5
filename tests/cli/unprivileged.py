"""Commands run by somebody who may not write: ``python -m tests.cli.unprivileged '[[...], ...]'``.

Root may write everywhere, so root is given up; what is imported late is imported first, for on some
systems the code cannot be read after that. For each command a line of JSON says how it ended: exit
code, stdout, stderr.
"""

import json
import os
import sys
import tempfile
from pathlib import Path

from tests.cli.warm import import_everything, run, warm_up
from tests.permissions import give_up_root


def run_all(commands: list[list[str]]) -> None:
    """Run the commands, each in a fork."""
    with tempfile.TemporaryDirectory() as folder:
        out, err = (Path(folder) / name for name in ("out", "err"))
        for args in commands:
            child = os.fork()
            if child == 0:
                streams = {"out": str(out), "err": str(err)}
                run({"args": args, "cwd": folder, "env": dict(os.environ), **streams})
            _, status = os.waitpid(child, 0)
            code = os.waitstatus_to_exitcode(status)
            sys.stdout.write(json.dumps([code, out.read_text(), err.read_text()]) + "\n")
            sys.stdout.flush()


if __name__ == "__main__":
    wanted = json.loads(sys.argv[1])
    import_everything()
    warm_up()
    give_up_root()
    run_all(wanted)
