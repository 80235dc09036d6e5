"""Behaviors by name, with specific parameter values (§3.2, §5)."""

import pytest

from affcli.behaviors.moving import CONTRACT_ARM
from affcli.core.behavior import GRASP, POSITION_WRIST, BehaviorCall


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
