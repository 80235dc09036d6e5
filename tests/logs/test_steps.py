"""From a log to runs: counters by the 40-degree rule, rows by T, and what is not known is NaN."""

import math
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from affcli.core.affordance import replicates
from affcli.core.log import counters_of_repeats
from affcli.core.observation import Movement
from affcli.logs.reading import read_log
from affcli.logs.steps import runs_of
from tests.logs.made_up import MAP, mapped

movements = st.builds(
    lambda length, degrees: Movement(
        length * math.cos(math.radians(degrees)), length * math.sin(math.radians(degrees)), 0.0
    ),
    st.sampled_from((0.0, 0.3, 0.7, 4.0)),
    st.integers(-1800, 1800).map(lambda tenths: tenths / 10.0 + 0.03 * (tenths % 7)),
)


@given(st.lists(movements, min_size=1, max_size=30))
def test_counters_are_those_of_each_repeat_tried_on_each_row(some: list[Movement]) -> None:
    """What `replicates` says of each pair, but for angles of 40 degrees to the last bit."""
    for row, (successful, used) in zip(some, counters_of_repeats(some), strict=True):
        least, most = (
            sum(replicates(row, seen, 40.0 + slack) for seen in some) for slack in (-1e-9, 1e-9)
        )
        moved = row.distance > 0.5
        assert used == len(some)
        assert successful == 0 if not moved else least <= successful <= most


def test_a_trial_that_moved_the_object_makes_a_row(tmp_path: Path) -> None:
    lines = (
        ("rake cup 3", -0.5, -0.4),
        ("rake cup 3", -0.5, -0.4),
        ("rake cup 3", -0.5, -0.5),
        ("rake ball 3", -0.5, -0.4),
        ("stick cup 3", -0.5, -0.6),
    )
    path = tmp_path / "log.txt"
    path.write_text("\n".join(f"{who} {a} 0 0 0 {b} 0 0 0" for who, a, b in lines))
    rake, stick = runs_of(read_log([path], mapped(tmp_path, MAP)))
    assert [str(one.call) for one in rake.spec.repertoire] == ["draw"]
    assert (rake.spec.behaviors, stick.spec.behaviors) == (4, 1)
    rows = [record.affordance for record, _ in rake.steps]
    counters = [row and (row.times_successful, row.times_used) for row in rows]
    assert counters == [(2, 3), (2, 3), None, (1, 1)]
    assert rows[0] is not None
    assert rows[0].expected_movement.dy < -3.9
    assert math.isnan(rows[0].wrist_angle)
    assert not rows[0].is_placed()
    assert [line.line for line in rake.lines] == [1, 2, 3, 4]
    assert rake.spec.logged
    assert stick.spec.key != rake.spec.key


def test_repeats_begin_at_the_same_place_where_it_is_known(tmp_path: Path) -> None:
    how = MAP.replace("start_x = 4", "offset_x = 6\noffset_y = 7\nstart_x = 4")
    path = tmp_path / "log.txt"
    path.write_text("".join(f"rake cup 3 -0.5 0 {x} 0 -0.4 0 0 0\n" for x in (0.3, 0.301, 0.9)))
    (run,) = runs_of(read_log([path], mapped(tmp_path, how)))
    used = [record.affordance and record.affordance.times_used for record, _ in run.steps]
    assert used == [2, 2, 1]


def test_the_same_files_by_the_same_map_are_the_same_run(tmp_path: Path) -> None:
    """Where they lie, and what is said of their source, makes no other run of them."""
    keys = set()
    text = "rake cup 3 -0.5 0 0 0 -0.4 0 0 0\n"
    for name, how in (("a", MAP), ("b", MAP.replace("made up", "made")), ("c", MAP + "5 = 'lift'")):
        path = tmp_path / name
        path.write_text(text)
        (run,) = runs_of(read_log([path], mapped(tmp_path, how)))
        keys.add(run.spec.key)
    assert len(keys) == 2
