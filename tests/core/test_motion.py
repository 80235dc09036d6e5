"""Motions as JSON."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.geometry import Pose
from affcli.core.motion import Carry, Motion, Slide, Wait, motion_from_json, motion_json

lengths = st.floats(-1e6, 1e6)
segments = st.one_of(
    st.builds(Slide, lengths, lengths),
    st.builds(Carry, st.builds(Pose, lengths, lengths, lengths)),
    st.builds(Wait, st.floats(0.0, 1e6)),
)
motions = st.lists(segments, max_size=5).map(tuple)


@given(motions)
def test_a_motion_is_the_same_after_its_json(motion: Motion) -> None:
    assert motion_from_json(json.loads(json.dumps(motion_json(motion)))) == motion


@pytest.mark.parametrize(
    "value", [[["slide", 1.0]], [["jump", 1.0, 2.0]], [["carry", 1.0, 2.0]], [["wait", 1.0, 1.0]]]
)
def test_what_is_no_motion_is_refused(value: object) -> None:
    with pytest.raises(ValueError, match="no segment"):
        motion_from_json(value)


def test_a_motion_is_written_as_its_segments_are_told() -> None:
    motion = (Slide(0.0, 5.0), Wait(1.0), Carry(Pose(1.0, 2.0, 0.5)))
    assert motion_json(motion) == [["slide", 0.0, 5.0], ["wait", 1.0], ["carry", 1.0, 2.0, 0.5]]
