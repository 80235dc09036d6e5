"""What the simulated camera is, where it stands, and how well it sees."""

import math
from dataclasses import dataclass

from affcli.core.setting import LARGEST, setting
from affcli.perception.camera import Camera, ImageSensor, looking


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """The camera of §4: on a tripod, overlooking the robot's working area.

    Choice: it stands across the table and looks at the robot, so that the arm never hides what
    lies before it, and so high that it sees the whole table and a push of 5 in beyond.
    """

    focal_length_mm: float = setting(
        5.29,
        "mm",
        "With a sensor 4.8 mm wide the horizontal view is 48.8 degrees, that of the paper's "
        "camera.",
        high=100.0,
    )
    distortion_per_mm2: float = setting(
        0.004,
        "1/mm^2",
        "kappa_1 of Tsai's model. Choice: 3.6 % at the corner, a wide lens's barrel.",
        low=-0.05,
        high=0.05,
    )
    x: float = setting(0.0, "in", "x of where it stands.", low=-LARGEST)
    y: float = setting(45.0, "in", "y of where it stands.", low=-LARGEST)
    height: float = setting(52.0, "in", "Height of its centre over the table.", high=1000.0)
    tilt_degrees: float = setting(
        25.0, "degrees", "Between the optical axis and straight down.", low=0.0, high=89.0
    )
    turn_degrees: float = setting(
        180.0,
        "degrees",
        "Where it looks: 0 away from the robot, 90 to the robot's left, 180 at the robot.",
        low=0.0,
        high=360.0,
    )
    grey_noise: float = setting(
        2.55,
        "of 255",
        "Standard deviation of each colour component of each pixel: 1 % of 255.",
        low=0.0,
        high=255.0,
    )
    blur_px: float = setting(0.5, "px", "Standard deviation of the blur.", low=0.0, high=20.0)
    uneven_light: float = setting(
        0.1,
        "",
        "The light differs from its mean by at most this share, at a corner of the picture.",
        low=0.0,
        high=0.9,
    )

    def camera(self) -> Camera:
        """Return the camera as it truly is; the robot has to calibrate to know it."""
        rotation = looking(math.radians(self.tilt_degrees), math.radians(self.turn_degrees))
        translation = -rotation @ (self.x, self.y, self.height)
        return Camera(
            ImageSensor(),
            self.focal_length_mm,
            self.distortion_per_mm2,
            tuple(map(tuple, rotation.tolist())),
            tuple(translation.tolist()),
        )
