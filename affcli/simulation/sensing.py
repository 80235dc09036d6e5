"""Through what the robot sees: the sensor of a setting, and the camera's power-up (§4)."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np

from affcli.core.mask import Mask
from affcli.core.observation import SENSOR_KINDS, SensorKind
from affcli.core.part import Part
from affcli.core.ports import Sensor
from affcli.core.scene import Scene
from affcli.core.tool import Color, Tool
from affcli.core.workspace import Workspace
from affcli.core.world import BringsSensors
from affcli.errors import BadInputError, UsageError, one_line
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.noisy_sensor import NoisySensor, SensorSettings
from affcli.simulation.tools.paper import paper_tools

if TYPE_CHECKING:  # OpenCV and SciPy load only when there is a picture to see
    from affcli.perception.camera_sensor import Eye

POWER_UP = 2
"""First word of the key of the random stream that decides the noise at power-up."""
CAMERA_PACKAGES = ("cv2", "PIL")


class SimulatedSight:
    """What one simulated robot sees through.

    Args:
        kind: noisy, exact, camera, or a sensor of another package.
        noise: of the noisy sensor.
        camera: where it stands and how well it sees.
        workspace: what stands on the table.
        tool: the tool that the robot believes to hold; a camera must know its colour.
        seed, robot: whose camera it is: learning runs and trials of one robot and seed share it, as
            if it stayed switched on.
        brought: makes sensors of other packages.

    Raises:
        BadInputError: there is no such sensor.
    """

    def __init__(
        self,
        kind: SensorKind,
        noise: SensorSettings,
        camera: CameraSettings,
        workspace: Workspace,
        tool: Tool,
        seed: int,
        robot: int,
        brought: BringsSensors | None = None,
    ) -> None:
        self._kind = kind
        self._noise = noise
        self._make: Callable[[Callable[[], Scene], np.random.Generator], Sensor] | None = None
        if kind not in SENSOR_KINDS:
            if brought is None:
                raise BadInputError(f"this world knows no sensor {one_line(kind, 60)}")
            make = brought.sensor(kind)
            self._make = lambda look, rng: make(look, rng, workspace, tool)
        self._eye = (
            (lambda: eye_of(camera, workspace, tool, seed, robot)) if (kind == "camera") else None
        )

    def sensor(self, look: Callable[[], Scene], rng: np.random.Generator) -> Sensor:
        """Return the sensor.

        Args:
            look: gives the scene of this moment.
            rng: decides the noise of its observations.
        """
        if self._make is not None:
            return self._make(look, rng)
        if self._eye is not None:
            eye = self._eye()
            from affcli.perception.camera_sensor import CameraSensor

            return CameraSensor(look, eye, rng)
        noise = self._noise
        if self._kind == "exact":
            noise = replace(noise, position_noise=0.0, color_noise=0.0)
        return NoisySensor(look, noise, rng)

    @property
    def calibration(self) -> str | None:
        """What the camera's calibration gave, as canonical JSON; None without a camera."""
        if self._eye is None:
            return None
        from affcli.perception.calibration import to_text

        return to_text(self._eye().calibration)


def eye_of(
    camera: CameraSettings, workspace: Workspace, tool: Tool, seed: int, robot: int
) -> "Eye":
    """Return a robot's camera after power-up: a function of its arguments alone."""
    require_camera()
    colors: dict[str, Color] = {
        known.name: known.color for known in paper_tools(workspace.tools).values()
    }
    colors[tool.name] = tool.color
    return _eye(camera, workspace, tuple(colors.items()), seed, robot)


def mask_through(eye: "Eye", scene: Scene, tool: str, rng: np.random.Generator) -> Mask:
    """Return the mask of a tool in a picture of a scene; `rng` decides the noise.

    Raises:
        NotSeenError: the camera does not see the tool, or not all of it.
    """
    from affcli.perception.tool_mask import tool_mask

    seen = eye.segmenter.segment(eye.renderer.take(scene, rng))
    return tool_mask(seen, eye.calibration.camera, eye.locator.wrist(seen), tool)


def require_camera() -> None:
    """Make sure that the packages of the camera are installed.

    Raises:
        UsageError: one is missing.
    """
    missing = [name for name in CAMERA_PACKAGES if find_spec(name) is None]
    if missing:
        raise UsageError(
            "the camera needs OpenCV and Pillow; install them: pip install 'affcli[camera]'"
        )


@lru_cache(maxsize=16)
def _eye(
    settings: CameraSettings,
    workspace: Workspace,
    tools: tuple[tuple[str, Color], ...],
    seed: int,
    robot: int,
) -> "Eye":
    """Switch a camera on, once for a robot."""
    from affcli.perception.camera_sensor import power_up

    sequence = np.random.SeedSequence((POWER_UP, seed, robot))
    rng = np.random.Generator(np.random.PCG64(sequence))
    return power_up(settings, workspace, dict(tools), rng)


PARTS = (
    Part(
        kind="sensors",
        name="noisy",
        summary="exact positions plus Gaussian noise of the camera's own size ([sensor])",
        source="affcli",
        build=SimulatedSight,
    ),
    Part(
        kind="sensors",
        name="exact",
        summary="exact positions and colours, no noise",
        source="affcli",
        build=SimulatedSight,
    ),
    Part(
        kind="sensors",
        name="camera",
        summary="pictures, colour segmentation and Tsai's calibration ([camera])",
        source="Stoytchev 2008, §4",
        build=SimulatedSight,
    ),
)
