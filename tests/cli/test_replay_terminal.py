"""``affcli replay`` on a terminal: played, gone through step by step, and left by ctrl-C."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from rich.cells import cell_len

from tests.cli.program import done, executed
from tests.cli.pseudo_terminal import COLOR, CTRL_C, CTRL_D, ESCAPE, on_terminal
from tests.cli.test_replay import BRAILLE, SOLVED, same, steps_of, titles_in

NEXT = "; q: leave > "
STOPPED = "affcli: stopped; what was saved is kept"


def played(*args: str, database: Path, **options: Any) -> tuple[int, str]:
    """Replay on a terminal; return the exit code and what it got, without colours."""
    code, shown = on_terminal("replay", *args, "--db", database, **options)
    assert "Traceback" not in shown, shown
    return code, shown


def prompts(shown: str) -> list[str]:
    """Return the questions that were asked."""
    plain = ESCAPE.sub("", shown)
    return [line.split(";")[0] for line in plain.splitlines() if line.startswith("Enter: ")]


def test_enter_goes_from_step_to_step(used: Path) -> None:
    count = steps_of(SOLVED, used)
    enter = [(NEXT, "\n")] * (count - 1)
    code, shown = played(SOLVED, database=used, answers=enter)
    assert code == 0
    assert prompts(shown) == ["Enter: the next"] * (count - 1)
    assert shown.endswith(same(SOLVED, used))
    assert shown.count("\x1b[?25l") == count
    assert cursor_is_shown(shown)
    plain = ESCAPE.sub("", shown)
    for phase in ("[choose a row]", "[position wrist]", "[compare]"):
        assert phase in plain


def cursor_is_shown(shown: str) -> bool:
    """Tell whether a terminal shows the cursor in the end."""
    return shown.rfind("\x1b[?25h") > shown.rfind("\x1b[?25l") >= 0


@pytest.mark.parametrize("leave", ["q\n", "Q\n", "2\n", b"\xff\xfe\n", "9" * 3000 + "\n"])
def test_whatever_is_typed_leaves(leave: str | bytes, used: Path) -> None:
    code, shown = played(SOLVED, database=used, answers=[(NEXT, "\n"), (NEXT, leave)])
    assert code == 0
    assert len(prompts(shown)) == 2
    assert shown.endswith(same(SOLVED, used))


def test_the_end_of_the_input_leaves(used: Path) -> None:
    code, shown = played(SOLVED, database=used, answers=[(NEXT, CTRL_D)])
    assert code == 0
    assert shown.endswith(f"{NEXT}\n{same(SOLVED, used)}")


def test_a_single_step_asks_nothing(used: Path) -> None:
    code, shown = played(SOLVED, "--steps", "2", database=used)
    assert (code, prompts(shown)) == (0, [])


def test_behaviors_are_gone_through_one_by_one(learned: Path) -> None:
    run = ("--run", "1", "--steps", "2-3")
    code, shown = played(*run, database=learned, answers=[(NEXT, "\n")])
    assert code == 0
    assert prompts(shown) == ["Enter: the next"]
    assert shown.endswith("run 1: the replay equals the record, the first 3 behaviors\n")
    code, shown = played("--run", "1", database=learned, answers=[(NEXT, "q\n")])
    assert code == 0
    assert shown.endswith("run 1: the replay equals the record, the first one behavior\n")


@pytest.mark.parametrize("can_type", [True, False])
@pytest.mark.parametrize("what", [(SOLVED,), ("--run", "1", "--steps", "1-4")])
def test_with_a_speed_all_is_played_without_asking(
    what: Sequence[str], can_type: bool, used: Path
) -> None:
    code, shown = played(*what, "--speed", "100", database=used, can_type=can_type)
    assert (code, prompts(shown)) == (0, [])
    assert "the replay equals the record" in shown
    assert cursor_is_shown(shown)
    assert shown.count("\x1b[?25l") == 1


def test_a_film_takes_the_time_that_it_should(used: Path) -> None:
    """No frame is due before its time: as many as there is time for are drawn."""
    frames = done("replay", SOLVED, "--steps", "1", "--json", "--db", used).result
    (step,) = frames["steps"]
    code, shown = played(SOLVED, "--steps", "1", "--speed", "8", database=used)
    assert code == 0
    drawn = ESCAPE.sub("", shown).count("Trial ")
    assert 3 < drawn <= step["frames"] + 3


def test_where_nobody_can_answer_nothing_is_asked(used: Path) -> None:
    code, shown = played(SOLVED, database=used, can_type=False)
    assert (code, prompts(shown)) == (0, [])
    assert titles_in(ESCAPE.sub("", shown)) == [1, 2, 3, 4]


def test_a_dumb_terminal_gets_each_step_once(used: Path) -> None:
    code, shown = played(
        *(SOLVED, "--steps", "1-2"),
        database=used,
        answers=[(NEXT, "\n")],
        TERM="dumb",
    )
    assert code == 0
    assert not ESCAPE.search(shown)
    assert titles_in(shown) == [1, 2]


@pytest.mark.parametrize("columns", [20, 80, 200])
def test_on_a_terminal_nothing_is_wider_than_it(columns: int, used: Path) -> None:
    code, shown = played(
        *(SOLVED, "--steps", "1-2"),
        database=used,
        columns=columns,
        answers=[("leave > ", "\n")],
    )
    assert code == 0
    lines = ESCAPE.sub("", shown).replace("\r", "\n").splitlines()
    assert max(map(cell_len, lines)) <= columns


def test_the_map_takes_the_width_there_is(used: Path) -> None:
    widths = []
    for columns in (80, 120, 160):
        shown = executed("replay", SOLVED, "--steps", "1", "--db", used, COLUMNS=str(columns)).out
        drawn = (re.match(r"[\u2800-\u28ff ]*", line) for line in shown.splitlines())
        widths.append(max(len(found[0].rstrip()) for found in drawn if found))
        assert max(map(cell_len, shown.splitlines())) <= columns
    assert 38 <= widths[0] <= 42
    assert widths[1] > 75
    assert widths[2] > 110


def test_colors_are_for_those_who_want_them(used: Path) -> None:
    code, shown = played(SOLVED, "--speed", "100", database=used)
    assert code == 0
    assert COLOR.search(shown)
    code, shown = played(SOLVED, "--speed", "100", database=used, NO_COLOR="1")
    assert code == 0
    assert not COLOR.search(shown)


def test_braille_is_for_those_who_can_show_it(used: Path) -> None:
    """Everybody else gets plain letters, and the same words."""
    replay = ("replay", SOLVED, "--db", used)
    in_dots, plain = (
        executed(*replay, PYTHONIOENCODING=encoding).out for encoding in ("utf-8", "ascii")
    )
    assert any(ord(letter) in BRAILLE for letter in in_dots)
    assert plain.isascii()
    assert "\\u" not in plain
    assert "oooo" in plain
    for word in ("row ", "replicated", "[compare]"):
        assert in_dots.count(word) == plain.count(word) > 0
    code, shown = played(SOLVED, "--speed", "100", database=used, TERM="linux")
    assert code == 0
    assert "oooo" in ESCAPE.sub("", shown)
    assert shown.isascii()


@pytest.mark.parametrize("when", ["[position wrist]", "[slide arm right", NEXT])
def test_ctrl_c_leaves_in_one_line_with_the_cursor_shown(when: str, used: Path) -> None:
    options = () if when == NEXT else ("--speed", "0.5")
    code, shown = played(SOLVED, *options, database=used, answers=[(when, CTRL_C)])
    assert code == 130
    assert cursor_is_shown(shown)
    plain = ESCAPE.sub("", shown)
    assert plain.endswith(f"\n{STOPPED}\n")
    assert plain.count(STOPPED) == 1
