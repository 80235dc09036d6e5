"""Settings: typed defaults, overrides from TOML, canonical JSON, and what is refused."""

import json
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from affcli.config import (
    Settings,
    known_settings,
    load_settings,
    settings_with,
)
from affcli.errors import BadInputError
from tests.factories import UNITS


def values_of(settings: Settings) -> dict[str, dict[str, Any]]:
    sections: dict[str, dict[str, Any]] = {}
    for name, value in settings.values().items():
        section, key = name.split(".")
        sections.setdefault(section, {})[key] = value
    return sections


DEFAULTS = values_of(Settings())
NAMES = {
    *("arm", "tools", "puck", "friction", "layout", "motion", "table"),
    *("sensor", "camera", "physics", "babbling", "trial"),
}
KEYS = [(section, key) for section, values in DEFAULTS.items() for key in values]
keys = st.sampled_from([(s, k) for s, k in KEYS if not isinstance(DEFAULTS[s][k], str)])


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "settings.toml"
    path.write_text(text, encoding="utf-8")
    return path


def refused(tmp_path: Path, text: str) -> str:
    """Return what the refusal of a file says, after what holds of every refusal."""
    path = written(tmp_path, text)
    with pytest.raises(BadInputError) as told:
        load_settings(path)
    message = str(told.value)
    assert message.isprintable()
    assert path.name in message
    assert len(message) < 1000
    assert told.value.exit_code == 4
    return message


def other_value(section: str, key: str) -> float | int | str:
    """Return a value that this key may have and that is not its default."""
    value = DEFAULTS[section][key]
    if isinstance(value, str):
        choices = known_settings()[f"{section}.{key}"].choices
        return next(choice for choice in choices if choice != value)
    if isinstance(value, int):
        return value + 1
    return float(value) * 0.75 if value else 0.125


def test_without_a_file_the_defaults_hold() -> None:
    assert load_settings(None) == Settings()


def test_an_empty_file_changes_nothing(tmp_path: Path) -> None:
    assert load_settings(written(tmp_path, "")) == Settings()
    assert load_settings(written(tmp_path, "# nothing\n[arm]\n[babbling]\n")) == Settings()


def test_the_sections_are_those_of_the_geometry_and_the_five_beside_it() -> None:
    assert set(DEFAULTS) == NAMES


def test_every_key_can_be_overridden_and_nothing_else_changes(tmp_path: Path) -> None:
    for section, key in KEYS:
        value = other_value(section, key)
        text = f"[{section}]\n{key} = {json.dumps(value)}\n"
        changed = values_of(load_settings(written(tmp_path, text)))
        assert changed[section][key] == value
        changed[section][key] = DEFAULTS[section][key]
        assert changed == DEFAULTS


def test_several_sections_can_be_overridden_at_once(tmp_path: Path) -> None:
    text = "[sensor]\nposition_noise = 0\n[tools]\nbar_reach = 7\n[trial]\nmax_steps = 5\n"
    settings = load_settings(written(tmp_path, text))
    assert settings.sensor.position_noise == 0.0
    assert settings.workspace.tools.bar_reach == 7.0
    assert settings.trial.max_steps == 5
    assert settings.workspace.tools.handle_length == Settings().workspace.tools.handle_length


def test_whole_numbers_for_lengths_are_taken_as_numbers(tmp_path: Path) -> None:
    one = load_settings(written(tmp_path, "[tools]\nbar_reach = 7\n"))
    other = load_settings(written(tmp_path, "[tools]\nbar_reach = 7.0\n"))
    assert one == other
    assert one.values() == other.values()
    assert type(one.workspace.tools.bar_reach) is float


def possible_together(changes: dict[str, dict[str, Any]]) -> bool:
    """Leave out sizes that are each possible but not together."""
    try:
        settings_with(changes, "a test")
    except BadInputError as error:
        return "must be less than" not in str(error)
    return True


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[tools]\nhook_length = 0.5\n", "tools.part_width = 0.75 must be less than"),
        ("[tools]\nbar_reach = 0.5\n", "tools.part_width = 0.75 must be less than"),
        ("[table]\nnear = 40\n", "table.near = 40 must be less than table.far"),
        ("[babbling]\noffset_y_min = 30\n", "babbling.offset_y_min = 30 must be less than"),
        ("[arm]\nshoulder_min_degrees = 150\n", "arm.shoulder_min_degrees = 150 must be less"),
    ],
)
def test_sizes_that_are_impossible_together_are_refused(
    tmp_path: Path, text: str, words: str
) -> None:
    assert words in refused(tmp_path, text)


overrides = (
    st.dictionaries(keys, st.floats(0.01, 1.0), max_size=8)
    .map(
        lambda shares: {
            section: {
                key: max(1, round(DEFAULTS[section][key] * share))
                if isinstance(DEFAULTS[section][key], int)
                else abs(DEFAULTS[section][key]) * share or share / 4.0
                for (theirs, key), share in shares.items()
                if theirs == section
            }
            for section in {section for section, _ in shares}
        }
    )
    .filter(possible_together)
)


@hypothesis_settings(deadline=None)
@given(overrides)
def test_equal_settings_give_equal_values_whatever_the_order_and_unequal_ones_do_not(
    changes: dict[str, dict[str, Any]],
) -> None:
    backwards = {
        section: dict(reversed(values.items())) for section, values in reversed(changes.items())
    }
    one, other = settings_with(changes, "a test"), settings_with(backwards, "a test")
    assert one == other
    assert one.values() == other.values()
    assert (one.values() == Settings().values()) is (one == Settings())


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("[grip]\nforce = 1\n", "no section grip"),
        ("[workspace]\narm = 1\n", "no section workspace"),
        ("grip = 1\n", "no section grip"),
        ("[arms]\n", "no section arms"),
        ("[arm]\nupper = 1\n", r"arm.upper"),
        ("[sensor]\nnoise = 1\n", r"sensor.noise"),
        ("arm = 10\n", "arm must be a section"),
        ("arm = [1, 2]\n", "arm must be a section"),
        ("[[arm]]\nupper_arm = 1\n", "arm must be a section"),
        ("[arm.upper_arm]\nx = 1\n", "arm.upper_arm"),
    ],
)
def test_what_does_not_exist_is_refused_by_its_path(tmp_path: Path, text: str, named: str) -> None:
    assert named in refused(tmp_path, text)


def test_an_unknown_section_or_key_is_told_with_those_there_are(tmp_path: Path) -> None:
    sections = refused(tmp_path, "[grip]\n")
    assert all(section in sections for section in NAMES)
    known = refused(tmp_path, "[trial]\nsteps = 5\n")
    assert "max_steps" in known


@pytest.mark.fault(23)
@pytest.mark.parametrize(
    "value",
    ['"10"', "true", "false", "[10.0]", "{ x = 1 }", "2008-05-01", "nan", "inf", "-inf", "1e9"],
)
def test_what_is_no_number_in_range_is_refused_for_every_key(tmp_path: Path, value: str) -> None:
    for section, key in KEYS:
        assert f"{section}.{key} = " in refused(tmp_path, f"[{section}]\n{key} = {value}\n")


@pytest.mark.fault(23)
def test_negative_numbers_are_refused_but_for_an_angle_and_places(tmp_path: Path) -> None:
    negative = {("arm", "shoulder_min_degrees"), ("camera", "x"), ("camera", "y")}
    negative.add(("puck", "mass_direction_degrees"))
    for section, key in KEYS:
        choices = known_settings()[f"{section}.{key}"].choices
        text = f"[{section}]\n{key} = -1\n"
        if (section, key) in negative:
            assert values_of(load_settings(written(tmp_path, text)))[section][key] == -1.0
        elif choices:
            assert f"{section}.{key} = -1 must be one of {choices[0]}" in refused(tmp_path, text)
        else:
            assert f"{section}.{key} = -1 must lie in" in refused(tmp_path, text)


@pytest.mark.parametrize(
    "path",
    [
        *("arm.upper_arm", "tools.part_width", "puck.mass", "puck.radius", "friction.gravity"),
        *("motion.push_speed", "motion.push_acceleration", "physics.iterations"),
        *("trial.max_steps", "babbling.draws", "physics.collision_slop"),
    ],
)
def test_zero_is_refused_where_it_makes_no_sense(tmp_path: Path, path: str) -> None:
    section, key = path.split(".")
    assert f"{path} = 0 must lie in [" in refused(tmp_path, f"[{section}]\n{key} = 0\n")


@pytest.mark.parametrize(
    "path",
    ["sensor.position_noise", "sensor.color_noise", "friction.tool_puck", "motion.hold"],
)
def test_zero_is_taken_where_it_does(tmp_path: Path, path: str) -> None:
    section, key = path.split(".")
    settings = load_settings(written(tmp_path, f"[{section}]\n{key} = 0\n"))
    assert values_of(settings)[section][key] == 0.0


@pytest.mark.parametrize("path", ["physics.iterations", "trial.max_steps", "babbling.draws"])
@pytest.mark.parametrize("value", ["10.0", "1.5", "1e1"])
def test_counts_are_whole_numbers(tmp_path: Path, path: str, value: str) -> None:
    section, key = path.split(".")
    message = refused(tmp_path, f"[{section}]\n{key} = {value}\n")
    assert f"{path} = " in message
    assert "a whole number" in message


@pytest.mark.parametrize(
    ("path", "most"), [("arm.waist_max_degrees", 90), ("arm.elbow_max_degrees", 180)]
)
def test_joints_turn_no_farther_than_they_can(tmp_path: Path, path: str, most: int) -> None:
    section, key = path.split(".")
    load_settings(written(tmp_path, f"[{section}]\n{key} = {most}\n"))
    assert path in refused(tmp_path, f"[{section}]\n{key} = {most}.001\n")


DIGITS = 100_000
HUGE = {
    "decimal": "9" * DIGITS,
    "negative": "-" + "9" * DIGITS,
    "fraction": "0." + "1" * DIGITS + "e400",
    "hexadecimal": "0x" + "f" * DIGITS,
    "binary": "0b" + "1" * DIGITS,
    "list of hexadecimal": "[0x" + "f" * DIGITS + "]",
}


@pytest.mark.parametrize("value", HUGE.values(), ids=list(HUGE))
@pytest.mark.parametrize("path", ["arm.upper_arm", "trial.max_steps"])
def test_a_number_of_100_000_digits_is_refused(tmp_path: Path, path: str, value: str) -> None:
    section, key = path.split(".")
    refused(tmp_path, f"[{section}]\n{key} = {value}\n")


@pytest.mark.parametrize(
    "text",
    [
        "[arm]\nupper_arm = " + "[" * 50_000 + "]" * 50_000,
        "[arm]\nupper_arm = " + "[" * 300 + "]" * 300,
        "[arm]\nupper_arm = " + "{x=" * 300 + "1" + "}" * 300,
        "[arm.upper_arm" + ".x" * 5_000 + "]\ny = 1\n",
        "[" + ".".join("x" * 5_000) + "]\n",
    ],
    ids=["50,000 lists", "300 lists", "300 tables", "5,000 names", "5,000 names of no section"],
)
def test_deep_nesting_is_refused(tmp_path: Path, text: str) -> None:
    refused(tmp_path, text)


@pytest.mark.parametrize(
    "text",
    ["[arm", "upper_arm == 1", "[arm]\n[arm]\n", "[arm]\nupper_arm = 1\nupper_arm = 2\n", "\0"],
)
def test_what_is_not_toml_is_refused(tmp_path: Path, text: str) -> None:
    assert "not TOML" in refused(tmp_path, text)


def test_bytes_that_are_not_text_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "settings.toml"
    path.write_bytes(b"\xff\xfe[arm]\n")
    with pytest.raises(BadInputError, match="not TOML"):
        load_settings(path)


def test_a_file_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match=r"none\.toml: No such file"):
        load_settings(tmp_path / "none.toml")
    with pytest.raises(BadInputError, match="directory"):
        load_settings(tmp_path)


@pytest.mark.fault(21)
def test_names_with_control_characters_are_shown_escaped(tmp_path: Path) -> None:
    path = tmp_path / "red\x1b[31m\n.toml"
    path.write_text('["a\\u001b\\n"]\n', encoding="utf-8")
    with pytest.raises(BadInputError) as told:
        load_settings(path)
    assert str(told.value).isprintable()
    assert r"\x1b" in str(told.value)
    assert r"\x1b" in refused(tmp_path, '[arm]\n"\\u001b[31m" = 1\n')
    assert r"\x1b" in refused(tmp_path, '[arm]\nupper_arm = "\\u001b[31m"\n')


def test_a_long_name_is_cut(tmp_path: Path) -> None:
    refused(tmp_path, f"[arm]\n{'x' * 10_000} = 1\n")
    refused(tmp_path, f"[{'x' * 10_000}]\n")


json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=5)
    | st.sampled_from([math.nan, math.inf, -0.0, 5e-324, 1e308, 2**63, -(10**30)]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=5,
)


def outcome(mapping: dict[str, Any]) -> Settings | BadInputError:
    """Return the settings, or the refusal; any other error is a bug."""
    try:
        return settings_with(mapping, "a test")
    except BadInputError as error:
        return error


@pytest.mark.fault(23)
@hypothesis_settings(deadline=None, max_examples=200)
@given(keys, json_values)
def test_any_value_is_either_taken_as_it_is_or_refused(key: tuple[str, str], value: Any) -> None:
    section, name = key
    given_back = outcome({section: {name: value}})
    if isinstance(given_back, Settings):
        assert math.isfinite(value)
        assert not isinstance(value, bool)
        assert values_of(given_back)[section][name] == value
    else:
        assert f"{section}.{name}" in str(given_back)
        assert str(given_back).isprintable()


@hypothesis_settings(deadline=None)
@given(st.dictionaries(st.text(max_size=8) | st.sampled_from(sorted(NAMES)), json_values))
def test_any_mapping_is_either_taken_or_refused(mapping: dict[str, Any]) -> None:
    given_back = outcome(mapping)
    assert isinstance(given_back, Settings) or str(given_back).startswith("a test: ")


def test_each_setting_says_what_it_is_and_its_default_is_possible() -> None:
    assert set(known_settings()) == {f"{section}.{key}" for section, key in KEYS}
    for name, one in known_settings().items():
        assert one.meaning.endswith("."), name
        assert one.unit in UNITS, name
        assert (one.unit == "degrees") == name.endswith("_degrees"), name
        assert not one.refusal(one.default), name


def test_a_byte_order_mark_is_read_over(tmp_path: Path) -> None:
    path = tmp_path / "settings.toml"
    path.write_bytes(b"\xef\xbb\xbf[trial]\nmax_steps = 5\n")
    assert load_settings(path).trial.max_steps == 5


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-32", "latin-1"])
def test_other_encodings_are_told_what_to_do(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "settings.toml"
    path.write_bytes("# h\xf6her\n[trial]\nmax_steps = 5\n".encode(encoding))
    with pytest.raises(BadInputError, match="save it as UTF-8"):
        load_settings(path)


@pytest.mark.parametrize(
    "text",
    [
        *("arm" + ".a" * 90_000 + " = 1", "[arm" + " . a" * 90_000 + "]"),
        *("a" + ' . "b.c"' * 5 + " = 1", "x = {" + "a.a.a.a.a.a = 1}"),
        *("#\na.a.a.a.a.a = 1", '"#" = 1\na.a.a.a.a.a = 1', "'''\n''' = 1\na.a.a.a.a.a = 1"),
        "x = " + "[" * 5 + "]" * 5,
    ],
)
def test_depth_is_refused_before_it_takes_memory(tmp_path: Path, text: str) -> None:
    line = refused(tmp_path, text)
    assert "more than 4 dots in a key" in line or "more than 4 lists in one another" in line


def test_dots_in_words_and_remarks_are_no_depth(tmp_path: Path) -> None:
    text = (
        "# a.b.c.d.e.f.g, [[[[[[[\n[sensor]\n"
        "kind = 'exact' # see www.a.b.c.d.e.f\nposition_noise = 0.5\n"
    )
    assert load_settings(written(tmp_path, text)).sensor.position_noise == 0.5
    assert "a.b.c.d.e.f" in refused(tmp_path, '["a.b.c.d.e.f.g"]\nx = 1')
    assert "kind = [[[[[[[ must" in refused(tmp_path, 'sensor.kind = """[[[[[[["""')


@pytest.mark.parametrize(
    "text", [". " * 400_000, "." + " " * 900_000, "a" * 900_000, '"' * 900_001]
)
def test_looking_at_the_depth_takes_time_in_proportion(tmp_path: Path, text: str) -> None:
    """Each of these would take minutes otherwise."""
    refused(tmp_path, text)
