"""What the simulated camera is, where it stands, and how well it sees."""

import math
from dataclasses import dataclass

from affcli.perception.camera import Camera, ImageSensor, looking


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """The camera of §4: on a tripod, overlooking the robot's working area.

    Choice: it stands across the table and looks at the robot, so that the arm never hides what
    lies before it, and so high that it sees the whole table and a push of 5 in beyond.
    """

    focal_length_mm: float = 5.29
    """With a sensor 4.8 mm wide the horizontal view is 48.8 degrees, that of the paper's camera."""
    distortion_per_mm2: float = 0.004
    """kappa_1 of Tsai's model. Choice: 3.6 % at the corner, a wide lens's barrel."""
    x: float = 0.0
    """Where it stands (in, table frame)."""
    y: float = 45.0
    height: float = 52.0
    """Of its centre over the table (in)."""
    tilt_degrees: float = 25.0
    """Between the optical axis and straight down."""
    turn_degrees: float = 180.0
    """Where it looks: 0 away from the robot, 90 to the robot's left, 180 at the robot."""
    grey_noise: float = 2.55
    """Standard deviation of each colour component of each pixel: 1 % of 255."""
    blur_px: float = 0.5
    """Standard deviation of the blur."""
    uneven_light: float = 0.1
    """The light differs from its mean by at most this share, at a corner of the picture."""

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
