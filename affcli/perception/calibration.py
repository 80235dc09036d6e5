"""Calibration of the camera from coplanar markers: Roger Tsai's method (§4, refs. 17 to 19).

A closed form from the radial alignment of each marker, which no radial distortion changes, gives
rotation and translation but for the distance; a linear step gives focal length and distance; then
all eight parameters are refined together by Levenberg and Marquardt's method (MINPACK's, as in the
code that the paper used).
"""

import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from affcli.errors import BadInputError
from affcli.perception.camera import Array, Camera, ImageSensor

LARGEST_RMS = 5.0
"""With a larger error per coordinate (px) the refinement has not converged, or it is no pattern."""
LARGEST_DEVIATION = 0.1
"""A focal length known only to within this share of itself (one standard deviation) is not known:
the view is too nearly from straight above."""
LEAST_ERROR = 0.1
"""No centroid is known better than this (px), however small the residuals happen to be."""
START_VIEWS = (0.6, 1.0, 1.8)
"""Focal lengths, in widths of the sensor, to start from when the linear step gives none."""
OUTSIDE = 1e4
"""Residual (px) of a marker that the camera tried could not see."""


@dataclass(frozen=True, slots=True)
class Calibration:
    """What a calibration found.

    Args:
        camera: the camera as estimated.
        markers: pixels of the markers (n, 2).
        places: where they are (n, 2), in, table frame.
        residuals: seen minus projected (n, 2), px.
        rms_px: root mean square of all residuals, per coordinate (px).
        rms_in: the same on the table (in).
        focal_length_deviation: standard deviation of the focal length, as a share of it.
    """

    camera: Camera
    markers: Array
    places: Array
    residuals: Array
    rms_px: float
    rms_in: float
    focal_length_deviation: float

    def as_json(self, *, markers: bool = True) -> dict[str, Any]:
        """Return everything as JSON types.

        Args:
            markers: with each marker: where it was found, where it is, what is left.
        """
        found = np.column_stack([self.markers, self.places, self.residuals]).tolist()
        names = ("x_px", "y_px", "x_in", "y_in", "residual_x_px", "residual_y_px")
        points = {"markers": [dict(zip(names, row, strict=True)) for row in found]}
        return {
            **self.camera.as_json(),
            "rms_px": self.rms_px,
            "rms_in": self.rms_in,
            "focal_length_deviation": self.focal_length_deviation,
            **(points if markers else {}),
        }


def to_text(calibration: Calibration) -> str:
    """Return a calibration without its markers as compact JSON, for the record."""
    return json.dumps(calibration.as_json(markers=False), separators=(",", ":"), allow_nan=False)


def calibrate(markers: Array, places: Array, sensor: ImageSensor) -> Calibration:
    """Estimate the camera that saw coplanar markers.

    Args:
        markers: pixels (n, 2), n at least 6.
        places: where they are on the plane Z = 0 (n, 2), in, table frame.
        sensor: what is known of the camera.

    Raises:
        BadInputError: the view is too nearly from straight above, where focal length and distance
            cannot be told apart, or the refinement did not converge.
    """
    start = _closed_form(sensor.to_mm(markers), places, sensor)
    best = min((_refined(s, markers, places, sensor) for s in start), key=lambda r: float(r.cost))
    camera = _camera(best.x, sensor)
    residuals = best.fun.reshape(-1, 2)
    rms = math.sqrt(float(np.mean(residuals**2)))
    if rms > LARGEST_RMS or not best.success:
        raise BadInputError(
            f"the calibration did not converge (error per coordinate {rms:.1f} px); are the "
            "markers coplanar, --spacing apart, and seen by a camera that bends lines little?"
        )
    deviation = _focal_length_deviation(best.jac, rms, camera.focal_length_mm)
    if deviation > LARGEST_DEVIATION:
        raise BadInputError(
            "the pattern is seen too nearly from straight above: there Tsai's method cannot tell "
            "focal length from distance; tilt the camera by 20 degrees or more against it"
        )
    on_table = camera.back_project(markers) - places
    rms_in = math.sqrt(float(np.mean(on_table**2)))
    return Calibration(camera, markers, places, residuals, rms, rms_in, deviation)


def _closed_form(seen: Array, places: Array, sensor: ImageSensor) -> list[Array]:
    """Return starting points for the refinement, from Tsai's first stage.

    Args:
        seen: positions on the sensor (n, 2), mm.
        places: (n, 2), in.
        sensor: its width sets the scale of the guesses.
    """
    # The method divides by T_y, so count from a marker for which that is not small.
    base = places[int(np.argmax(np.abs(seen[:, 1])))]
    x, y = (places - base).T
    xd, yd = seen.T
    unknown = np.column_stack([yd * x, yd * y, yd, -xd * x, -xd * y])
    v1, v2, v3, v4, v5 = np.linalg.lstsq(unknown, xd, rcond=None)[0].tolist()
    ty = _length_of_ty(v1, v2, v4, v5)
    far = int(np.argmax(np.hypot(xd, yd)))
    # T_y has the sign with which the projected x of a far marker falls on the side it is seen on.
    if (v1 * x[far] + v2 * y[far] + v3) * ty * xd[far] < 0.0:
        ty = -ty
    r1, r2, tx, r4, r5 = (ty * v for v in (v1, v2, v3, v4, v5))
    starts = []
    for sign in (1.0, -1.0):
        rotation = _completed(r1, r2, r4, r5, sign)
        ahead = rotation[2, 0] * x + rotation[2, 1] * y
        across = rotation[1, 0] * x + rotation[1, 1] * y + ty
        equations = np.column_stack([across, -yd])
        (focal, tz), *_ = np.linalg.lstsq(equations, ahead * yd, rcond=None)
        guesses = [(focal, tz)] if focal > 0.0 and tz > 0.0 else []
        for view in START_VIEWS if not guesses else ():
            guess = view * sensor.width_mm
            use = np.abs(yd) > 0.1 * np.abs(yd).max()
            distance = float(np.median(guess * across[use] / yd[use] - ahead[use]))
            guesses += [(guess, distance)] if distance > 0.0 else []
        for focal_length, distance in guesses:
            shift = rotation @ np.array([*base, 0.0])
            translation = np.array([tx, ty, distance]) - shift
            starts.append(np.concatenate([_vector(rotation), translation, [focal_length, 0.0]]))
    if not starts:
        raise BadInputError("the markers fit no view of a plane from in front of it")
    return starts


def _length_of_ty(v1: float, v2: float, v4: float, v5: float) -> float:
    """Return |T_y| from the four quotients r / T_y: the rows of a rotation have length 1."""
    total = v1**2 + v2**2 + v4**2 + v5**2
    cross = v1 * v5 - v4 * v2
    if abs(cross) > 1e-12 * total:
        root = math.sqrt(max(0.0, total**2 - 4.0 * cross**2))
        # (U - root) / (2 C^2), written so that nothing cancels.
        return math.sqrt(2.0 / (total + root))
    return 1.0 / math.sqrt(max(v1**2 + v2**2, v4**2 + v5**2, 1e-12))


def _completed(r1: float, r2: float, r4: float, r5: float, sign: float) -> Array:
    """Return the rotation whose upper left 2 by 2 is given; two are possible, by sign."""
    r3 = math.sqrt(max(0.0, 1.0 - r1 * r1 - r2 * r2))
    r6 = math.sqrt(max(0.0, 1.0 - r4 * r4 - r5 * r5))
    r6 = -r6 if r1 * r4 + r2 * r5 > 0.0 else r6
    first, second = np.array([r1, r2, sign * r3]), np.array([r4, r5, sign * r6])
    rough = np.array([first, second, np.cross(first, second)])
    # The nearest matrix whose rows are at right angles and of length 1.
    u, _, v = np.linalg.svd(rough)
    nearest: Array = u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v
    return nearest


def _refined(start: Array, markers: Array, places: Array, sensor: ImageSensor) -> Any:
    """Return the least squares solution that `start` leads to."""
    points = np.column_stack([places, np.zeros(len(places))])

    def left(parameters: Array) -> Array:
        """Return seen minus projected (2 n), px."""
        residuals = markers - _camera(parameters, sensor).project(points)
        return np.nan_to_num(residuals, nan=OUTSIDE).ravel()

    return least_squares(left, start, method="lm", x_scale="jac", max_nfev=2000)


def _camera(parameters: Array, sensor: ImageSensor) -> Camera:
    """Return the camera of eight parameters: rotation vector, translation, f, kappa_1."""
    return Camera(
        sensor,
        float(parameters[6]),
        float(parameters[7]),
        tuple(map(tuple, _matrix(parameters[:3]).tolist())),
        tuple(parameters[3:6].tolist()),
    )


def _focal_length_deviation(jacobian: Array, rms: float, focal_length: float) -> float:
    """Return the standard deviation of f as a share of it, infinite when it is undetermined."""
    scale = np.linalg.norm(jacobian, axis=0)
    if not (scale > 0.0).all():
        return math.inf
    _, singular, v = np.linalg.svd(jacobian / scale, full_matrices=False)
    if singular[-1] < 1e-9 * singular[0]:
        return math.inf
    variance = float(np.sum((v[:, 6] / singular) ** 2)) / float(scale[6]) ** 2
    return max(rms, LEAST_ERROR) * math.sqrt(variance) / focal_length


def _vector(rotation: Array) -> Array:
    """Return a rotation's axis times its angle (rad)."""
    vector: Array = Rotation.from_matrix(rotation).as_rotvec()
    return vector


def _matrix(vector: Array) -> Array:
    """Return the rotation (3, 3) about an axis by its length (rad)."""
    matrix: Array = Rotation.from_rotvec(vector).as_matrix()
    return matrix
