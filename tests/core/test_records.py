"""What stored steps say of themselves, beside their values."""

from dataclasses import replace
from typing import Any

import pytest

from affcli.core.change_detection import MOVEMENT_THRESHOLD
from affcli.core.geometry import Point
from affcli.core.records import StoredStep
from tests.report.hand_made import row, spec, step, tried

STORED, _ = tried(1, step(1, row(7)), spec())


def stored(**changed: Any) -> StoredStep:
    return replace(STORED, **changed)


def test_a_step_without_a_status_was_blocked() -> None:
    """When the tool cannot be lowered, no exploratory behavior is executed."""
    assert not stored(status="done").blocked
    assert stored(status=None).blocked


@pytest.mark.parametrize(("distance", "moved"), [(0.0, False), (0.5, False), (0.51, True)])
def test_what_moved_is_what_change_detection_detects(distance: float, moved: bool) -> None:
    """§5.2: more than 0.5 in."""
    assert MOVEMENT_THRESHOLD == 0.5
    assert stored(seen_distance=distance).moved is moved


def test_where_the_attractor_was_is_where_it_was_seen_unless_the_world_tells() -> None:
    told = stored(true_start=Point(1.0, 2.0), true_end=Point(3.0, 4.0))
    assert (told.attractor_start, told.attractor_end) == (Point(1.0, 2.0), Point(3.0, 4.0))
    blind = stored(true_start=None, true_end=None)
    assert (blind.attractor_start, blind.attractor_end) == (blind.seen_start, blind.seen_end)
