"""What the camera costs: segmentation and location, and a robot hour through it."""

import statistics
import tempfile
import time
from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
from measuring import AFFCLI, ROUNDS, Scale, command

from affcli import registry
from affcli.config import Settings
from affcli.lab.learning_run import LearningRun
from affcli.lab.run_parts import RunParts
from affcli.perception.camera_sensor import Eye
from affcli.perception.palette import ColorClass
from affcli.perception.rendering import Picture
from affcli.simulation.sensing import eye_of


def bench_camera(scale: Scale) -> dict[str, Any]:
    """Segmentation and location against plain OpenCV, and a robot hour seen through the camera."""
    usual = Settings()
    tool = registry.tool("t-hook", usual.workspace.tools)
    eye = eye_of(usual.camera, usual.workspace, tool, 0, 0)
    pictures = babbled_pictures(eye, scale.of(60, 3))
    ratios, rates = [], []
    for _ in range(scale.of(ROUNDS, 1)):
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
    with tempfile.TemporaryDirectory() as folder:
        words = ("learn", "--tool", "t-hook", "--sensor", "camera", "--json")
        short = ("--behaviors", "3") if scale.tiny else ()
        hour = command(AFFCLI, *words, *short, "--db", f"{folder}/camera.db").wall
    print(
        f"camera: segmentation and location {rate:.0f} frames/s of 640x480 on one core (bar: 300); "
        f"segmentation {ratio:.2f}x plain OpenCV calls doing the same (bar: 1.5x); one robot hour "
        f"learned through it, two frames a behavior, as a whole process {hour:.1f} s (bar: 30 s)"
    )
    return {"frames_per_s": rate, "against_opencv": ratio, "robot_hour_s": hour}


def babbled_pictures(eye: Eye, behaviors: int) -> list[Picture]:
    """Return what the camera sees after each of some babbled behaviors."""
    run = LearningRun(RunParts.chosen(Settings()).spec("t-hook", 0, 0, None, behaviors))
    scenes, rng = (run.setting.scene() for _ in run.steps()), np.random.default_rng(0)
    return [eye.renderer.take(scene, rng) for scene in scenes if scene is not None]


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
