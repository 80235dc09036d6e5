"""One use of a row: set up its start, run its behavior, see whether it replicates (§3.2, §5.2)."""

from affcli.behaviors.positioning import position_wrist
from affcli.core.affordance import (
    PROBABILITY_THRESHOLD,
    REPLICATION_ANGLE_DEGREES,
    Affordance,
    replicates,
)
from affcli.core.behavior import Execution, ExecutionStatus
from affcli.core.observation import Observation, movement
from affcli.core.ports import Robot, Sensor
from affcli.core.trial import Attempt


def attempt(
    robot: Robot,
    sensor: Sensor,
    row: Affordance,
    seen: Observation,
    *,
    angle_degrees: float = REPLICATION_ANGLE_DEGREES,
    threshold: float = PROBABILITY_THRESHOLD,
) -> Attempt:
    """Position the wrist as in the row's O^s, observe, run the row's behavior, observe, judge.

    A row that was made with another hold than the present one is used with its own: the tool is
    grasped anew first, which takes robot time.

    Args:
        robot, sensor: the world as the robot meets it.
        row: what is tried; its counters are left to the caller.
        seen: the latest observation.
        angle_degrees: it replicates within this angle of the row's movement.
        threshold: at this replication probability or below a row is out of consideration.
    """
    regrasped = robot.holding != row.binding
    if regrasped:
        robot.execute(row.binding, seen)
    placing = robot.execute(position_wrist(row.start.wrist_to_object, row.wrist_angle), seen)
    execution: Execution | None = None
    start = end = seen
    if placing.status is ExecutionStatus.DONE:
        start = sensor.observe()
        execution = robot.execute(row.exploratory, start)
        end = sensor.observe()
    expected, observed = row.expected_movement, movement(start, end)
    # A blocked placing moves nothing, and a movement of zero never replicates.
    success = replicates(expected, observed, angle_degrees)
    return Attempt(
        *(row, placing, execution, start, end, expected, observed),
        replicated=success,
        regrasped=regrasped,
        threshold=threshold,
    )
