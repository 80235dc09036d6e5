"""The observation vector: twelve reals (§5.2), and the sighting of a goal region."""

import math
from typing import NamedTuple

from affcli.core.geometry import Point

SensorKind = str
"""Through what a robot sees: one of `SENSOR_KINDS`; a sensor of another package, as the text of its
component; or ``log``: that of another robot, whose log was imported."""
SENSOR_KINDS: tuple[SensorKind, ...] = ("noisy", "exact", "camera")
"""Those of affcli that a simulated robot can have: true positions with noise, without, or pictures.
"""


class Observation(NamedTuple):
    """The twelve components o1 to o12 of §5.2, in order.

    Positions in inches, colours 0 to 255; NaN where a log does not say. "Camera-centric" means the
    coordinates that the paper's calibrated camera gives, which are those of the table frame (§4: a
    pixel maps to (X, Y, Z)).
    """

    object_x: float
    object_y: float
    object_z: float
    wrist_to_object_x: float
    wrist_to_object_y: float
    wrist_to_object_z: float
    object_red: float
    object_green: float
    object_blue: float
    tool_red: float
    tool_green: float
    tool_blue: float

    @property
    def object_position(self) -> Point:
        """Where the attractor is on the table (in, table frame)."""
        return Point(self.object_x, self.object_y)

    @property
    def wrist_to_object(self) -> Point:
        """Where the attractor is as seen from the wrist (in)."""
        return Point(self.wrist_to_object_x, self.wrist_to_object_y)

    @property
    def wrist(self) -> Point:
        """Where the wrist is seen: the attractor's place minus its offset (in, table frame)."""
        return self.wrist_for(self.wrist_to_object)

    def wrist_for(self, offset: Point) -> Point:
        """Return where the wrist must be for the attractor to lie at `offset` from it (in)."""
        return Point(self.object_x - offset.x, self.object_y - offset.y)

    @property
    def colors(self) -> tuple[float, ...]:
        """o7 to o12: the colour of the object, then that of the tool."""
        return self[6:12]


class Movement(NamedTuple):
    """How far the attractor moved between two observations (in, table frame)."""

    dx: float
    dy: float
    dz: float

    @property
    def distance(self) -> float:
        """The Euclidean distance over o1, o2, o3 (in)."""
        return math.sqrt(self.dx * self.dx + self.dy * self.dy + self.dz * self.dz)


def movement(start: Observation, end: Observation) -> Movement:
    """Return the attractor's movement from `start` to `end`: O^e - O^s over o1 to o3 (§5.2).

    Of a log that does not say how high it lies: on the table.
    """
    dz = end.object_z - start.object_z
    return Movement(
        end.object_x - start.object_x,
        end.object_y - start.object_y,
        0.0 if math.isnan(dz) else dz,
    )


def angle_between_degrees(a: Movement, b: Movement) -> float:
    """Return the angle between two movements, 0 to 180 degrees; 180 when one of them is zero."""
    cross = (a.dy * b.dz - a.dz * b.dy, a.dz * b.dx - a.dx * b.dz, a.dx * b.dy - a.dy * b.dx)
    dot = a.dx * b.dx + a.dy * b.dy + a.dz * b.dz
    if a.distance == 0.0 or b.distance == 0.0:
        return 180.0
    return math.degrees(math.atan2(math.hypot(*cross), dot))
