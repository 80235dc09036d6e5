"""How fast is affcli? Ratios measured side by side in one run; medians of interleaved rounds.

    make bench
    .venv/bin/python experiments/speed/bench.py [--json FILE] [--full] [NAME ...]

A speed is only worth something beside another on the same machine at the same time, so every line
is a ratio against another way of doing the same work, unless it says otherwise. README.md beside
this file says what each line measures.
"""

import argparse
import json
import os
import platform
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from camera_eye import bench_camera
from comparing import bench_compare
from many import bench_cluster, bench_memory, bench_writer
from measuring import Scale
from other_engines import bench_peers
from pushing import bench_loop, bench_pushes
from row_choice import bench_planning, bench_query
from storing import bench_growth, bench_hours, bench_storing
from whole_commands import bench_learn, bench_reproduce, bench_workers

BENCHES: dict[str, Callable[[Scale], dict[str, Any]]] = {
    "pushes": bench_pushes,
    "loop": bench_loop,
    "peers": bench_peers,
    "query": bench_query,
    "planning": bench_planning,
    "storing": bench_storing,
    "hours": bench_hours,
    "growth": bench_growth,
    "learn": bench_learn,
    "compare": bench_compare,
    "camera": bench_camera,
    "workers": bench_workers,
    "cluster": bench_cluster,
    "memory": bench_memory,
    "writer": bench_writer,
    "reproduce": bench_reproduce,
}


def main() -> None:
    """Run the benchmarks that were asked for, all of them by default."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(BENCHES) + "; or all")
    parser.add_argument("--json", type=Path, help="write the figures there too")
    parser.add_argument("--full", action="store_true", help="the long ones too: an hour")
    parser.add_argument("--tiny", action="store_true", help="only to see that everything runs")
    args = parser.parse_args()
    unknown = [name for name in args.names if name not in BENCHES]
    if unknown:
        parser.error(f"no such benchmark: {unknown[0]}; there are {', '.join(BENCHES)}")
    scale = Scale(args.full, args.tiny)
    results: dict[str, Any] = {"machine": machine()}
    for name in args.names or BENCHES:
        results[name] = BENCHES[name](scale)
        # After each one: a run takes a while, and what is measured is not to be lost.
        if args.json:
            args.json.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")


def machine() -> dict[str, Any]:
    """Return when and on what this runs; the load tells whether it was alone."""
    return {
        "date": datetime.now(UTC).isoformat(timespec="minutes"),
        "machine": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
    }


if __name__ == "__main__":
    main()
