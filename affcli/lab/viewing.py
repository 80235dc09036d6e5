"""Pictures of what the robot saw: one frame, or a behavior at 15 frames a second (§4)."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from affcli import registry
from affcli.config import Settings
from affcli.core.geometry import Pose
from affcli.core.records import StepScene
from affcli.core.scene import Scene
from affcli.core.tool import PUCK_COLOR, hold_of
from affcli.errors import UsageError
from affcli.lab.filming import FRAME_RATE, Reel
from affcli.lab.learning_run import LearningRun
from affcli.lab.photographs import SHOWN, eye_at
from affcli.lab.run_parts import require_shape, settings_of, world_of
from affcli.perception.camera_sensor import Eye, picture_of_pattern, table_pattern
from affcli.perception.images import png
from affcli.perception.palette import MARKER_COLOR, ColorClass, Role
from affcli.perception.rendering import Picture
from affcli.perception.segmentation import Segmentation, Segmenter
from affcli.perception.view import side_by_side, video
from affcli.simulation.sensing import eye_of
from affcli.simulation.tasks.extension_of_reach import goal_regions, start_positions
from affcli.store import Store

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
    seen: Segmentation

    def png(self, *, frame_alone: bool) -> bytes:
        """Return the frame, and unless it is wanted alone the segmentation beside it, as PNG."""
        return png(self.seen.picture if frame_alone else side_by_side(self.seen, self.title))


def view_of_pattern(settings: Settings, seed: int) -> View:
    """Return the calibration pattern as it lies on the table at power-up."""
    eye = eye_at(settings, seed)
    pattern = table_pattern(settings.camera, settings.workspace)
    rng = np.random.Generator(np.random.PCG64((VIEW, seed)))
    markers = ColorClass("", MARKER_COLOR, Role.OBJECT)
    seen = Segmenter([markers]).segment(picture_of_pattern(eye.renderer, pattern, rng))
    x, y = pattern.origin
    return View(f"The calibration pattern, first marker at ({x:g}, {y:g}) in", seen)


def view_of_table(settings: Settings, seed: int) -> View:
    """Return the table as a trial with the T-hook begins: goal 4, start 2."""
    workspace = settings.workspace
    start, wrist = start_positions(workspace.layout)["2"], workspace.wrist_start
    scene = Scene(
        Pose(start.x, start.y),
        PUCK_COLOR,
        Pose(wrist.x, wrist.y),
        registry.tool(SHOWN, workspace.tools),
        goal_regions(workspace.layout)["4"],
    )
    seen = _seen(scene, eye_at(settings, seed), VIEW, seed)
    return View(f"The beginning of a trial with the {SHOWN}", seen)


def view_of_step(step: StepScene, *, after: bool) -> View:
    """Return the table as it was before an exploratory behavior, or after it."""
    scene = _scene(step)
    if after:
        attractor, wrist = step.attractor_end, step.wrist_end
    else:
        attractor, wrist = step.attractor_start, step.wrist_start
    scene = replace(scene, attractor=Pose(*attractor), wrist=wrist)
    moment = "after" if after else "before"
    what = f"{step.title}, {moment} {step.call}"
    if step.blocked:
        what = f"{step.title}: blocked, {step.call} was not executed"
    return View(what, _seen(scene, _eye_of(step), VIEW, *step.key))


def scene_of_behavior(store: Store, run: int, number: int) -> StepScene:
    """Return one behavior of a learning run, with the tool held as it was.

    Which of several grasps it was is a function of the run's spec, and written down only with its
    rows: the run is done again as far as this behavior.

    Raises:
        UsageError: there is no such behavior.
        BadInputError: this affcli cannot do the run again.
    """
    scene = store.learning.scene(run, number)
    if not scene.learned.other_bindings:
        return scene
    record, _ = next(islice(LearningRun(scene.learned).steps(), number - 1, None))
    return replace(scene, binding=record.binding or scene.binding)


def film_of_step(step: StepScene, ending: str, *, frame_alone: bool) -> bytes:
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
    rng = np.random.Generator(np.random.PCG64((VIEW, *step.key)))
    eye = _eye_of(step)
    title = f"{step.title}, {step.call}"

    def pictures() -> Iterator[Picture]:
        """Yield one picture after the other: a long stillness would fill the memory."""
        for scene in scenes_of_step(step):
            picture = eye.renderer.take(scene, rng)
            yield picture if frame_alone else side_by_side(eye.segmenter.segment(picture), title)

    return video(pictures(), ending, FRAME_RATE)


def scenes_of_step(step: StepScene) -> list[Scene]:
    """Return the scenes of a step, 15 a robot second."""
    require_shape(step.held)
    reel = Reel()
    if not world_of(step.learned, again=True).step_again(step, reel):
        raise UsageError(
            f"{step.title}: the world {step.learned.world} cannot show a step again; "
            "leave out --video"
        )
    return list(reel.cut())


def _scene(step: StepScene) -> Scene:
    """Return the scene in which a step began."""
    believed = step.learned.held
    require_shape(step.held)
    return Scene(
        Pose(*step.attractor_start),
        PUCK_COLOR,
        step.wrist_start,
        step.held.painted(believed.color).held(hold_of(step.binding)),
        step.goal,
    )


def _eye_of(step: StepScene) -> Eye:
    """Return the camera of the robot whose step it is."""
    settings = settings_of(step.learned)
    believed = step.learned.held
    return eye_of(settings.camera, settings.workspace, believed, step.seed, step.robot)


def _seen(scene: Scene, eye: Eye, *key: int) -> Segmentation:
    """Take a picture of a scene and segment it."""
    rng = np.random.Generator(np.random.PCG64(key))
    return eye.segmenter.segment(eye.renderer.take(scene, rng))
