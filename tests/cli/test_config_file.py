"""``--config``: a file of settings that is missing, not TOML, unknown, or out of range (4)."""

import json
from pathlib import Path

import pytest

from tests.cli.program import done, names_in, refused, rows

BAD = {
    "not TOML": (b"tools are useful", "not TOML"),
    "not text": (b"\xff\xfe\x00", "not TOML"),
    "a NUL": (b"[sensor]\nposition_noise = \x00", "not TOML"),
    "unknown section": (b"[robot]\narms = 2", "no section robot; the sections are arm, "),
    "unknown key": (b"[sensor]\nnoise = 0.1", "no key sensor.noise; known: color_noise, "),
    "no section": (b"sensor = 1", "sensor must be a section, [sensor]"),
    "NaN": (b"[sensor]\nposition_noise = nan", "sensor.position_noise = nan must lie in [0, "),
    "infinite": (b"[friction]\ntool_puck = inf", "friction.tool_puck = inf must lie in [0, "),
    "past any float": (b"[friction]\ntool_puck = 1e999", "friction.tool_puck = inf must lie in"),
    "negative mass": (b"[puck]\nmass = -0.1", "puck.mass = -0.1 must lie in [0.001, "),
    "negative friction": (b"[friction]\npuck_table = -1", "friction.puck_table = -1 must lie in ["),
    "text": (b'[puck]\nmass = "heavy"', "puck.mass = heavy must be a number"),
    "a truth": (b"[puck]\nmass = true", "puck.mass = True must be a number"),
    "half a step": (b"[trial]\nmax_steps = 1.5", "trial.max_steps = 1.5 must be a whole number"),
    "deeply nested": (b"a = " + b"[" * 100_000, "not TOML"),
    "100,000 digits": (b"[puck]\nmass = " + b"1" * 100_000, "not TOML"),
    "6,000 hexadecimal digits": (b"[puck]\nmass = 0x" + b"f" * 6000, "puck.mass = (int too large"),
    "2 MB": (b"# a long remark\n" * 125_000, "more than 1000000 bytes"),
    "escape sequence": (b'["\\u001b[31mred"]\nx = 1', "no section \\x1b[31mred"),
    "markup": (b'["[/]"]\nx = 1', "no section [/]"),
    "10 kB name": (b"[" + b"x" * 10_000 + b"]\ny = 1", "no section xxx"),
}


@pytest.mark.fault(21)
@pytest.mark.fault(23)
@pytest.mark.parametrize(("text", "says"), BAD.values(), ids=BAD.keys())
def test_bad_settings_are_named(text: bytes, says: str, tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_bytes(text)
    line = refused(4, "learn", "--tool", "stick", "--config", "my.toml", cwd=tmp_path)
    assert "config my.toml: " in line
    assert says in line
    assert names_in(tmp_path) == ["my.toml"]


@pytest.mark.parametrize("command", [("learn", "--tool", "stick"), ("reproduce",)])
def test_a_file_that_cannot_be_read(command: tuple[str, ...], tmp_path: Path) -> None:
    for path in ("none.toml", "."):
        line = refused(4, *command, "--config", path, cwd=tmp_path)
        assert line.endswith("; give a TOML file that can be read")
    assert names_in(tmp_path) == []


def test_a_file_without_end_is_not_read_to_its_end(tmp_path: Path) -> None:
    line = refused(4, "learn", "--tool", "stick", "--config", "/dev/zero", cwd=tmp_path)
    assert "more than 1000000 bytes" in line


def test_a_box_that_no_wrist_position_reaches_is_refused(tmp_path: Path) -> None:
    """Babbling would put the attractor back for ever."""
    (tmp_path / "my.toml").write_text("[babbling]\noffset_y_min = 100.0\noffset_y_max = 200.0\n")
    args = ("learn", "--tool", "stick", "--behaviors", "5", "--config", "my.toml")
    line = refused(4, *args, cwd=tmp_path)
    assert "1000 times in a row no wrist position" in line


def test_settings_make_another_run(tmp_path: Path) -> None:
    """The same tool and seed with other settings is another run, and each keeps its own."""
    (tmp_path / "my.toml").write_text("[friction]\ntool_puck = 0.5\n")
    command = ("learn", "--tool", "stick", "--behaviors", "5", "--db", "my.db")
    done(*command, cwd=tmp_path)
    done(*command, "--config", "my.toml", cwd=tmp_path)
    assert "already learned" in done(*command, "--config", "my.toml", cwd=tmp_path).err
    stored = rows(tmp_path / "my.db", "SELECT settings FROM learning_run ORDER BY id")
    assert [json.loads(text).get("friction.tool_puck") for (text,) in stored] == [None, 0.5]
