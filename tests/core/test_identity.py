"""What makes two runs the same: components as text, canonical JSON, keys."""

import json
import string

import pytest
from hypothesis import given
from hypothesis import strategies as st

from affcli.core.identity import (
    LONGEST_TEXT,
    Component,
    canonical_json,
    key_of,
    package_text,
    stream_number,
)
from affcli.errors import BadInputError

names = st.from_regex(r"[a-z][a-z0-9-]{0,12}", fullmatch=True)
keys = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
words = st.text(string.ascii_lowercase, min_size=1, max_size=6).filter(
    lambda word: word not in ("nan", "inf", "infinity")
)
numbers = st.floats(allow_nan=False, allow_infinity=False)
params = st.dictionaries(keys, st.one_of(numbers, words), max_size=4)
components = st.builds(Component.of, names, params, st.integers(1, 99_999))
json_values = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), numbers, st.text(max_size=5)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=8,
)


@given(components)
def test_a_component_is_the_same_after_its_text(component: Component) -> None:
    assert Component.parse(str(component)) == component


@given(names, params)
def test_the_order_in_which_parameters_are_given_does_not_count(
    name: str, given_params: dict[str, float | str]
) -> None:
    backwards = dict(reversed(given_params.items()))
    one, other = Component.of(name, given_params), Component.of(name, backwards)
    assert one == other
    assert str(one) == str(other)
    assert canonical_json(one.canonical()) == canonical_json(other.canonical())


def test_a_text_may_be_as_long_as_it_may_be() -> None:
    name, value = "a", "1" * (LONGEST_TEXT - len("a:b="))
    assert Component.parse("a" * 3).name == "aaa"
    with pytest.raises(BadInputError):
        Component.parse(f"{name}:b={value}1")
    assert Component.parse(f"{name}:b={value}").name == "a"


@pytest.mark.parametrize(
    "text",
    [
        *("", ":", "a:", "a:b", "a:b=", "a:=1", "a:b=1,", "a:b=1,b=2", "A", "a b", "a@", "a@x"),
        *("a@-1", "a@1.5", "a@123456", "-a", "a:B=1", "a\n", "a:b=1, c=2"),
        "a" * (LONGEST_TEXT + 1),
    ],
)
def test_what_is_not_of_the_form_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(BadInputError, match="name:key=value,key=value") as told:
        Component.parse(text)
    assert "\n" not in str(told.value)
    assert len(str(told.value)) < 200


@given(st.dictionaries(st.text(max_size=5), json_values, max_size=5))
def test_canonical_json_is_one_text_whatever_the_order_of_keys(value: dict[str, object]) -> None:
    backwards = dict(reversed(value.items()))
    assert canonical_json(value) == canonical_json(backwards)
    assert json.loads(canonical_json(value)) == value
    assert key_of(value) == key_of(backwards)
    assert len(key_of(value)) == 64


def test_what_json_cannot_say_is_an_error_and_not_another_text() -> None:
    with pytest.raises(ValueError, match="JSON compliant"):
        canonical_json({"length": float("nan")})


def test_keys_and_streams_stay_the_same_in_every_version() -> None:
    """Stored runs are found by the first; the second decides what they drew."""
    key = "0be12b2f6db16aba8fdf87fae8a1394ad5f1cd8c38fd5dd1b1f8ce8c73fbf625"
    assert key_of({"b": 1.0, "a": [None, "x"]}) == key
    streams = [2404638097, 1015380742]
    assert [stream_number(name) for name in ("stick", "t-hook")] == streams


@pytest.mark.parametrize(
    ("name", "version", "text"),
    [
        ("My_Planner", "1.0", "my-planner-1.0"),
        ("planner", "1.0-RC 1", "planner-1.0.rc.1"),
        ("planner", "(dev)", "planner-0.dev"),
        ("-p.q-", "x2+local", "p-q-0.x2+local"),
    ],
)
def test_a_package_is_named_as_packages_are_compared(name: str, version: str, text: str) -> None:
    assert package_text(name, version) == text
    assert str(Component.parse(f"name@2@{text}")) == f"name@2@{text}"
