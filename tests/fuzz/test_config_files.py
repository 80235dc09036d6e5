"""Whatever stands in a file that a command reads: it works, or is told in one line (2 or 4)."""

import json
import string
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import strategies as st

from affcli.config import Settings
from affcli.core.observation import SENSOR_KINDS
from tests.cli.forked import Forked
from tests.fuzz.conftest import Fuzz
from tests.fuzz.running import check_ending, is_sound

DEFAULTS: dict[str, dict[str, Any]] = {}
for _name, _value in Settings().values().items():
    _section, _key = _name.split(".")
    DEFAULTS.setdefault(_section, {})[_key] = _value
KEYS = [(section, key) for section, values in DEFAULTS.items() for key in values]

NUMBERS = (
    *("0", "-0", "0.0", "-0.0", "1", "-1", "1.0", "1e-3", "0.000999", "1e-9", "5e-324", "1e-6"),
    *("1e6", "1000000.1", "1_000_000", "1e308", "-1e308", "1e999", "nan", "-nan", "inf", "-inf"),
    *("9223372036854775807", "9223372036854775808", "-9223372036854775808", "9" * 400, "0x7f"),
    *("0b1", "0o7", "9" * 5000, "89.9", "90", "90.1", "180", "360", "0.5", "2", "3", "100", "255"),
)
OTHERS = (
    *('"1"', "'x'", '""', "true", "false", "[1]", "[]", "[[[]]]", "{}", "{ x = 1 }", "1979-05-27"),
    *("07:32:00", "1979-05-27T07:32:00Z", '"\\u0000"', '"\\u001b[31m"', '"camera"', '"exact"'),
    *('"noisy"', '"NOISY"', "1,", "= 1", "", "#", "'''\nx'''", '"[/]"', "0x", "1__0", ".5", "5."),
)
SECTIONS = (*DEFAULTS, "workspace", "Arm", "arm.x", '""', "arm]x", '"\\u001b"', "x", "robot")
STRANGE_KEYS = (
    "kind",
    "x",
    "",
    '""',
    "a.b",
    '"[/]"',
    "upper arm",
    "\x1b",
    "h\u00e4nd",
    "__class__",
)


@st.composite
def near_defaults(draw: st.DrawFn) -> str:
    """Draw values of some keys, each within reach of what it usually is, or at a limit."""
    lines = []
    for section, key in draw(st.lists(st.sampled_from(KEYS), min_size=1, max_size=6, unique=True)):
        usual = DEFAULTS[section][key]
        if isinstance(usual, str):
            value = json.dumps(draw(st.sampled_from(SENSOR_KINDS)))
        else:
            factor = draw(
                st.floats(0.5, 2.0)
                | st.sampled_from((0.1, 0.5, 0.9, 1.1, 2.0, 10.0))
                | st.sampled_from((0.0, 0.01, 100.0, 1e4, -1.0))
            )
            number = (usual or 1.0) * factor
            value = str(round(number) if isinstance(usual, int) else number)
            value = draw(st.sampled_from(NUMBERS)) if draw(st.integers(0, 4)) == 0 else value
        lines.append(f"{section}.{key} = {value}\n")
    return "".join(lines)


@st.composite
def strange_toml(draw: st.DrawFn) -> str:
    """Draw what looks like a file of settings, with anything in it."""
    lines = []
    for section in draw(st.lists(st.sampled_from(SECTIONS), min_size=1, max_size=3)):
        lines.append(draw(st.sampled_from((f"[{section}]", f"[[{section}]]", f"{section} = 1"))))
        known = list(DEFAULTS.get(section, {})) or ["x"]
        for key in draw(st.lists(st.sampled_from(known), max_size=3)):
            written = draw(st.sampled_from((key, key, key, f'"{key}"', *STRANGE_KEYS)))
            value = draw(st.sampled_from((*NUMBERS, *OTHERS)) | st.floats().map(str))
            lines.append(f"{written} = {value}")
    return draw(st.sampled_from(("\n", "\r\n", "\r"))).join(lines)


nested = st.integers(1, 4000).flatmap(
    lambda depth: st.sampled_from(
        (
            "[arm]\nupper_arm = " + "[" * depth + "]" * depth,
            "[arm]\nupper_arm = " + "{x = " * depth + "1" + "}" * depth,
            "[arm" + ".x" * depth + "]\n",
            "arm" + ".x" * depth + " = 1\n",
        )
    )
)
files = st.one_of(
    near_defaults().map(str.encode),
    near_defaults().map(str.encode),
    strange_toml().map(str.encode),
    strange_toml().map(str.encode),
    nested.map(str.encode),
    st.text(alphabet=string.printable, max_size=80).map(str.encode),
    st.binary(max_size=80),
    st.tuples(strange_toml().map(str.encode), st.integers(0, 200), st.binary(max_size=3)).map(
        lambda parts: parts[0][: parts[1]] + parts[2] + parts[0][parts[1] :]
    ),
)
RUNS: tuple[tuple[str, ...], ...] = (
    ("learn", "--tool", "t-hook", "--behaviors", "25"),
    ("learn", "--tool", "stick", "--behaviors", "10"),
    ("learn", "--tool", "l-hook", "--hours", "0.05"),
    ("camera", "view", "--out", "out.png", "--force"),
    ("camera", "calibrate"),
    ("figure", "workspace", "--out", "out.png", "--force"),
    ("figure", "tools", "--out", "out.png", "--force"),
)
AFTER: tuple[tuple[str, ...], ...] = (
    ("solve", "--goal", "1", "--start", "1"),
    ("verify", "--tool", "t-hook", "--rows", "2"),
    ("predict", "--tool", "t-hook", "--pushes", "2"),
    ("break-tool",),
    ("report",),
    ("report", "--html", "out.html", "--force"),
    ("replay", "--run", "1"),
    ("figure", "affordances", "--run", "1", "--out", "out.png", "--force"),
)
"""What works on with what was learned under the settings."""


@pytest.mark.torture
@pytest.mark.fault(23)
def test_every_file_of_settings_is_worked_with_or_refused(
    program: Forked, tmp_path: Path, fuzzing: Fuzz
) -> None:
    config, database = tmp_path / "odd.toml", tmp_path / "odd.db"

    def check(case: tuple[bytes, tuple[str, ...], tuple[str, ...]]) -> None:
        text, first, then = case
        config.write_bytes(text)
        database.unlink(missing_ok=True)
        ended = program.run([*first, "--config", "odd.toml", *place(first)], tmp_path)
        check_ending(" ".join(first[:2]), ended)
        assert ended.code in {0, 2, 4}, ended
        if ended.code and not ended.stopped:
            places = ("odd.toml", "counts for nothing", *DEFAULTS)
            assert any(place in ended.err for place in places), ended
        if ended.code == 0 and first[0] == "learn":
            after = program.run([*then, *place(then)], tmp_path)
            check_ending(" ".join(then[:2]), after)
        assert not database.exists() or is_sound(database)

    def place(args: tuple[str, ...]) -> tuple[str, ...]:
        takes_none = args[:2] in {("camera", "calibrate"), *NO_DATABASE}
        return () if takes_none else ("--db", "odd.db")

    cases = st.tuples(files, st.sampled_from(RUNS), st.sampled_from(AFTER))
    fuzzing("files of settings", check, cases, few=24, share=0.25)


NO_DATABASE = {("figure", "workspace"), ("figure", "tools")}

CALIBRATION_VALUES = st.sampled_from(
    (*NUMBERS, '"x"', "null", "true", "[]", "{}", "[1, 2, 3]", "NaN", "Infinity", "-Infinity")
)


@pytest.mark.torture
@pytest.mark.fault(23)
def test_every_file_of_the_camera_is_worked_with_or_refused(
    program: Forked, place: Callable[[], Path], fuzzing: Fuzz
) -> None:
    home = place()
    calibration = json.loads((home / "calibration.json").read_text())
    pictures = {name: (home / name).read_bytes() for name in ("view.png", "pattern.png")}

    def check(case: tuple[str, Any]) -> None:
        kind, drawn = case
        args: tuple[str, ...] = ("camera", "locate", "view.png", "--calibration", "odd.json")
        (home / "odd.json").write_text(json.dumps(calibration))
        if kind == "calibration":
            (home / "odd.json").write_text(altered(calibration, *drawn))
        elif kind == "bytes":
            (home / "odd.json").write_bytes(drawn)
        elif kind == "colors":
            (home / "odd.toml").write_bytes(drawn)
            args = (*args, "--colors", "odd.toml")
        else:
            name, at, raw = drawn
            whole = pictures[name]
            spoilt = whole[: int(at * len(whole))] + raw
            (home / "odd.png").write_bytes(spoilt + whole[len(spoilt) :])
            args = ("camera", "calibrate", "odd.png")
            if name == "view.png":
                args = ("camera", "locate", "odd.png", "--calibration", "odd.json")
        ended = program.run(args, home)
        check_ending(" ".join(args[:2]), ended)
        assert ended.code in {0, 2, 4}, ended

    colors = st.tuples(
        st.sampled_from(("cup", "", "a b", "[/]", '"\\u001b"')),
        st.lists(st.sampled_from((*NUMBERS, "30", "110", "200")), max_size=4),
        st.sampled_from((*NUMBERS, *OTHERS)),
    ).map(lambda c: f"[{c[0]}]\nrgb = [{', '.join(c[1])}]\nheight = {c[2]}\n".encode())
    cases = st.one_of(
        st.tuples(
            st.just("calibration"),
            st.tuples(st.integers(0, 500), CALIBRATION_VALUES, st.booleans()),
        ),
        st.tuples(st.just("bytes"), st.binary(max_size=40)),
        st.tuples(st.just("colors"), colors | st.binary(max_size=40)),
        st.tuples(
            st.just("picture"),
            st.tuples(
                st.sampled_from(("view.png", "pattern.png")),
                st.floats(0.0, 1.0) | st.floats(0.0, 0.0005),
                st.binary(min_size=1, max_size=8),
            ),
        ),
    )
    fuzzing("files of the camera", check, cases, few=16, share=0.05)


def altered(value: Any, which: int, by: str, leave_out: bool) -> str:
    """Return JSON with one of its values replaced, or left out."""
    places: list[tuple[Any, Any]] = []

    def walk(inner: Any) -> None:
        steps = inner.items() if isinstance(inner, dict) else enumerate(inner)
        for key, below in steps:
            places.append((inner, key))
            if isinstance(below, dict | list):
                walk(below)

    copy = json.loads(json.dumps(value))
    walk(copy)
    if not places:
        return by
    holder, key = places[which % len(places)]
    if leave_out:
        del holder[key]
        return json.dumps(copy)
    holder[key] = "\x00here"
    return json.dumps(copy).replace('"\\u0000here"', by)
