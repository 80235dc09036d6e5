"""A sensor that knows the exact positions and adds noise to them."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import add

import numpy as np

from affcli.core.geometry import Point
from affcli.core.observation import SENSOR_KINDS, Observation, SensorKind
from affcli.core.scene import Scene
from affcli.core.setting import setting
from affcli.core.task import GoalRegion


@dataclass(frozen=True, slots=True)
class SensorSettings:
    """Which sensor; and the standard deviations of the noisy one's Gaussian noise."""

    kind: SensorKind = setting(
        "noisy",
        "",
        "Through what the robot sees: true positions with noise, without, or pictures.",
        choices=SENSOR_KINDS,
    )
    position_noise: float = setting(
        0.008,
        "in",
        "Standard deviation of x and y of attractor, wrist and goal, each drawn by itself: the "
        "camera's own error (experiments/camera).",
        low=0.0,
        high=10.0,
    )
    color_noise: float = setting(
        2.4,
        "of 255",
        "Standard deviation of each colour component, each drawn by itself.",
        low=0.0,
        high=255.0,
    )


class NoisySensor:
    """The observation vector of §5.2 from the true scene plus seeded Gaussian noise.

    Z is exact: the calibrated camera maps every pixel to the plane of the table (§4), so o3 and o6
    are 0 whatever the noise.

    Args:
        look: gives the scene of this moment.
        settings: how noisy.
        rng: where the noise comes from.
    """

    def __init__(
        self, look: Callable[[], Scene], settings: SensorSettings, rng: np.random.Generator
    ) -> None:
        self._look = look
        self._settings = settings
        self._rng = rng
        self._spread = np.array([settings.position_noise] * 4 + [settings.color_noise] * 6)

    def observe(self) -> Observation:
        """Return the observation vector of this moment."""
        scene = self._look()
        noise = self._rng.standard_normal(10)
        noise *= self._spread
        px, py, wx, wy, *tint = noise.tolist()
        attractor, wrist = scene.attractor, scene.wrist
        x, y = attractor.x + px, attractor.y + py
        dx, dy = x - (wrist.x + wx), y - (wrist.y + wy)
        seen = map(add, (*scene.attractor_color, *scene.tool.color), tint)
        colors = [c if 0.0 <= c <= 255.0 else min(255.0, max(0.0, c)) for c in seen]
        return Observation(x, y, 0.0, dx, dy, 0.0, *colors)

    def observe_goal(self) -> GoalRegion:
        """Return the goal region with noise on its centre; its size is as painted.

        Raises:
            LookupError: there is no goal on the table.
        """
        goal = self._look().goal
        if goal is None:
            raise LookupError("there is no goal region on the table")
        gx, gy = (self._settings.position_noise * self._rng.standard_normal(2)).tolist()
        return replace(goal, center=Point(goal.center.x + gx, goal.center.y + gy))
