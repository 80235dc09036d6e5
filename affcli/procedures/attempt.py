"""One use of a row: set up its start, run its behavior, see whether it replicates (§3.2, §5.2)."""

from affcli.core.affordance import Affordance, replicates
from affcli.core.behavior import POSITION_WRIST, BehaviorCall, Execution, ExecutionStatus
from affcli.core.observation import Observation, movement
from affcli.core.ports import Robot, Sensor
from affcli.core.trial import Attempt


def attempt(robot: Robot, sensor: Sensor, row: Affordance, seen: Observation) -> Attempt:
    """Position the wrist as in the row's O^s, observe, run the row's behavior, observe, judge.

    Args:
        robot, sensor: the world as the robot meets it.
        row: what is tried; its counters are left to the caller.
        seen: the latest observation.
    """
    offset = row.start.wrist_to_object
    placing = robot.execute(BehaviorCall.of(POSITION_WRIST, {"x": offset.x, "y": offset.y}), seen)
    execution: Execution | None = None
    start = end = seen
    if placing.status is ExecutionStatus.DONE:
        start = sensor.observe()
        execution = robot.execute(row.exploratory, start)
        end = sensor.observe()
    expected, observed = row.expected_movement, movement(start, end)
    # A blocked placing moves nothing, and a movement of zero never replicates.
    success = replicates(expected, observed)
    return Attempt(row, placing, execution, start, end, expected, observed, success)
