"""A log read by its map: units, axes, names, offsets, headers; bad lines are named, no more."""

import math
from pathlib import Path

import pytest

from affcli.core.geometry import Point
from affcli.errors import BadInputError
from affcli.logs import reading
from affcli.logs.reading import Log, read_log
from tests.logs.made_up import MAP, REPEATS, mapped, written

CSV = """
[log]
source = "made up"
header = true
separator = "semicolon"
decimal = ","
comment = "#"
[columns]
tool = "tool"
start_x = "x"
start_y = "y"
end_x = "x2"
end_y = "y2"
clock = "t"
[constants]
behavior = "pull"
offset_x = 10
offset_y = 20
[parameters]
speed_angle = "angle"
reach = "reach"
[units]
length = "cm"
angle = "radians"
time = "ms"
[axes]
right = "-y"
away = "x"
"""


def read(tmp_path: Path, how: str, *texts: str) -> Log:
    """Return what is read of some files."""
    paths = [tmp_path / f"{number}.txt" for number in range(1, len(texts) + 1)]
    for path, text in zip(paths, texts, strict=True):
        path.write_text(text)
    return read_log(paths, mapped(tmp_path, how))


def test_a_log_without_header_is_read_in_the_table_frame(tmp_path: Path) -> None:
    log = read(tmp_path, MAP, "rake cup 3 -0.508 0.0254 1 2 -0.254 -0.0254 3 4\r\n\n")
    (trial,) = log.trials
    assert (trial.tool, trial.object, str(trial.call)) == ("rake", "cup", "draw")
    assert trial.start == pytest.approx(Point(1.0, 20.0))
    assert trial.end == pytest.approx(Point(-1.0, 10.0))
    assert all(map(math.isnan, (*trial.offset, trial.clock, trial.duration)))
    assert (trial.file, trial.line, log.left_out) == (1, 1, 0)


def test_a_log_with_header_constants_parameters_and_commas(tmp_path: Path) -> None:
    text = "\ufeff# a remark\nt;tool;x;y;x2;y2;angle;reach\n1500;rake;2,54;0;5,08;2,54;0,5;-\n"
    (trial,) = read(tmp_path, CSV, text).trials
    assert trial.start == pytest.approx(Point(0.0, 1.0))
    assert trial.end == pytest.approx(Point(-1.0, 2.0))
    assert trial.offset == pytest.approx(Point(-20.0 / 2.54, 10.0 / 2.54))
    assert trial.call.name == "pull"
    assert dict(trial.call.params) == {"speed_angle": pytest.approx(math.degrees(0.5))}
    assert (trial.clock, trial.line, trial.object) == (1.5, 3, None)


def test_the_offset_follows_from_the_wrist(tmp_path: Path) -> None:
    how = MAP.replace("start_x = 4", "wrist_x = 6\nwrist_y = 7\nstart_x = 4")
    (trial,) = read(tmp_path, how, "rake cup 3 -0.508 0.0254 -0.254 0 -0.2 0 3 4\n").trials
    assert trial.offset == pytest.approx(Point(1.0, 10.0))
    (unknown,) = read(tmp_path, how, "rake cup 3 -0.508 0.0254 nan 0 -0.2 0 3 4\n").trials
    assert all(map(math.isnan, unknown.offset))


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("rake cup 3 0 0 1 2 0 0 3", "10 columns, the others have 11"),
        ("rake cup 3 0 0 1 2 0", "8 columns, the map names 9"),
        ("rake cup 9 0 0 1 2 0 0 3 4", "behavior 9: [names.behavior] has no such name"),
        ("rake cup 3 x 0 1 2 0 0 3 4", "start_x = x: no number within 10000"),
        ("rake cup 3 1_0 0 1 2 0 0 3 4", "start_x = 1_0: no number"),
        ("rake cup 3 inf 0 1 2 0 0 3 4", "start_x = inf: no number"),
        ("rake cup 3 nan 0 1 2 0 0 3 4", "where the object was is not said: start"),
        ("rake cup 3 0 0 1 2 0 1e9 3 4", "end_y = 1e9"),
        ("-rake cup 3 0 0 1 2 0 0 3 4", "tool = -rake: must be a word"),
        ("ra\x1bke cup 3 0 0 1 2 0 0 3 4", "tool = ra\\x1bke"),
        ("rake cup 3 " + "0" * 30_000, "more than 20000 letters"),
    ],
)
def test_a_bad_line_is_left_out_and_named(tmp_path: Path, line: str, why: str) -> None:
    good = "rake cup 3 0 0 1 2 0 0 3 4"
    log = read(tmp_path, MAP, f"{good}\n{line}\n{good}\n")
    assert [trial.line for trial in log.trials] == [1, 3]
    assert log.left_out == 1
    assert str(log.bad[0]).startswith(f"{tmp_path}/1.txt:2: {why}")
    assert str(log.bad[0]).isprintable()


def test_all_bad_lines_are_counted_and_the_first_remembered(tmp_path: Path) -> None:
    log = read(tmp_path, MAP, "a b 3 0 0 1 2 0 0 3 4\n" * 200 + "x\n" * 150)
    assert (len(log.trials), log.left_out, len(log.bad)) == (200, 150, reading.NAMED)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no trial in"),
        ("x y\n", "no line fits the map; the first: "),
        (b"\xff\xfe", "no text in UTF-8 at byte 0"),
        ("a\0b\n", "there is a NUL in it"),
    ],
)
def test_what_is_no_log_is_refused_in_one_line(
    tmp_path: Path, text: str | bytes, says: str
) -> None:
    path = tmp_path / "log.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(BadInputError) as told:
        read_log([path], mapped(tmp_path, MAP))
    assert says in str(told.value)
    assert str(told.value).isprintable()


def test_a_column_that_is_nowhere_or_twice_is_named(tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match=r"column reach \(parameters.reach\) stands nowhere"):
        read(tmp_path, CSV, "t;tool;x;y;x2;y2;angle\n1;a;0;0;0;0;0\n")
    with pytest.raises(BadInputError, match=r"column x .* stands twice"):
        read(tmp_path, CSV, "t;tool;x;x;x2;y2;angle;reach;y\n")


def test_there_are_limits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "MOST_TRIALS", 3)
    with pytest.raises(BadInputError, match="more than 3 trials; import them in parts"):
        read(tmp_path, MAP, "a b 3 0 0 1 2 0 0 3 4\n" * 4)
    with pytest.raises(BadInputError, match="its header has more than 20000 letters"):
        read(tmp_path, CSV, '"' + "x" * 200_000)
    monkeypatch.setattr(reading, "LARGEST_LOG", 10)
    with pytest.raises(BadInputError, match="more than 10 bytes"):
        read(tmp_path, MAP, "a b 3 0 0 1 2 0 0 3 4\n")


def test_the_made_up_log_is_read_whole(tmp_path: Path) -> None:
    written(tmp_path)
    log = read_log(sorted((tmp_path / "log").rglob("*.txt")), mapped(tmp_path, MAP))
    assert (len(log.files), len(log.trials), log.left_out) == (24, 24 * REPEATS, 0)
