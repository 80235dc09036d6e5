"""A log: what another robot did with tools, as whoever recorded it wrote it down.

A run that was imported from a log is a learning run like any other, whose world is the log. Nobody
can go on with it, do it again, or test it; and what the log does not say is not known: numbers that
are missing are NaN in memory and NULL in the database.
"""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

from affcli.core.affordance import REPLICATION_ANGLE_DEGREES
from affcli.core.behavior import BehaviorCall
from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point, Pose
from affcli.core.observation import Movement

LOG: Final = "log"
"""The name of such a run's world, explorer and sensor."""

NOT_LOGGED = math.nan
"""A number that the log does not say."""
NO_POSE = Pose(NOT_LOGGED, NOT_LOGGED, NOT_LOGGED)


class LogFile(NamedTuple):
    """A file of a log.

    Args:
        name: as it was given.
        sha256: of its bytes (64 hexadecimal digits).
    """

    name: str
    sha256: str


class LogLine(NamedTuple):
    """Where one behavior of an imported run stands.

    Args:
        step: of the behavior in its run.
        file: number of the file, counting from 1.
        line: in the file, counting from 1.
        object: what was moved, by its name in the log; None where the log does not say.
    """

    step: int
    file: int
    line: int
    object: str | None


class LogSource(NamedTuple):
    """Where an imported run comes from.

    Args:
        source: who made the log, or where it was found.
        licence, citation: None where none is known.
        map: how its lines were read: what stands in the map file.
        left_out: lines of the files that could not be read.
        files: in the order of their numbers.
    """

    source: str
    licence: str | None
    citation: str | None
    map: Mapping[str, Any]
    left_out: int
    files: tuple[LogFile, ...]


class LoggedTry(NamedTuple):
    """What one behavior of an imported run did, with or without effect.

    Args:
        step: of the behavior in its run.
        call: what was done.
        at: where the object was before (in, table frame).
        offset: the same as seen from the wrist (in); NaN where the log does not say.
        seen: how far it moved.
        moved: by more than T detects.
    """

    step: int
    call: BehaviorCall
    at: Point
    offset: Point
    seen: Movement
    moved: bool


def counters_of_repeats(movements: Sequence[Movement]) -> list[tuple[int, int]]:
    """Return the counters of rows that were made by repeats: times successful, times used.

    Each movement is one use of all of them, and a success of those that it replicates (§5.2:
    "within 40 degrees"; one that T would not detect is a failure). A row counts its own making, as
    §3.2 has it.

    Args:
        movements: of all repeats of one thing that was done, on the table: dz is 0.
    """
    moved = [one.distance > MOVEMENT_THRESHOLD for one in movements]
    angles = [math.degrees(math.atan2(one.dy, one.dx)) for one in movements]
    around = sorted(
        angle + turn
        for angle, did in zip(angles, moved, strict=True)
        if did
        for turn in (-360.0, 0.0, 360.0)
    )
    counters = []
    for angle, did in zip(angles, moved, strict=True):
        first = bisect_left(around, angle - REPLICATION_ANGLE_DEGREES)
        last = bisect_right(around, angle + REPLICATION_ANGLE_DEGREES)
        counters.append((last - first if did else 0, len(movements)))
    return counters
