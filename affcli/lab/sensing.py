"""Through what the robot sees: the sensor of a bench, and the camera's power-up (§4)."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np

from affcli.config import Settings
from affcli.core.ports import Sensor
from affcli.core.scene import Scene
from affcli.core.workspace import Workspace
from affcli.errors import UsageError
from affcli.perception.camera_settings import CameraSettings
from affcli.perception.noisy_sensor import NoisySensor

if TYPE_CHECKING:  # OpenCV and SciPy load only when there is a picture to see
    from affcli.perception.camera_sensor import Eye

POWER_UP = 2
"""First word of the key of the random stream that decides the noise at power-up."""
CAMERA_PACKAGES = ("cv2", "PIL", "scipy")


def sensor_for(
    settings: Settings,
    look: Callable[[], Scene],
    rng: np.random.Generator,
    seed: int,
    robot: int,
) -> Sensor:
    """Return the sensor that the settings ask for.

    Args:
        settings: which, and how good.
        look: gives the scene of this moment.
        rng: decides the noise of its observations.
        seed, robot: whose camera it is.
    """
    if settings.sensor.kind == "camera":
        from affcli.perception.camera_sensor import CameraSensor

        return CameraSensor(look, eye_of(settings, seed, robot), rng)
    noise = settings.sensor
    if noise.kind == "exact":
        noise = replace(noise, position_noise=0.0, color_noise=0.0)
    return NoisySensor(look, noise, rng)


def eye_of(settings: Settings, seed: int, robot: int) -> "Eye":
    """Return a robot's camera after power-up: a function of settings, seed and robot alone.

    Learning runs and trials of one robot and seed share it, as if it stayed switched on.
    """
    require_camera()
    return _eye(settings.camera, settings.workspace, seed, robot)


def calibration_of(settings: Settings, seed: int, robot: int) -> str | None:
    """Return what the camera's calibration gave, as canonical JSON; None without a camera."""
    if settings.sensor.kind != "camera":
        return None
    calibration = eye_of(settings, seed, robot).calibration
    from affcli.perception.calibration import to_text

    return to_text(calibration)


def require_sensor(settings: Settings) -> None:
    """Make sure that the sensor the settings ask for can be had; UsageError when it cannot."""
    if settings.sensor.kind == "camera":
        require_camera()


def require_camera() -> None:
    """Make sure that the packages of the camera are installed.

    Raises:
        UsageError: one is missing.
    """
    missing = [name for name in CAMERA_PACKAGES if find_spec(name) is None]
    if missing:
        raise UsageError(
            "the camera needs OpenCV, Pillow and SciPy; install them: pip install 'affcli[camera]'"
        )


@lru_cache(maxsize=4)
def _eye(settings: CameraSettings, workspace: Workspace, seed: int, robot: int) -> "Eye":
    """Switch a camera on, once for a robot."""
    from affcli.perception.camera_sensor import power_up

    sequence = np.random.SeedSequence((POWER_UP, seed, robot))
    return power_up(settings, workspace, np.random.Generator(np.random.PCG64(sequence)))
