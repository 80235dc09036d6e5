"""Our pushes against the same pushes by other engines, each in an environment of its own."""

import hashlib
import json
import math
import statistics
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

from measuring import ROUNDS, Scale, Took, bar, ratios, took, verdict
from pushing import ours
from workload import DISTANCE, OUTLINES, SETTINGS, Push, touching, workload

PEERS = Path(__file__).with_name("peers")
ENVIRONMENTS = Path(__file__).parents[2] / ".venv" / "peers"
"""Where their environments are kept; `make clean` removes them too."""
PATIENCE = 900.0
"""Seconds that an installation may take."""


class Peer(NamedTuple):
    """Another engine.

    Args:
        name: of the line.
        packages: the file of its pinned packages, without the ending; its environment's name.
        words: the script and its options.
        least: the bar; None for a line without one.
        same_table: whether it pushes our puck with our tool.
    """

    name: str
    packages: str
    words: tuple[str, ...]
    least: float | None
    same_table: bool


OTHERS = (
    Peer("gym-pusht", "gym_pusht", ("push_gym_pusht.py",), 10.0, same_table=False),
    Peer(
        "gym-pusht, its physics alone",
        "gym_pusht",
        ("push_gym_pusht.py", "--space"),
        None,
        same_table=False,
    ),
    Peer("MuJoCo", "mujoco", ("push_mujoco.py",), 8.0, same_table=True),
    Peer("PyBullet", "pybullet", ("push_pybullet.py",), 8.0, same_table=True),
)


class CannotRunError(Exception):
    """The engine cannot be had here, and why."""


def bench_peers(scale: Scale) -> dict[str, Any]:
    """Batched pushes a second against each other engine, one core, in interleaved rounds."""
    pushes = touching(workload())[: scale.of(8_192, 8)]
    found: dict[str, Any] = {}
    for peer in OTHERS:
        try:
            found[peer.name] = _against(peer, pushes, scale.of(ROUNDS, 1))
        except CannotRunError as error:
            print(f"peers: {peer.name}: not measured: {error}")
            found[peer.name] = {"ratio": None, "reason": str(error), "bar": peer.least}
    return found


def _against(peer: Peer, pushes: Sequence[Push], rounds: int) -> dict[str, Any]:
    """Measure one engine."""
    size = len(pushes) // rounds
    own, theirs, apart = [], [], []
    went, moved = [], []
    with running(peer) as process:
        engine = ask(process, peer, table_of_ours())
        # One round that does not count: the first pushes warm everything.
        ask(process, peer, [_as_json(push) for push in pushes[:8]])
        for i in range(rounds):
            block = pushes[i * size : (i + 1) * size]
            time, ends = took(ours, block)
            own.append(time)
            answer = ask(process, peer, [_as_json(push) for push in block])
            theirs.append(Took(answer["seconds"], answer["cpu_seconds"]))
            moved.append(answer["moved"])
            for push, end, (dx, dy) in zip(block, ends, answer["moves"], strict=True):
                went.append(math.dist(end.point, push.puck.point))
                apart.append(math.hypot(push.puck.x + dx - end.x, push.puck.y + dy - end.y))
    wanted = statistics.mean(went) if peer.same_table else DISTANCE
    share = statistics.mean(moved) / wanted
    if not 0.85 <= share <= 1.15:
        raise CannotRunError(f"it moved the puck {share:.2f} times as far: not the same work")
    wall = ratios([t.wall for t in theirs], [t.wall for t in own])
    cpu = ratios([t.cpu for t in theirs], [t.cpu for t in own])
    held = {"bar": None} if peer.least is None else bar(cpu.median, least=peer.least)
    middle, most = statistics.median(apart), sorted(apart)[len(apart) * 9 // 10]
    near = f", ends {middle:.2f} in from ours in the median, 90 % within {most:.2f}"
    each = 1000.0 * statistics.median(t.cpu for t in theirs) / size
    mine = 1000.0 * statistics.median(t.cpu for t in own) / size
    print(
        f"peers: {peer.name}: we do {cpu} as many pushes a second (wall {wall.median:.3g}x; "
        f"{engine['engine']}, steps of {1000 * engine['step']:.3g} ms, {each:.2f} ms a push, ours "
        f"{mine:.2f}; {size * rounds} pushes, moved {share:.2f} times as far as "
        f"{'ours' if peer.same_table else 'the agent went'}{near if peer.same_table else ''}; "
        + ("no bar)" if peer.least is None else f"{verdict(held)})")
    )
    return {
        **cpu.json(),
        **held,
        "wall_ratio": wall.median,
        "engine": engine["engine"],
        "step_s": engine["step"],
        "ms_a_push": {"ours": mine, "theirs": each},
        "pushes": size * rounds,
        "moved_share": share,
        **({"apart_in": {"median": middle, "90 %": most}} if peer.same_table else {}),
    }


def table_of_ours() -> dict[str, Any]:
    """Return our table for those who know nothing of affcli: inches, seconds, kilograms."""
    workspace = SETTINGS.workspace
    return {
        "boxes": [part.bounds for part in OUTLINES],
        "thickness": workspace.tools.thickness,
        "puck": asdict(workspace.puck),
        "friction": asdict(workspace.friction),
        "distance": DISTANCE,
        "speed": workspace.motion.push_speed,
        "acceleration": workspace.motion.push_acceleration,
    }


def _as_json(push: Push) -> dict[str, Any]:
    """Return a push for those who know nothing of affcli."""
    return {"puck": push.puck.point, "wrist": push.wrist, "direction": push.direction}


@contextmanager
def running(peer: Peer) -> Iterator[subprocess.Popen[str]]:
    """Give the engine's process, in its environment; end it afterwards."""
    script, *options = peer.words
    words = [str(environment(peer)), str(PEERS / script), *options]
    with subprocess.Popen(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def ask(process: subprocess.Popen[str], peer: Peer, what: object) -> dict[str, Any]:
    """Say one line to an engine's process and return its answer.

    Raises:
        CannotRunError: it ended instead.
    """
    assert process.stdin is not None  # noqa: S101
    assert process.stdout is not None  # noqa: S101
    assert process.stderr is not None  # noqa: S101
    try:
        process.stdin.write(json.dumps(what) + "\n")
        process.stdin.flush()
        line = process.stdout.readline()
    except BrokenPipeError:
        line = ""
    if not line:
        process.kill()
        last = process.stderr.read().strip().splitlines()[-1:] or ["no word"]
        raise CannotRunError(f"{peer.words[0]} ended: {last[0]}")
    answer: dict[str, Any] = json.loads(line)
    return answer


def environment(peer: Peer) -> Path:
    """Return the Python of an engine's environment, made when it is not there as it should be.

    Raises:
        CannotRunError: it could not be made.
    """
    packages = PEERS / f"{peer.packages}.txt"
    folder = ENVIRONMENTS / peer.packages
    python, stamp = folder / "bin" / "python", folder / "made"
    wanted = hashlib.sha256(packages.read_bytes() + sys.version.encode()).hexdigest()
    if python.exists() and stamp.exists() and stamp.read_text(encoding="utf-8") == wanted:
        return python
    print(f"peers: installing {peer.packages} ...", file=sys.stderr)
    # Our pip does it: without one of its own an environment is there in a moment.
    _run(peer, [sys.executable, "-m", "venv", "--clear", "--without-pip", str(folder)])
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", str(python)]
    # Binaries only: what has none for this Python would take a compiler and an hour.
    options = ["-q", "--only-binary", ":all:", "--retries", "1", "-r", str(packages)]
    _run(peer, [*pip, "install", *options])
    stamp.write_text(wanted, encoding="utf-8")
    return python


def _run(peer: Peer, words: list[str]) -> None:
    """Run one step of an installation.

    Raises:
        CannotRunError: it failed, in one line.
    """
    try:
        ended = subprocess.run(words, capture_output=True, text=True, check=False, timeout=PATIENCE)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise CannotRunError(f"{peer.packages} could not be installed: {error}") from error
    if ended.returncode:
        lines = (ended.stderr or ended.stdout).strip().splitlines() or ["no word"]
        faults = [line for line in lines if line.startswith("ERROR")] or lines
        raise CannotRunError(f"{peer.packages} could not be installed: {faults[-1]}")
