"""The scripts behind `make bench`: that they run. How fast anything is, no test asks."""

import json
import math
import os
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from statistics import median
from typing import Any

import pytest

from tests.cli.program import PATIENCE, ROOT

SPEED = ROOT / "experiments" / "speed"
QUICK = ("pushes", "loop", "query", "storing", "hours", "growth", "compare")


def bench(
    target: Path, *names: str, speed: Path = SPEED, **environment: str
) -> tuple[dict[str, Any], str]:
    """Run some benchmarks at their smallest; return the figures and what was printed."""
    ended = subprocess.run(
        [sys.executable, speed / "bench.py", "--tiny", "--json", target, *names],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
        env=os.environ | environment,
    )
    assert ended.returncode == 0, ended.stderr
    return json.loads(target.read_text(encoding="utf-8")), ended.stdout


def test_the_quick_benchmarks_run_and_write_what_they_print(tmp_path: Path) -> None:
    """And pushes in steps of their own, and those in C, end where ours end."""
    figures, out = bench(tmp_path / "figures.json", *QUICK)
    assert set(figures) == {"machine", *QUICK}
    assert {line.partition(":")[0] for line in out.splitlines()} == set(QUICK)
    assert figures["pushes"]["whole"]["identical"]
    if shutil.which("cc") or shutil.which("gcc"):
        assert figures["loop"]["identical"]
    else:
        assert "no C compiler" in out


def test_quick_pushes_end_where_plain_ones_end(
    monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """Start just before contact, strides while it lasts, stop at rest, one world for all: against a
    Space for each push and one step size. Over half of the workload the median is 4e-4 in, 99 % lie
    within 0.015 and the largest is 0.017: for the most part the error of a step size of 1/512 s."""
    monkeypatch.syspath_prepend(SPEED)
    plain, workload = import_module("plain"), import_module("workload")
    request.addfinalizer(lambda: [sys.modules.pop(name) for name in ("plain", "workload")])
    world, touched = workload.simulator(), []
    for push in workload.workload()[:2000]:
        mine, theirs = world.push(*push), plain.push_plainly(push)
        assert (mine == push.puck) == (theirs == push.puck)
        if mine != push.puck:
            touched.append(math.dist(mine.point, theirs.point))
            assert mine.angle == pytest.approx(theirs.angle, abs=0.05)
    assert len(touched) > 150
    assert max(touched) < 0.02
    assert median(touched) < 1e-3


def test_without_a_compiler_the_loop_in_c_is_said_to_be_missing(tmp_path: Path) -> None:
    figures, out = bench(tmp_path / "figures.json", "loop", PATH=str(tmp_path))
    assert figures["loop"]["ratio"] is None
    assert out == f"loop: not measured: {figures['loop']['reason']}\n"


@pytest.mark.torture
def test_engines_that_cannot_be_installed_are_named_and_the_rest_goes_on(tmp_path: Path) -> None:
    copied = tmp_path / "experiments" / "speed"
    shutil.copytree(SPEED, copied)
    nowhere = {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": "", "PIP_CONFIG_FILE": os.devnull}
    figures, out = bench(tmp_path / "figures.json", "peers", "storing", speed=copied, **nowhere)
    assert "storing: " in out
    for name, peer in figures["peers"].items():
        assert peer["ratio"] is None
        assert "could not be installed" in peer["reason"]
        assert f"peers: {name}: not measured: {peer['reason']}" in out


def test_an_unknown_benchmark_is_refused(tmp_path: Path) -> None:
    ended = subprocess.run(
        [sys.executable, SPEED / "bench.py", "fastest"],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert ended.returncode == 2
    assert "no such benchmark: fastest" in ended.stderr
