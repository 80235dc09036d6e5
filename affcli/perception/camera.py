"""The camera: Tsai's model of a pinhole with radial distortion (§4, refs. 17 and 18).

Frames: the table frame is Tsai's world frame, in inches; the camera frame has x to the right in the
picture, y down and z along the optical axis, in inches. Positions on the image sensor are in
millimetres from the principal point. Pixels count from the centre of the upper left one: x to the
right, y down.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LARGEST, SMALLEST_MM, LARGEST_SIDE = 1e6, 1e-3, 100_000
"""Bounds of what a stored camera may say: numbers, lengths (mm), sides of the picture (px)."""
NEWTON_STEPS = 8
"""Steps to distort a position: enough for the last bit up to 15 % of distortion."""


@dataclass(frozen=True)
class ImageSensor:
    """The image sensor, which fixes what Tsai's method takes as known.

    Pixels are square. Choice: the paper gives 640x480; the width is that of a 1/3-inch chip.

    Args:
        width_px, height_px: of the picture.
        width_mm: of the picture on the sensor.
        principal_px: where the optical axis meets the sensor; None for the middle of the picture.
    """

    width_px: int = 640
    height_px: int = 480
    width_mm: float = 4.8
    principal_px: tuple[float, float] | None = None

    @property
    def pitch_mm(self) -> float:
        """The side of a pixel (mm)."""
        return self.width_mm / self.width_px

    @property
    def center_px(self) -> tuple[float, float]:
        """The principal point (px)."""
        if self.principal_px is not None:
            return self.principal_px
        return (self.width_px - 1) / 2.0, (self.height_px - 1) / 2.0

    def to_mm(self, pixels: Array) -> Array:
        """Return positions on the sensor (n, 2), mm, of pixels (n, 2)."""
        centered: Array = (pixels - self.center_px) * self.pitch_mm
        return centered

    def to_px(self, positions: Array) -> Array:
        """Return pixels (n, 2) of positions on the sensor (n, 2), mm."""
        pixels: Array = positions / self.pitch_mm + self.center_px
        return pixels


@dataclass(frozen=True)
class Camera:
    """A camera in its place.

    Args:
        sensor: its image sensor.
        focal_length_mm: f.
        distortion_per_mm2: kappa_1; a position r from the principal point (mm) on the distorted
            picture belongs at r (1 + kappa_1 r^2). Positive is a barrel.
        rotation: 3 by 3, rows are the camera's axes in the table frame.
        translation_in: the table's origin in the camera frame (in).
    """

    sensor: ImageSensor
    focal_length_mm: float
    distortion_per_mm2: float
    rotation: tuple[tuple[float, ...], ...]
    translation_in: tuple[float, ...]

    @cached_property
    def _rotation(self) -> Array:
        return np.array(self.rotation, dtype=np.float64)

    @cached_property
    def _translation(self) -> Array:
        return np.array(self.translation_in, dtype=np.float64)

    @cached_property
    def position(self) -> tuple[float, float, float]:
        """Where the camera's centre is (in, table frame)."""
        x, y, z = (-self._rotation.T @ self._translation).tolist()
        return x, y, z

    @property
    def tilt_degrees(self) -> float:
        """The angle between the optical axis and straight down."""
        return math.degrees(math.acos(max(-1.0, min(1.0, -self.rotation[2][2]))))

    def project(self, points: Array) -> Array:
        """Return where points appear in the picture.

        Args:
            points: (n, 3), in, table frame.

        Returns:
            (n, 2), px; NaN for a point behind the camera, or farther out than the distortion's
            formula holds.
        """
        seen = points @ self._rotation.T + self._translation
        depth = np.where(seen[:, 2] > 0.0, seen[:, 2], np.nan)
        undistorted = self.focal_length_mm * seen[:, :2] / depth[:, None]
        return self.sensor.to_px(distorted(undistorted, self.distortion_per_mm2))

    def back_project(self, pixels: Array, height: float | Array = 0.0) -> Array:
        """Return where the lines of sight of pixels meet a plane parallel to the table.

        Args:
            pixels: (n, 2), px.
            height: of the plane over the table (in): one, or (n,).

        Returns:
            (n, 2), in, table frame; NaN for a line of sight that does not meet the plane in front
            of the camera.
        """
        positions = self.sensor.to_mm(pixels)
        squared = (positions**2).sum(axis=1, keepdims=True)
        rays = np.empty((len(pixels), 3))
        rays[:, :2] = positions * (1.0 + self.distortion_per_mm2 * squared)
        rays[:, 2] = self.focal_length_mm
        rays = rays @ self._rotation
        x, y, z = self.position
        with np.errstate(divide="ignore", invalid="ignore"):
            along = (height - z) / rays[:, 2]
        along[~(along > 0.0)] = np.nan
        met: Array = along[:, None] * rays[:, :2] + (x, y)
        return met

    def as_json(self) -> dict[str, Any]:
        """Return all parameters as JSON types; the principal point if it is not the middle."""
        principal = self.sensor.principal_px
        return {
            "width_px": self.sensor.width_px,
            "height_px": self.sensor.height_px,
            "sensor_width_mm": self.sensor.width_mm,
            **({} if principal is None else {"principal_point_px": list(principal)}),
            "focal_length_mm": self.focal_length_mm,
            "distortion_per_mm2": self.distortion_per_mm2,
            "rotation": [list(row) for row in self.rotation],
            "translation_in": list(self.translation_in),
        }

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> "Camera":
        """Return the camera that `as_json` wrote.

        Raises:
            KeyError, TypeError, ValueError: it was not written by `as_json`.
        """
        width, height = values["width_px"], values["height_px"]
        for name, size in (("width_px", width), ("height_px", height)):
            if isinstance(size, bool) or not isinstance(size, int) or not 0 < size <= LARGEST_SIDE:
                raise ValueError(f"{name} must be a whole number from 1 to {LARGEST_SIDE}")
        width_mm, focal_length, kappa = (
            float(values[name])
            for name in ("sensor_width_mm", "focal_length_mm", "distortion_per_mm2")
        )
        rotation = np.array(values["rotation"], dtype=np.float64)
        translation = np.array(values["translation_in"], dtype=np.float64)
        if rotation.shape != (3, 3) or translation.shape != (3,):
            raise ValueError("rotation must be 3 by 3, translation_in 3 numbers")
        principal = None
        if "principal_point_px" in values:
            x, y = map(float, values["principal_point_px"])
            principal = x, y
        numbers = np.array(
            [width_mm, focal_length, kappa, *rotation.ravel(), *translation, *(principal or ())]
        )
        if not (np.isfinite(numbers).all() and np.abs(numbers).max() <= LARGEST):
            raise ValueError(f"all numbers must lie within {LARGEST:g}")
        if min(width_mm, focal_length) < SMALLEST_MM:
            raise ValueError(f"sensor width and focal length must be at least {SMALLEST_MM:g} mm")
        square = np.abs(rotation @ rotation.T - np.eye(3)).max() <= 1e-6
        if not (square and np.linalg.det(rotation) > 0.0):
            raise ValueError("the rows of rotation must be the axes of a camera")
        return cls(
            ImageSensor(width, height, width_mm, principal),
            focal_length,
            kappa,
            tuple(map(tuple, rotation.tolist())),
            tuple(translation.tolist()),
        )


def distorted(undistorted: Array, kappa: float) -> Array:
    """Return where the lens puts positions (n, 2) of the ideal picture (mm).

    Tsai's formula goes the other way; this is its inverse by Newton's method. A pincushion's
    formula turns back at some radius; what lies beyond has no place in the picture: NaN.
    """
    if kappa == 0.0:
        return undistorted
    ideal = np.hypot(undistorted[:, 0], undistorted[:, 1])
    turn = 1.0 / math.sqrt(-3.0 * kappa) if kappa < 0.0 else math.inf
    radius = np.minimum(ideal, 0.9 * turn)
    for _ in range(NEWTON_STEPS):
        # In place: of so few numbers each array that is made takes as long as what is done with it.
        squared = radius * radius
        slope = 3.0 * kappa * squared
        slope += 1.0
        squared *= kappa
        squared += 1.0
        squared *= radius
        squared -= ideal
        squared /= slope
        radius -= squared
    scale = np.divide(radius, ideal, out=np.ones_like(ideal), where=ideal > 0.0)
    scale[ideal >= turn * 2.0 / 3.0] = np.nan
    return undistorted * scale[:, None]


def looking(tilt: float, turn: float) -> Array:
    """Return the rotation of a camera that stands upright (no roll).

    Args:
        tilt: between the optical axis and straight down (rad).
        turn: where it looks: 0 away from the robot, pi/2 to the robot's left, pi at it (rad).
    """
    ahead = np.array([-math.sin(turn), math.cos(turn), 0.0])
    down = np.array([0.0, 0.0, -1.0])
    axis = math.sin(tilt) * ahead + math.cos(tilt) * down
    picture_down = math.cos(tilt) * -ahead + math.sin(tilt) * down
    right = np.cross(picture_down, axis)
    return np.array([right, picture_down, axis])
