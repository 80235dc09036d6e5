"""What a setting may be, in the words of `affcli settings` and of a refusal."""

import pytest

from affcli.core.setting import LARGEST, Setting


def number(default: float, low: float, high: float, unit: str = "in") -> Setting:
    return Setting(default, unit, "A length.", low, high)


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        (number(1.0, 0.0, 10.0), "0 to 10"),
        (number(1.0, 0.001, LARGEST), "0.001 to 1e6"),
        (number(1.0, 1e-9, 1.0), "1e-9 to 1"),
        (Setting("exact", "", "A kind.", 0.0, 0.0, ("noisy", "exact")), "noisy, exact"),
    ],
)
def test_limits_are_told_in_few_signs(setting: Setting, words: str) -> None:
    assert setting.limits == words


@pytest.mark.parametrize(
    ("value", "refusal"),
    [
        (0.0, ""),
        (10, ""),
        (10.1, "must lie in [0, 10] (in)"),
        (-0.1, "must lie in [0, 10] (in)"),
        (True, "must be a number in [0, 10] (in)"),
        ("1", "must be a number in [0, 10] (in)"),
    ],
)
def test_a_number_lies_within_its_limits(value: object, refusal: str) -> None:
    assert number(1.0, 0.0, 10.0).refusal(value) == refusal


def test_a_count_is_whole() -> None:
    count = number(3, 1, 10, "")
    assert [count.refusal(value) for value in (1, 10)] == ["", ""]
    assert count.refusal(2.0) == "must be a whole number in [1, 10]"


def test_a_choice_is_one_of_its_words() -> None:
    kind = Setting("exact", "", "A kind.", 0.0, 0.0, ("noisy", "exact"))
    assert kind.refusal("noisy") == ""
    assert kind.refusal("Noisy") == kind.refusal(1) == "must be one of noisy, exact"
