"""Behaviors by name, with specific parameter values (§3.2, §5)."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.behaviors.moving import CONTRACT_ARM, paper_repertoire
from affcli.core.behavior import (
    GRASP,
    POSITION_WRIST,
    BehaviorCall,
    BehaviorName,
    ExploratoryBehavior,
    composed,
    composed_motion,
    motion_of,
)
from affcli.core.motion import Motion, Slide, Turn, Wait


def test_a_call_keeps_its_parameters_in_order_and_gives_them_by_name() -> None:
    call = BehaviorCall.of(POSITION_WRIST, {"x": -1.5, "y": 12.0})
    assert call.params == (("x", -1.5), ("y", 12.0))
    assert call["x"] == -1.5
    assert call["y"] == 12.0


def test_a_parameter_that_a_behavior_does_not_have_is_an_error() -> None:
    with pytest.raises(KeyError, match="offset_distance"):
        BehaviorCall.of(GRASP, {"grasp_point": 1.0})["offset_distance"]


def test_calls_with_the_same_name_and_parameters_are_equal() -> None:
    call = BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5.0})
    assert call == BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5})
    assert call != BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 2.0})
    assert len({call, BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5.0})}) == 1


def test_a_call_is_written_as_a_person_would() -> None:
    assert str(BehaviorCall.of(CONTRACT_ARM, {"offset_distance": 5.0})) == "contract arm 5"
    assert str(BehaviorCall.of(POSITION_WRIST, {"x": -1.5, "y": 12.0})) == "position wrist -1.5 12"


segments = st.one_of(
    st.builds(Turn, st.floats(-180.0, 180.0)),
    st.builds(Slide, st.floats(-20.0, 20.0), st.floats(-20.0, 20.0)),
)


@given(st.lists(segments, min_size=1, max_size=5).map(tuple))
def test_a_composed_behavior_is_known_by_its_call_alone(motion: Motion) -> None:
    """Also after the call was kept as a name and JSON."""
    call = composed(motion).call
    assert composed_motion(call) == motion
    kept = json.loads(json.dumps(dict(call.params)))
    assert composed_motion(BehaviorCall.of(BehaviorName(str(call.name)), kept)) == motion
    assert motion_of(call, paper_repertoire()) == motion


def test_a_composed_behavior_is_called_by_what_it_does() -> None:
    assert str(composed((Turn(31.0),)).call) == "turn 31"
    assert str(composed((Slide(1.5, -3.0),)).call) == "slide 1.5 -3"
    assert str(composed((Turn(31.0), Slide(0.0, -4.0))).call) == "turn, slide 31 0 -4"


@pytest.mark.parametrize("motion", [(), (Wait(1.0),), (Turn(3.0), Wait(1.0))])
def test_what_is_no_slide_or_turn_is_not_composed(motion: Motion) -> None:
    with pytest.raises(ValueError, match=r"segments|schema"):
        composed(motion)


@pytest.mark.parametrize(
    ("name", "params"),
    [
        ("extend arm", {"offset_distance": 5.0}),
        ("turn wrist", {"angle": 30.0}),
        ("turn", {}),
        ("turn", {"x": 1.0}),
        ("turn", {"angle": 1.0, "x": 1.0}),
        ("slide", {"y": 1.0, "x": 1.0}),
        ("turn, slide", {"angle": 1.0, "x": 1.0, "y": 2.0}),
        ("", {}),
    ],
)
def test_other_calls_are_not_composed(name: str, params: dict[str, float]) -> None:
    call = BehaviorCall.of(BehaviorName(name), params)
    assert composed_motion(call) is None
    assert motion_of(call, ()) is None


def test_a_repertoire_says_the_motion_of_what_it_has() -> None:
    call = composed((Turn(31.0),)).call
    other = (Slide(1.0, 0.0),)
    assert motion_of(call, (ExploratoryBehavior(call, other),)) == other
