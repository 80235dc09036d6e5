"""The robot tests its own table (§3.1, §8).

§3.1: "the robot can directly test the accuracy of its representation by executing the same set of
exploratory behaviors that was used in the past".
"""

from collections.abc import Iterator

import numpy as np

from affcli.core.affordance import Affordance
from affcli.core.affordance_table import AffordanceTable
from affcli.core.behavior import BehaviorCall
from affcli.core.observation import Observation
from affcli.core.ports import Experimenter, Robot, Sensor
from affcli.core.verification import ReplicationRecord
from affcli.errors import BadInputError
from affcli.procedures.attempt import attempt

MOST_PLACES = 100
"""For one row, in a row, before it is given up; with sensible settings one is enough."""


def verify(
    robot: Robot,
    sensor: Sensor,
    experimenter: Experimenter,
    table: AffordanceTable,
    binding: BehaviorCall,
    rng: np.random.Generator,
) -> Iterator[ReplicationRecord]:
    """Try the rows of a table again, each in a fresh situation that matches its start, without end.

    Each time: the experimenter puts the attractor where the row's start can be set up; observe;
    position the wrist as in the row's O^s; observe; run the row's behavior; observe; count the use
    of the row and whether it replicated. All rows come once, in random order, excluded ones too:
    only so can a row come back that a repaired tool affords again. Then all are tried once more.

    Args:
        robot, sensor, experimenter: the world as the robot meets it.
        table: what the robot learned, not blank. Its counters are updated as it goes on (§3.2).
        binding: the binding behavior, executed once at the start.
        rng: the order of the rows.

    Yields:
        A record of each try, after the counters were updated.
    """
    robot.execute(binding, None)
    for number, position in enumerate(_rounds(len(table), rng), start=1):
        row = table.row(position)
        use = attempt(robot, sensor, row, _situation_for(row, robot, sensor, experimenter))
        table.count_use(position, success=use.replicated)
        yield ReplicationRecord(**use.by_name(), number=number, clock=robot.clock)


def _situation_for(
    row: Affordance, robot: Robot, sensor: Sensor, experimenter: Experimenter
) -> Observation:
    """Have the attractor put where the row can be tried; return what is seen then.

    The robot aims by what it sees, which may lie just out of its reach where the attractor
    does not: then the experimenter is asked for another place.
    """
    offset = row.start.wrist_to_object
    for _ in range(MOST_PLACES):
        experimenter.put_attractor_for(row)
        seen = sensor.observe()
        x, y = (np.array([c]) for c in seen.wrist_for(offset))
        if robot.reaches(x, y, row.wrist_angle).all():
            return seen
    raise BadInputError(
        f"row {row.step} ({row.exploratory}): {MOST_PLACES} places in a row were out of the arm's "
        "reach by what was seen; lower sensor.position_noise and learn again"
    )


def _rounds(rows: int, rng: np.random.Generator) -> Iterator[int]:
    """Yield the positions of the rows, each once in random order, and again, without end."""
    while True:
        yield from rng.permutation(rows).tolist()
