"""Motions as JSON."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.geometry import Pose
from affcli.core.motion import (
    Carry,
    Motion,
    Slide,
    Turn,
    Wait,
    motion_from_json,
    motion_json,
    poses,
    turned_by,
)

lengths = st.floats(-1e6, 1e6)
segments = st.one_of(
    st.builds(Slide, lengths, lengths),
    st.builds(Turn, lengths),
    st.builds(Carry, st.builds(Pose, lengths, lengths, lengths)),
    st.builds(Wait, st.floats(0.0, 1e6)),
)
motions = st.lists(segments, max_size=5).map(tuple)


@given(motions)
def test_a_motion_is_the_same_after_its_json(motion: Motion) -> None:
    assert motion_from_json(json.loads(json.dumps(motion_json(motion)))) == motion


@pytest.mark.parametrize(
    "value",
    [
        [["slide", 1.0]],
        [["turn", 1.0, 2.0]],
        [["jump", 1.0, 2.0]],
        [["carry", 1.0, 2.0]],
        [["wait", 1.0, 1.0]],
    ],
)
def test_what_is_no_motion_is_refused(value: object) -> None:
    with pytest.raises(ValueError, match="no segment"):
        motion_from_json(value)


def test_a_motion_is_written_as_its_segments_are_told() -> None:
    motion = (Turn(30.0), Slide(0.0, 5.0), Wait(1.0), Carry(Pose(1.0, 2.0, 0.5)))
    assert motion_json(motion) == [
        ["turn", 30.0],
        ["slide", 0.0, 5.0],
        ["wait", 1.0],
        ["carry", 1.0, 2.0, 0.5],
    ]


def test_a_motion_tells_how_far_the_wrist_is_turned_on_the_way() -> None:
    motion = (Slide(0.0, 5.0), Turn(30.0), Slide(1.0, 0.0), Turn(-90.0))
    assert turned_by(motion) == pytest.approx([0.0, math.radians(30.0), math.radians(-60.0)])
    assert turned_by((Wait(1.0),)) == (0.0,)
    assert turned_by((Turn(30.0), Carry(Pose(0.0, 9.0)), Turn(5.0))) == turned_by((Turn(30.0),))


def test_a_motion_tells_where_the_wrist_is_on_the_way() -> None:
    motion = (Slide(1.0, 5.0), Turn(90.0), Wait(1.0), Slide(2.0, 0.0), Carry(Pose(0.0, 9.0)))
    quarter = 0.25 + math.radians(90.0)
    assert poses(motion, Pose(3.0, 10.0, 0.25)) == (
        *(Pose(3.0, 10.0, 0.25), Pose(4.0, 15.0, 0.25), Pose(4.0, 15.0, quarter)),
        *(Pose(4.0, 15.0, quarter), Pose(6.0, 15.0, quarter), Pose(0.0, 9.0)),
    )
