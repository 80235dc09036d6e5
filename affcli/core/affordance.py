"""One row of the affordance table (§3.2)."""

import math
from dataclasses import dataclass

from affcli.core.behavior import BehaviorCall
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Movement, Observation, angle_between_degrees, movement

REPLICATION_ANGLE_DEGREES = 40.0
"""A use is successful when the movement seen is within this angle of the one expected (§5.2)."""

PROBABILITY_THRESHOLD = 0.5
"""A row is considered while its replication probability is greater than this (§6.2)."""


@dataclass(frozen=True, slots=True)
class Affordance:
    """One row: what was done with the tool and what was seen before and after.

    Args:
        step: the step of the learning run that made the row; older rows have lower steps, borrowed
            ones 0 or less.
        binding: the binding behavior and its parameters.
        exploratory: the exploratory behavior and its commanded parameters.
        start: O^s, the observation vector when the exploratory behavior began.
        end: O^e, the observation vector when it had ended.
        truncated: the behavior met the edge of the reach and stopped there.
        times_used: how often this sequence of behaviors was performed; 1 when the row is made.
        times_successful: how often it gave similar observations; 1 when the row is made.
        wrist_angle: the wrist's angle when the exploratory behavior began (rad, table frame).
        travel: how far the wrist went in it, by the joint encoders (in, table frame).
    """

    step: int
    binding: BehaviorCall
    exploratory: BehaviorCall
    start: Observation
    end: Observation
    truncated: bool = False
    times_used: int = 1
    times_successful: int = 1
    wrist_angle: float = 0.0
    travel: Point = Point(0.0, 0.0)

    @property
    def drawn_at(self) -> Point:
        """Where its arrow begins in a drawing: where the attractor was as seen from the wrist (in);
        the origin for all rows of a log that does not say it.
        """
        return self.start.wrist_to_object if self.is_placed() else Point(0.0, 0.0)

    def is_placed(self) -> bool:
        """Tell whether it says where the attractor was as seen from the wrist; a log may not."""
        at = self.start.wrist_to_object
        return not math.isnan(at.x + at.y)

    @property
    def wrist_degrees(self) -> int:
        """The wrist's angle in whole degrees; 0 where a log does not say it."""
        return 0 if math.isnan(self.wrist_angle) else round(math.degrees(self.wrist_angle))

    @property
    def is_borrowed(self) -> bool:
        """It was made with another tool, and carried over: see `affcli.core.transfer`."""
        return self.step <= 0

    @property
    def as_placed(self) -> tuple[Pose, Pose]:
        """Where the wrist and the attractor were when it began, as it says (in, rad)."""
        at = self.start
        return Pose(*at.wrist, self.wrist_angle), Pose(*at.object_position)

    @property
    def replication_probability(self) -> float:
        """times_successful / times_used (§6.2)."""
        return self.times_successful / self.times_used

    @property
    def expected_movement(self) -> Movement:
        """The movement this row predicts: O^e - O^s over o1 to o3 (in, table frame)."""
        return movement(self.start, self.end)


def is_probable(successful: int, used: int, threshold: float = PROBABILITY_THRESHOLD) -> bool:
    """Tell whether a row with these counters is considered: probability above the threshold.

    §6.2: "only those rows that have a replication probability [...] greater than 1/2".
    """
    return successful > threshold * used


def replicates(
    expected: Movement, seen: Movement, angle_degrees: float = REPLICATION_ANGLE_DEGREES
) -> bool:
    """Tell whether `seen` counts as a success of a row that expects `expected`.

    §5.2: "The times-successful counter is incremented if the observed attractor movement is within
    40 degrees of the expected movement stored in the affordance table." A movement that T would not
    detect has no direction, so it is a failure.
    """
    if seen.distance <= MOVEMENT_THRESHOLD:
        return False
    return angle_between_degrees(expected, seen) <= angle_degrees
