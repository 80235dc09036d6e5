"""Pictures of what the robot saw: one frame, or a behavior at 15 frames a second (§4)."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from affcli.config import Settings, settings_from_json, with_sensor
from affcli.core.behavior import POSITION_WRIST, BehaviorCall
from affcli.core.geometry import Pose
from affcli.core.observation import Observation
from affcli.core.scene import Scene
from affcli.core.task import goal_regions, start_positions
from affcli.core.tool import PUCK_COLOR
from affcli.lab.bench import TRIAL, Bench, tool_named
from affcli.lab.filming import FRAME_RATE, Reel
from affcli.lab.plausible import check_scene
from affcli.lab.sensing import eye_of
from affcli.simulation.world import World

if TYPE_CHECKING:
    from affcli.perception.rendering import Picture
    from affcli.perception.segmentation import Segmentation
    from affcli.store import StepScene

VIEW = 3
"""First word of the key of the random stream that decides the noise in a picture made to be looked
at: it is not that of the picture the robot saw then."""


@dataclass(frozen=True, slots=True)
class View:
    """A picture, and what was made of it.

    Args:
        title: what it shows.
        seen: the picture with its segmentation.
    """

    title: str
    seen: "Segmentation"

    def png(self, *, frame_alone: bool) -> bytes:
        """Return the frame, and unless it is wanted alone the segmentation beside it, as PNG."""
        from affcli.perception.images import png
        from affcli.perception.view import side_by_side

        return png(self.seen.picture if frame_alone else side_by_side(self.seen, self.title))


def view_of_pattern(settings: Settings, seed: int) -> View:
    """Return the calibration pattern as it lies on the table at power-up."""
    from affcli.perception.camera_sensor import picture_of_pattern, table_pattern
    from affcli.perception.palette import MARKER_COLOR, ColorClass, Role
    from affcli.perception.segmentation import Segmenter

    eye = eye_of(settings, seed, 0)
    pattern = table_pattern(settings.camera, settings.workspace)
    rng = np.random.Generator(np.random.PCG64((VIEW, seed)))
    markers = ColorClass("", MARKER_COLOR, Role.OBJECT)
    seen = Segmenter([markers]).segment(picture_of_pattern(eye.renderer, pattern, rng))
    x, y = pattern.origin
    return View(f"The calibration pattern, first marker at ({x:g}, {y:g}) in", seen)


def view_of_table(settings: Settings, seed: int) -> View:
    """Return the table as a trial with the T-hook begins: goal 4, start 2."""
    layout = settings.workspace.layout
    scene = Scene(
        Pose(*start_positions(layout)[2]),
        PUCK_COLOR,
        settings.workspace.wrist_start,
        tool_named(settings, "t-hook"),
        goal_regions(layout)[4],
    )
    return View(
        "The beginning of a trial with the t-hook", _seen(scene, settings, seed, 0, VIEW, seed)
    )


def view_of_step(step: "StepScene", *, after: bool) -> View:
    """Return the table as it was before an exploratory behavior, or after it."""
    settings = settings_from_json(step.settings)
    scene = _scene(step, settings)
    if after:
        attractor, wrist = step.attractor_end, step.wrist_end
    else:
        attractor, wrist = step.attractor_start, step.wrist_start
    scene = replace(scene, attractor=Pose(*attractor), wrist=wrist)
    moment = "after" if after else "before"
    what = f"{step.title}, {moment} {step.call}"
    if step.blocked:
        what = f"{step.title}: blocked, {step.call} was not executed"
    return View(what, _seen(scene, settings, step.seed, step.robot, VIEW, *step.key))


def film_of_step(step: "StepScene", ending: str, *, frame_alone: bool) -> bytes:
    """Return what the camera saw during a step as a video, 15 frames a robot second.

    It is executed again from its record: the tool is carried to where it began, then comes the
    exploratory behavior, unless the tool could not be lowered.

    Args:
        step: which.
        ending: of the file's name, which says the format: ``.mp4`` or ``.avi``.
        frame_alone: without the segmentation beside it.

    Raises:
        BadInputError: the video cannot be made.
    """
    from affcli.perception.view import side_by_side, video

    settings = settings_from_json(step.settings)
    rng = np.random.Generator(np.random.PCG64((VIEW, *step.key)))
    eye = eye_of(settings, step.seed, step.robot)
    title = f"{step.title}, {step.call}"

    def pictures() -> Iterator["Picture"]:
        """Yield one picture after the other: a long stillness would fill the memory."""
        for scene in scenes_of_step(step, settings):
            picture = eye.renderer.take(scene, rng)
            yield picture if frame_alone else side_by_side(eye.segmenter.segment(picture), title)

    return video(pictures(), ending, FRAME_RATE)


def scenes_of_step(step: "StepScene", settings: Settings) -> list[Scene]:
    """Return the scenes of a step, 15 a robot second."""
    world = World(settings.workspace, settings.physics)
    bench = Bench.of(with_sensor(settings, "exact"), world, TRIAL, step.seed, step.robot)
    begins = _scene(step, settings)
    world.tool, world.goal = begins.tool, begins.goal
    world.wrist = step.wrist_before or world.home
    world.attractor = begins.attractor
    reel = Reel()
    bench.robot.film = reel
    target = step.wrist_end if step.blocked else step.wrist_start
    # With an offset of zero, position wrist goes to where the attractor was seen: to the target.
    aim = Observation(target.x, target.y, *[0.0] * 10)
    bench.robot.execute(BehaviorCall.of(POSITION_WRIST, {"x": 0.0, "y": 0.0}), aim)
    if not step.blocked:
        bench.robot.execute(step.call, aim)
    return list(reel.cut())


def _scene(step: "StepScene", settings: Settings) -> Scene:
    """Return the scene in which a step began."""
    check_scene(step, settings)
    believed = tool_named(settings, step.tool)
    goals = goal_regions(settings.workspace.layout)
    return Scene(
        Pose(*step.attractor_start),
        PUCK_COLOR,
        step.wrist_start,
        tool_named(settings, step.shape).painted(believed.color),
        None if step.goal is None else goals[step.goal],
    )


def _seen(scene: Scene, settings: Settings, seed: int, robot: int, *key: int) -> "Segmentation":
    """Take a picture of a scene and segment it."""
    eye = eye_of(settings, seed, robot)
    rng = np.random.Generator(np.random.PCG64(key))
    return eye.segmenter.segment(eye.renderer.take(scene, rng))
