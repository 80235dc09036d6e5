"""Run a command and write, as JSON, how it went: for `measuring.command`.

A process of its own and a small one: Linux counts the memory of whoever starts a process to the
peak of what is started.
"""

import json
import os
import subprocess
import sys
import time


def main() -> None:
    """Run the command that the arguments are."""
    start = time.perf_counter()
    with subprocess.Popen(
        sys.argv[1:],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ) as process:
        out = process.stdout.read() if process.stdout is not None else ""
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
    unit = 1 if sys.platform == "darwin" else 1024
    last = out.strip().splitlines()[-1:] or ["no word"]
    went = {
        "code": process.returncode,
        "wall": wall,
        "cpu": usage.ru_utime + usage.ru_stime,
        "peak": usage.ru_maxrss * unit,
        "last": last[0],
    }
    json.dump(went, sys.stdout)


if __name__ == "__main__":
    main()
