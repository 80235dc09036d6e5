"""What the scripts of this folder share: no affcli here, and nothing beyond Python itself.

A script reads JSON lines: first the table (sizes in inches, seconds, kilograms), then again and
again a list of pushes, each answered by one JSON line: how many pushes, how long they took (seconds
on the wall and of the processor), and by how much and whereto the puck moved.
"""

import json
import math
import sys
import time
from collections.abc import Callable
from typing import Any

Push = dict[str, Any]
Move = tuple[float, float]
PushAll = Callable[[list[Push]], list[Move]]
"""Do the pushes; return by how much the puck moved in each (in, table frame)."""


def serve(engine: str, step: float, begin: Callable[[dict[str, Any]], PushAll]) -> None:
    """Answer until there are no more lines.

    Args:
        engine: name and version.
        step: its time step (s).
        begin: makes the world, which is not counted; gives what does the pushes.
    """
    push_all = begin(json.loads(sys.stdin.readline()))
    say({"engine": engine, "step": step})
    for line in sys.stdin:
        pushes = json.loads(line)
        cpu, wall = time.process_time(), time.perf_counter()
        moves = push_all(pushes)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        say(
            {
                "pushes": len(pushes),
                "seconds": wall,
                "cpu_seconds": cpu,
                "moved": sum(math.hypot(*move) for move in moves) / len(moves),
                "moves": moves,
            }
        )


def say(answer: dict[str, Any]) -> None:
    """Write one line."""
    print(json.dumps(answer), flush=True)


def travels(table: dict[str, Any], step: float) -> list[float]:
    """Return how far the tool has gone after each step, up to its stop (in)."""
    distance, speed, rate = table["distance"], table["speed"], table["acceleration"]
    ramp, whole = speed / rate, distance / speed + speed / rate
    gone = []
    for k in range(1, math.ceil(whole / step - 1e-9) + 1):
        t = min(k * step, whole)
        if t <= ramp:
            gone.append(0.5 * rate * t * t)
        elif t <= whole - ramp:
            gone.append(speed * (t - 0.5 * ramp))
        else:
            gone.append(distance - 0.5 * rate * (whole - t) ** 2)
    return gone
