"""How fast is affcli? Ratios measured side by side in one run; medians of interleaved rounds.

    make bench
    .venv/bin/python experiments/bench.py [--json FILE] [--full] [NAME ...]

A speed is only worth something beside another on the same machine at the same time, so every line
is a ratio against the plain way of doing the same work, unless it says otherwise.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from affcli.config import Settings, with_sensor
from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import EXTEND_ARM, GRASP, BehaviorCall
from affcli.core.geometry import Point, Pose, near_any
from affcli.core.observation import Observation
from affcli.core.task import GoalRegion
from affcli.core.tool import paper_tools
from affcli.core.trial import LearningSpec
from affcli.lab.learning import LearningRun
from affcli.lab.sensing import eye_of
from affcli.perception.camera_sensor import Eye
from affcli.perception.palette import ColorClass
from affcli.perception.rendering import Picture
from affcli.planning.nested_query import choose_row
from affcli.simulation.pushing import PushSimulator
from affcli.simulation.robot import SimulatedRobot
from affcli.simulation.world import World
from affcli.simulation.wrist_motion import Stretch, on_grid, trapezoid

WORKLOAD = 8_192
WORKLOAD_SEED = 20_080_219
ROUNDS = 8
IMPORTS = "import numpy, sqlalchemy, pymunk, rich, typer"

Push = tuple[Pose, Point, Point, tuple[Stretch, ...]]


def main() -> None:
    """Run the benchmarks that were asked for, all of them by default."""
    benches: dict[str, Callable[[bool], dict[str, Any]]] = {
        "pushes": bench_pushes,
        "learn": bench_learn,
        "query": bench_query,
        "camera": bench_camera,
        "reproduce": bench_reproduce,
    }
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", choices=[*benches, []], help="which; all by default")
    parser.add_argument("--json", type=Path, help="write the figures there too")
    parser.add_argument("--full", action="store_true", help="200 and 1,000 robots: 20 minutes")
    args = parser.parse_args()
    results = {}
    for name in args.names or benches:
        results[name] = benches[name](args.full)
    if args.json:
        args.json.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")


def workload(settings: Settings) -> list[Push]:
    """Return the fixed workload: random behaviors of the T-hook, about 12 % of which touch."""
    rng = np.random.default_rng(WORKLOAD_SEED)
    motion = settings.workspace.motion
    outlines = paper_tools(settings.workspace.tools)["t-hook"].outlines  # type: ignore[index]
    directions = (Point(0.0, 1.0), Point(0.0, -1.0), Point(-1.0, 0.0), Point(1.0, 0.0))
    pushes: list[Push] = []
    while len(pushes) < WORKLOAD:
        x, y, dx, dy = rng.random(4).tolist()
        wrist = Point(on_grid(-12.0 + 24.0 * x), on_grid(4.0 + 12.0 * y))
        offset = Point(-13.0 + 26.0 * dx, 2.0 + 24.0 * dy)
        direction = directions[int(rng.integers(4))]
        distance = (2.0, 5.0)[int(rng.integers(2))]
        if near_any(outlines, offset, settings.workspace.puck.radius):
            continue
        stretches = trapezoid(distance, motion.push_speed, motion.push_acceleration)
        puck = Pose(wrist.x + offset.x, wrist.y + offset.y)
        pushes.append((puck, wrist, direction, stretches))
    return pushes


def bench_pushes(_full: bool) -> dict[str, Any]:
    """Our pushes against a loop that builds a Space for each and simulates every step of it."""
    settings = Settings()
    workspace = settings.workspace
    outlines = paper_tools(workspace.tools)["t-hook"].outlines  # type: ignore[index]

    def simulator() -> PushSimulator:
        return PushSimulator(outlines, workspace.puck, workspace.friction, settings.physics)

    pushes = workload(settings)
    ours = simulator()
    ratios, touched, equal = [], 0, True
    size = len(pushes) // ROUNDS
    for i in range(ROUNDS):
        block = pushes[i * size : (i + 1) * size]
        start = time.perf_counter()
        mine = [ours.push(*push) for push in block]
        middle = time.perf_counter()
        theirs = [simulator().push(*push, whole=True) for push in block]
        quick, plain = middle - start, time.perf_counter() - middle
        equal &= mine == theirs
        touched += sum(end != push[0] for end, push in zip(mine, block, strict=True))
        ratios.append(plain / quick)
    ratio = statistics.median(ratios)
    print(
        f"pushes: {ratio:.1f}x a loop that builds a Space for each and simulates all of it "
        f"({len(pushes)} behaviors, {100 * touched / len(pushes):.1f} % touch, "
        f"{'bit-identical' if equal else 'NOT IDENTICAL'}; bar: 8x)"
    )
    return {"ratio": ratio, "touch_share": touched / len(pushes), "identical": equal, "bar": 8.0}


def bench_learn(_full: bool) -> dict[str, Any]:
    """`affcli learn` as a whole process against importing the libraries it stands on."""
    affcli = Path(sys.executable).with_name("affcli")
    imports, learns, helps = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for i in range(ROUNDS + 1):
            command = [str(affcli), "learn", "--tool", "t-hook", "--db", f"{folder}/{i}.db"]
            imports.append(process_time([sys.executable, "-c", IMPORTS]))
            learns.append(process_time(command))
            helps.append(process_time([str(affcli), "--help"]))
    # The first round warms the file cache and the byte code.
    base, learn, aid = (statistics.median(times[1:]) for times in (imports, learns, helps))
    print(
        f"learn: one robot hour as a whole process, new database, is {learn / base:.2f}x of "
        f'"{IMPORTS}" ({1000 * base:.0f} ms; bar: 2.5x); --help {aid / base:.2f}x'
    )
    return {"ratio": learn / base, "imports_s": base, "help_ratio": aid / base, "bar": 2.5}


def bench_query(_full: bool) -> dict[str, Any]:
    """Choosing a row, in milliseconds, from tables of growing size."""
    rng = np.random.default_rng(1)
    settings = Settings()
    robot = SimulatedRobot(World(settings.workspace, settings.physics), {})
    goal = GoalRegion(1, Point(0.0, 15.0), 2.4)
    binding = BehaviorCall.of(GRASP, {"grasp_point": 1.0})
    call = BehaviorCall.of(EXTEND_ARM, {"offset_distance": 5.0})
    figures = {}
    for rows in (1_000, 10_000, 100_000):
        numbers = rng.random((rows, 6)).tolist()
        table = AffordanceTable(
            Affordance(i, binding, call, *observations(n)) for i, n in enumerate(numbers)
        )
        seen = observations([0.5] * 6)[0]
        times = []
        for _ in range(50):
            start = time.perf_counter()
            choose_row(table, seen, goal, robot)
            times.append(time.perf_counter() - start)
        figures[rows] = 1000 * statistics.median(times)
    words = ", ".join(f"{rows:,} rows {ms:.3f} ms" for rows, ms in figures.items())
    print(f"query: choosing a row: {words} (bar: 1 ms at 100,000)")
    return {"ms": figures, "bar_ms_at_100000": 1.0}


def observations(numbers: list[float]) -> tuple[Observation, Observation]:
    """Return a pair of observations from six numbers in [0, 1)."""
    x, y = 30 * numbers[0] - 15, 12 + 20 * numbers[1]
    colors = (240.0, 120.0, 20.0, 40.0, 160.0, 70.0)
    dx, dy = 16 * numbers[2] - 8, 8 + 10 * numbers[3]
    start = Observation(x, y, 0.0, dx, dy, 0.0, *colors)
    end = start._replace(object_x=x + 10 * numbers[4] - 5.0, object_y=y + 10 * numbers[5] - 5.0)
    return start, end


def bench_camera(_full: bool) -> dict[str, Any]:
    """Segmentation and location against plain OpenCV, and a robot hour seen through the camera."""
    eye = eye_of(with_sensor(Settings(), "camera"), 0, 0)
    pictures = babbled_pictures(eye)
    ratios, rates = [], []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        for picture in pictures:
            eye.segmenter.segment(picture)
        segmented = time.perf_counter()
        for picture in pictures:
            plain_opencv(picture, eye.segmenter.classes)
        plain = time.perf_counter()
        for picture in pictures:
            seen = eye.segmenter.segment(picture)
            eye.locator.puck(seen)
            eye.locator.wrist(seen)
            eye.locator.tool_color(seen)
        located = time.perf_counter()
        ratios.append((segmented - start) / (plain - segmented))
        rates.append(len(pictures) / (located - plain))
    ratio, rate = statistics.median(ratios), statistics.median(rates)
    affcli = Path(sys.executable).with_name("affcli")
    with tempfile.TemporaryDirectory() as folder:
        command = [str(affcli), "learn", "--tool", "t-hook", "--sensor", "camera", "--json"]
        hour = process_time([*command, "--db", f"{folder}/camera.db"])
    print(
        f"camera: segmentation and location {rate:.0f} frames/s of 640x480 on one core (bar: 300); "
        f"segmentation {ratio:.2f}x plain OpenCV calls doing the same (bar: 1.5x); one robot hour "
        f"learned through it, two frames a behavior, as a whole process {hour:.1f} s (bar: 30 s)"
    )
    return {"frames_per_s": rate, "against_opencv": ratio, "robot_hour_s": hour}


def babbled_pictures(eye: Eye) -> list[Picture]:
    """Return what the camera sees after each of some babbled behaviors."""
    spec = LearningSpec("t-hook", 0, 0, None, 60, Settings().to_json())
    run, rng = LearningRun(spec), np.random.default_rng(0)
    return [eye.renderer.take(run.bench.world.scene, rng) for _ in run.steps()]


def plain_opencv(picture: Picture, classes: Sequence[ColorClass]) -> list[Any]:
    """Find the blobs of each colour the plain way: a range of hues, its contours, their moments.

    Of OpenCV's ways to the centroids this is the fastest: connected components of the whole masks
    take seven times as long.
    """
    hsv = cv2.cvtColor(picture, cv2.COLOR_BGR2HSV_FULL)
    found = []
    for one in classes:
        hue = round(one.hue * 256.0 / 360.0)
        low, high = hue - 9, hue + 9
        mask = cv2.inRange(hsv, (max(0, low), 90, 51), (min(255, high), 255, 255))
        if low < 0:
            mask = cv2.bitwise_or(mask, cv2.inRange(hsv, (256 + low, 90, 51), (255, 255, 255)))
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        blobs = [(cv2.moments(contour), cv2.boundingRect(contour)) for contour in contours]
        found.append(sorted(blobs, key=lambda blob: -blob[0]["m00"]))
    return found


def bench_reproduce(full: bool) -> dict[str, Any]:
    """Seconds and bytes a robot of `reproduce`, on two workers, for growing numbers of robots."""
    affcli = Path(sys.executable).with_name("affcli")
    counts = (10, 200, 1_000) if full else (10, 20)
    figures = {}
    with tempfile.TemporaryDirectory() as folder:
        for robots in counts:
            database = Path(folder) / f"{robots}.db"
            seconds = process_time(
                [
                    *(str(affcli), "reproduce", "--robots", str(robots), "--workers", "2"),
                    *("--seed", "1", "--db", str(database)),
                ]
            )
            size = database.stat().st_size / robots
            figures[robots] = {"seconds": seconds, "a_robot": seconds / robots, "bytes": size}
            print(
                f"reproduce: {robots} robots on 2 workers ({os.cpu_count()} cores): {seconds:.0f} s"
                f", {seconds / robots:.2f} s and {size / 1e6:.2f} MB a robot"
                + (" (bar: 180 s)" if robots == 200 else "")
            )
    return {"robots": figures}


def process_time(command: list[str]) -> float:
    """Return how long a command takes as a whole process (s); CalledProcessError if it fails."""
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - start


if __name__ == "__main__":
    main()
