"""Calibration of the camera from coplanar markers: Roger Tsai's method (§4, refs. 17 to 19).

A closed form from the radial alignment of each marker, which no radial distortion changes, gives
rotation and translation but for the distance; a linear step gives focal length and distance; then
all eight parameters are refined together by Levenberg and Marquardt's method (MINPACK's, as in the
code that the paper used).

The method takes the principal point for known. That of a real camera is not: where the markers show
that it is off the middle it is refined too, and what they leave open of it is in the stated error
of the focal length.
"""

import json
import math
from dataclasses import dataclass, replace
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
OFF_CENTER = 0.04
"""Choice: how far the principal point of a camera that a person has may lie from the middle of the
picture (one standard deviation of each coordinate), as a share of the picture's width."""
CERTAIN = 3.0
"""Standard deviations by which the principal point must be off the middle to be moved there."""
ROUNDS = 4
"""How often the noise is estimated again, against which the principal point is weighed."""
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
        principal_deviation_px: standard deviations of the principal point's coordinates (px); None
            where it was taken for known.
    """

    camera: Camera
    markers: Array
    places: Array
    residuals: Array
    rms_px: float
    rms_in: float
    focal_length_deviation: float
    principal_deviation_px: tuple[float, float] | None = None

    def as_json(self, *, markers: bool = True) -> dict[str, Any]:
        """Return everything as JSON types.

        Args:
            markers: with each marker: where it was found, where it is, what is left.
        """
        found = np.column_stack([self.markers, self.places, self.residuals]).tolist()
        names = ("x_px", "y_px", "x_in", "y_in", "residual_x_px", "residual_y_px")
        points = {"markers": [dict(zip(names, row, strict=True)) for row in found]}
        off = self.principal_deviation_px
        return {
            **self.camera.as_json(),
            "rms_px": self.rms_px,
            "rms_in": self.rms_in,
            "focal_length_deviation": self.focal_length_deviation,
            **({} if off is None else {"principal_point_deviation_px": list(off)}),
            **(points if markers else {}),
        }


def to_text(calibration: Calibration) -> str:
    """Return a calibration without its markers as compact JSON, for the record."""
    return json.dumps(calibration.as_json(markers=False), separators=(",", ":"), allow_nan=False)


def calibrate(
    markers: Array, places: Array, sensor: ImageSensor, off_center: float = 0.0
) -> Calibration:
    """Estimate the camera that saw coplanar markers.

    Args:
        markers: pixels (n, 2), n at least 6.
        places: where they are on the plane Z = 0 (n, 2), in, table frame.
        sensor: what is known of the camera.
        off_center: how far the principal point may lie from the middle of the picture (px, one
            standard deviation of each coordinate); 0 when it is known to lie there.

    Raises:
        BadInputError: the view is too nearly from straight above, where focal length and distance
            cannot be told apart, or the refinement did not converge.
    """
    start = _closed_form(sensor.to_mm(markers), places, sensor)
    best = min((_refined(s, markers, places, sensor) for s in start), key=lambda r: float(r.cost))
    free, known = best, []
    if off_center > 0.0:
        free = _off_center(best, markers, places, sensor, off_center)
        known = [_deviation(free.jac, k, _rms(free, markers)) for k in (6, 8, 9)]
        best = free if (np.abs(free.x[8:]) > CERTAIN * np.array(known[1:])).any() else best
    camera = _camera(best.x, sensor)
    rms = _rms(best, markers)
    if rms > LARGEST_RMS or not best.success:
        raise BadInputError(
            f"the calibration did not converge (error per coordinate {rms:.1f} px); are the "
            "markers coplanar, --spacing apart, and seen by a camera that bends lines little?"
        )
    # Could the focal length be told if the principal point were known?
    deviation = _deviation(best.jac[: markers.size, :8], 6, rms) / camera.focal_length_mm
    if deviation > LARGEST_DEVIATION:
        raise BadInputError(
            "the pattern is seen too nearly from straight above: there Tsai's method cannot tell "
            "focal length from distance; tilt the camera by 20 degrees or more against it"
        )
    principal = None
    if off_center > 0.0:
        apart = free.x[[6, 8, 9]] - np.append(best.x, (0.0, 0.0))[[6, 8, 9]]
        f, *xy = np.hypot(known, apart).tolist()
        deviation, principal = f / camera.focal_length_mm, (xy[0], xy[1])
        camera = replace(camera, sensor=replace(sensor, principal_px=camera.sensor.center_px))
    residuals = best.fun[: markers.size].reshape(-1, 2)
    on_table = camera.back_project(markers) - places
    rms_in = math.sqrt(float(np.mean(on_table**2)))
    return Calibration(camera, markers, places, residuals, rms, rms_in, deviation, principal)


def _rms(found: Any, markers: Array) -> float:
    """Return the root mean square of what is left at the markers, per coordinate (px)."""
    return math.sqrt(float(np.mean(found.fun[: markers.size] ** 2)))


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
            turned = Rotation.from_matrix(rotation).as_rotvec()
            starts.append(np.concatenate([turned, translation, [focal_length, 0.0]]))
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


def _refined(
    start: Array, markers: Array, places: Array, sensor: ImageSensor, pull: float = 0.0
) -> Any:
    """Return the least squares solution that `start` leads to.

    Args:
        start: eight parameters, or ten with the principal point; see `_camera`.
        markers, places, sensor: as in `calibrate`.
        pull: error (px) for each pixel that the principal point is from the middle.
    """
    points = np.column_stack([places, np.zeros(len(places))])

    def left(parameters: Array) -> Array:
        """Return seen minus projected (2 n), px, and the pull on the principal point."""
        residuals = markers - _camera(parameters, sensor).project(points)
        return np.append(np.nan_to_num(residuals, nan=OUTSIDE).ravel(), pull * parameters[8:])

    return least_squares(left, start, method="lm", x_scale="jac", max_nfev=2000)


def _off_center(
    best: Any, markers: Array, places: Array, sensor: ImageSensor, off_center: float
) -> Any:
    """Return the solution with the principal point, from that in which it is the middle.

    Being off the middle by `off_center` weighs as much as one marker that is off by the noise.
    """
    start = np.append(best.x, (0.0, 0.0))
    for _ in range(ROUNDS):
        noise = max(_rms(best, markers), LEAST_ERROR)
        best = _refined(start, markers, places, sensor, noise / off_center)
        start = best.x
    return best


def _camera(parameters: Array, sensor: ImageSensor) -> Camera:
    """Return the camera of parameters: rotation vector, translation, f, kappa_1.

    Two more, if there are any, say how far the principal point is from the middle (px).
    """
    if len(parameters) > 8:
        x, y = (np.array(sensor.center_px) + parameters[8:]).tolist()
        sensor = replace(sensor, principal_px=(x, y))
    return Camera(
        sensor,
        float(parameters[6]),
        float(parameters[7]),
        tuple(map(tuple, Rotation.from_rotvec(parameters[:3]).as_matrix().tolist())),
        tuple(parameters[3:6].tolist()),
    )


def _deviation(jacobian: Array, parameter: int, rms: float) -> float:
    """Return the standard deviation of a parameter, infinite when it is undetermined."""
    scale = np.linalg.norm(jacobian, axis=0)
    if not (scale > 0.0).all():
        return math.inf
    _, singular, v = np.linalg.svd(jacobian / scale, full_matrices=False)
    if singular[-1] < 1e-9 * singular[0]:
        return math.inf
    variance = float(np.sum((v[:, parameter] / singular) ** 2)) / float(scale[parameter]) ** 2
    return max(rms, LEAST_ERROR) * math.sqrt(variance)
