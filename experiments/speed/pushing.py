"""Pushes: ours against the plain loop, and against the same loop in C."""

import math
import statistics
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from c_loop import CannotBuildError, LoopInC, Prepared
from measuring import ROUNDS, Scale, Took, bar, ratios, took, verdict
from plain import push_plainly
from workload import Push, simulator, touching, workload

from affcli.core.geometry import Pose

WORLD = simulator()


def ours(pushes: Sequence[Push]) -> list[Pose]:
    """Return where the puck comes to rest in each push, done as the robot does them."""
    return [WORLD.push(*push) for push in pushes]


def whole(pushes: Sequence[Push]) -> list[Pose]:
    """Return where it comes to rest when every push has its own Space and no step is left out."""
    return [simulator().push(*push, whole=True) for push in pushes]


def plainly(pushes: Sequence[Push]) -> list[Pose]:
    """Return where it comes to rest in a loop as one would write it in pymunk."""
    return [push_plainly(push) for push in pushes]


def bench_pushes(scale: Scale) -> dict[str, Any]:
    """Our pushes against a plain loop in pymunk, and against all of the steps that we leave out."""
    pushes = workload()
    size = scale.of(len(pushes) // ROUNDS, 16)
    times: dict[str, list[float]] = {}
    touched, equal, apart = 0, True, [0.0]
    for i in range(scale.of(ROUNDS, 1)):
        block = pushes[i * size : (i + 1) * size]
        ends = {}
        for work in (ours, plainly, whole):
            time, ends[work] = took(work, block)
            times.setdefault(work.__name__, []).append(time.cpu)
        equal &= ends[ours] == ends[whole]
        for mine, theirs, push in zip(ends[ours], ends[plainly], block, strict=True):
            if theirs != push.puck or mine != push.puck:
                touched += 1
                apart.append(distance(mine, theirs))
    share = touched / (size * len(times["ours"]))
    plain, same = ratios(times["plainly"], times["ours"]), ratios(times["whole"], times["ours"])
    bars = bar(plain.median, least=16.0), bar(same.median, least=8.0)
    print(
        f"pushes: {plain} a plain pymunk loop that builds a Space for each and simulates all of it "
        f"({size * len(times['ours'])} behaviors, {100 * share:.1f} % touch; ends at most "
        f"{max(apart):.2g} in apart; {verdict(bars[0])})"
    )
    print(
        f"pushes: {same} the same steps with none left out and a Space for each, "
        f"{'bit-identical' if equal else 'NOT IDENTICAL'} ({verdict(bars[1])})"
    )
    return {
        "plain": {**plain.json(), **bars[0], "most_apart_in": max(apart)},
        "whole": {**same.json(), **bars[1], "identical": equal},
        "touch_share": share,
    }


def distance(a: Pose, b: Pose) -> float:
    """Return how far apart two poses are (in)."""
    return math.dist(a.point, b.point)


def bench_loop(scale: Scale) -> dict[str, Any]:
    """Touched pushes a second in one world, ours against the same loop in C."""
    pushes = touching(workload())[: scale.of(8_192, 8)]
    try:
        with tempfile.TemporaryDirectory() as folder:
            return _against_c(LoopInC(Path(folder)), pushes, scale)
    except CannotBuildError as error:
        print(f"loop: not measured: {error}")
        return {"ratio": None, "reason": str(error), "bar": 0.35}


def _against_c(loop: LoopInC, pushes: Sequence[Push], scale: Scale) -> dict[str, Any]:
    """Measure, and compare where the pucks came to rest."""
    rounds = scale.of(ROUNDS, 1)
    size = len(pushes) // rounds
    own, theirs, steps, identical = [], [], 0, True
    apart: list[float] = []
    for i in range(rounds):
        block = pushes[i * size : (i + 1) * size]
        prepared = Prepared(block)
        time, mine = took(ours, block)
        own.append(time)
        time, done = took(loop.push, prepared)
        theirs.append(time)
        steps += done
        identical &= prepared.poses == [WORLD.push(*push, finer=1) for push in block]
        apart += map(distance, prepared.poses, mine)
    if not identical:
        raise AssertionError("the loop in C ends elsewhere than the same steps in Python")
    pushed = size * rounds
    ratio = ratios([t.cpu for t in theirs], [t.cpu for t in own])
    held = bar(ratio.median, least=0.35)
    each = {"ours": ms(own, size), "c": ms(theirs, size)}
    print(
        f"loop: touched pushes a second, one world: {ratio} the loop in C of short steps "
        f"({pushed} pushes of 5 in, {steps / pushed:.0f} steps each, {each['c']:.3f} ms, ours "
        f"{each['ours']:.3f}; ends at most {max(apart):.2g} in apart, equal to the bit to the same "
        f"steps in Python; {verdict(held)})"
    )
    return {
        **ratio.json(),
        **held,
        "pushes": pushed,
        "most_apart_in": max(apart),
        "steps_a_push": steps / pushed,
        "ms_a_push": each,
        "identical": identical,
    }


def ms(times: Sequence[Took], size: int) -> float:
    """Return the median milliseconds of the processor for each of `size` pushes."""
    return 1000.0 * statistics.median(one.cpu for one in times) / size
