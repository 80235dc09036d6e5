"""``affcli figure trial``, ``results``, ``adaptation``: files, words, and what cannot be drawn."""

import sqlite3
from contextlib import closing
from pathlib import Path

import cv2
import pytest

from tests.cli.program import Arg, done, executed, names_in, refused, rows
from tests.cli.without import without

FIGURES: dict[str, tuple[str, ...]] = {
    "trial": ("trial", "9"),
    "results": ("results",),
    "adaptation": ("adaptation",),
}
"""By the arguments that draw it from `used`; trial 9 is the first with a broken tool."""


def figure(*args: Arg) -> str:
    """Draw a figure; return the one line that is said of it."""
    ended = done("figure", *args)
    assert ended.out == ""
    assert ended.err.count("\n") == 1
    return ended.err


def change(database: Path, *statements: str) -> None:
    """Write into a database what affcli would not."""
    with closing(sqlite3.connect(database)) as driver, driver:
        for statement in statements:
            driver.execute(statement)


@pytest.mark.parametrize(("name", "ending"), [*zip(FIGURES, (".png", ".svg", ".pdf"), strict=True)])
def test_the_same_figure_is_the_same_bytes_in_any_process(
    name: str, ending: str, used: Path, tmp_path: Path
) -> None:
    first, second = tmp_path / f"first{ending}", tmp_path / f"second{ending.upper()}"
    figure(*FIGURES[name], "--db", used, "--out", first)
    ended = executed("figure", *FIGURES[name], "--db", used, "--out", second, PYTHONHASHSEED="7")
    assert ended.code == 0, ended
    drawn = first.read_bytes()
    assert drawn == second.read_bytes()
    if ending == ".png":
        picture = cv2.imread(str(first))
        assert picture is not None
        assert picture.std() > 5.0
    elif ending == ".svg":
        assert b"<text" not in drawn  # letters are shapes: no font can be missing
    else:
        assert b"/FontFile2" in drawn
    assert names_in(tmp_path) == sorted([first.name, second.name, used.name])


def test_what_was_drawn_is_said(used: Path) -> None:
    out = used.with_name("f.svg")
    ((steps, outcome),) = rows(used, "SELECT steps, outcome FROM trial WHERE id = 9")
    said = figure("trial", "9", "--db", used, "--out", out)
    assert said.startswith(
        f"Trial 9: T-hook that became L-hook, goal 1, start 1; {outcome}, {steps} "
        f"step{'s' * (steps != 1)}; "
    )
    assert "; trial: seed 0; run 1: T-hook, seed " in said
    assert said.endswith(f": {out}\n")
    ((session,),) = rows(used, "SELECT id FROM session WHERE kind = 'break-tool'")
    said = figure("adaptation", "--db", used, "--out", out, "--force")
    assert said.startswith(
        "Adaptation: T-hook that became L-hook; 16 trials with the broken tool; "
        f"session {session} (break-tool), 1 robot, seed 0; "
    )
    assert "; run 1: T-hook, seed " in said


def test_without_a_reproduction_single_robots_are_shown_and_it_says_what_to_run(
    used: Path,
) -> None:
    said = figure("results", "--db", used, "--out", used.with_name("f.png"))
    assert said.startswith("Successes beside the paper's; one robot a tool: run 1: T-hook, seed ")
    assert "; run 2: Stick, seed " in said
    assert said.endswith("run affcli reproduce --robots 20\n")


@pytest.mark.parametrize("name", ["results", "adaptation"])
def test_a_reproduction_of_few_robots_has_no_intervals(name: str, reproduced: Path) -> None:
    for session in ((), ("--session", "1")):
        out = reproduced.with_name("f.png")
        said = figure(name, *session, "--db", reproduced, "--out", out, "--force")
        assert "session 1 (reproduce), 2 robots, seed " in said
        assert "too few robots for intervals: it takes 5" in said


@pytest.mark.parametrize("steps", ["1", "1-2", "2-2"])
def test_steps_can_be_named(steps: str, used: Path) -> None:
    ((trial,),) = rows(used, "SELECT id FROM trial WHERE steps >= 2 LIMIT 1")
    out = used.with_name("f.png")
    figure("trial", str(trial), "--steps", steps, "--db", used, "--out", out)
    assert out.stat().st_size > 5_000


def test_a_trial_that_has_not_ended_is_drawn_as_far_as_it_came(used: Path) -> None:
    change(
        used,
        "UPDATE trial SET outcome = NULL, steps = NULL WHERE id IN (9, 10)",
        "DELETE FROM step WHERE trial_id = 9 AND number > 1",
        "DELETE FROM step WHERE trial_id = 10",
    )
    for trial, so_far in (("9", "1 step"), ("10", "0 steps")):
        out = used.with_name(f"{trial}.pdf")
        assert f"; not ended, {so_far} so far; " in figure(
            "trial", trial, "--db", used, "--out", out
        )
        assert out.stat().st_size > 5_000


def test_a_trial_without_steps_has_none_to_name(used: Path) -> None:
    change(
        used,
        "DELETE FROM step WHERE trial_id = 9",
        "UPDATE trial SET outcome = 'no row left', steps = 0 WHERE id = 9",
    )
    args = ("figure", "trial", "9", "--db", used, "--out", used.with_name("f.png"))
    assert "no step 1 in trial 9; it has none" in refused(2, *args, "--steps", "1-3")
    assert "; no row left, 0 steps; " in figure(*args[1:])


def test_strange_names_are_letters_in_a_figure(used: Path) -> None:
    """Neither mathematics nor tags; the line that says what was drawn stays one line."""
    strange = "'<script>$\\frac{1}{ \x1b[31m 机' || char(10) || hex(zeroblob(30))"
    change(used, f"UPDATE affordance SET exploratory_behavior = {strange}")
    out = used.with_name("f.svg")
    assert figure("trial", "9", "--db", used, "--out", out).endswith("f.svg\n")
    assert b"<script" not in out.read_bytes()


USAGE: dict[str, tuple[tuple[str, ...], str]] = {
    "no trial": (("trial", "--out", "f.png"), "Missing argument 'ID'"),
    "nowhere": (("results",), "Missing option '--out'"),
    "trial in words": (("trial", "first", "--out", "f.png"), "trial first: must be a whole number"),
    "unknown trial": (("trial", "99", "--out", "f.png"), "no trial 99; they are numbered 1 to 40"),
    "unknown steps": (
        ("trial", "9", "--steps", "5-12", "--out", "f.png"),
        "in trial 9; it has steps 1 to ",
    ),
    "unknown session": (
        ("results", "--session", "9", "--out", "f.png"),
        "no session 9; they are numbered 1 to 2",
    ),
    "results of another kind": (
        ("results", "--session", "2", "--out", "f.png"),
        "session 2 is of affcli break-tool, not of reproduce; run affcli reproduce first",
    ),
    "adaptation of another kind": (
        ("adaptation", "--session", "1", "--out", "f.png"),
        "session 1 is of affcli solve, not of break-tool or reproduce or experiment; try --ses",
    ),
}

VALUES: dict[str, tuple[tuple[str, ...], str]] = {
    "trial 0": (("trial", "0", "--out", "f.png"), "trial 0: must lie in 1 to 9223372036854775807"),
    "a huge trial": (("trial", "9" * 30, "--out", "f.png"), "trial 99999"),
    "session 0": (("adaptation", "--session", "0", "--out", "f.png"), "--session 0: must lie in 1"),
    "a JPEG": (("results", "--out", "f.jpg"), "f.jpg: name it *.png or *.svg or *.pdf"),
    "no ending": (("trial", "9", "--out", "f"), "f: name it *.png or *.svg or *.pdf"),
    "over a file": (("adaptation", "--out", "mine.png"), "mine.png: exists already; name another"),
    "into no folder": (("results", "--out", "none/f.png"), "its folder does not exist; make it"),
    "over a folder": (("results", "--out", "folder.png", "--force"), "folder.png: not a file"),
    "escape sequence": (("results", "--out", "\x1b[31mred"), "\\x1b[31mred: name it *.png"),
    **{
        f"steps {steps!r}": (
            ("trial", "9", f"--steps={steps}", "--out", "f.png"),
            "must be a number or two, as in 3-5",
        )
        for steps in ("", "a-b", "0-3", "5-2", "-1", "1-2-3", "1-", "1,2", "\u0661-\u0662")
    },
    "too many steps": (("trial", "9", "--steps", "1-17", "--out", "f.png"), "at most 16 steps fit"),
}


@pytest.fixture
def folder(used: Path) -> Path:
    """A folder with a database, used.db, and a file that is not to be touched."""
    (used.parent / "mine.png").write_text("precious")
    (used.parent / "folder.png").mkdir()
    return used.parent


@pytest.mark.parametrize(
    ("code", "args", "says"),
    [(code, *one) for code, all_ in ((2, USAGE), (4, VALUES)) for one in all_.values()],
    ids=[*USAGE, *VALUES],
)
def test_what_cannot_be_drawn_is_one_line_and_no_file(
    code: int, args: tuple[str, ...], says: str, folder: Path
) -> None:
    before = names_in(folder)
    line = refused(code, "figure", *args, "--db", "used.db", cwd=folder)
    assert says in line
    assert names_in(folder) == before
    assert (folder / "mine.png").read_text() == "precious"


def test_a_file_is_written_over_by_force(folder: Path) -> None:
    done("figure", "results", "--db", "used.db", "--out", "mine.png", "--force", cwd=folder)
    assert cv2.imread(str(folder / "mine.png")) is not None


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("trial", "no trial 9; there are none yet"),
        ("results", "no finished reproduction and no trials of affcli solve yet; run affcli repr"),
        ("adaptation", "no finished trials with a broken tool yet; run affcli break-tool, or affc"),
    ],
)
def test_an_empty_database_has_nothing_to_draw(name: str, says: str, empty: Path) -> None:
    out = empty.with_name("f.png")
    assert says in refused(2, "figure", *FIGURES[name], "--db", empty, "--out", out)
    missing = empty.with_name("none.db")
    line = refused(3, "figure", *FIGURES[name], "--db", missing, "--out", out)
    assert "no database there" in line
    assert names_in(empty.parent) == [empty.name]


@pytest.mark.parametrize("name", ["results", "adaptation"])
def test_a_session_that_was_interrupted_is_not_drawn(name: str, reproduced: Path) -> None:
    change(reproduced, "UPDATE session SET status = 'running'")
    args = (name, "--db", reproduced, "--out", reproduced.with_name("f.png"))
    assert "it goes on from there" in refused(2, "figure", *args, "--session", "1")
    assert "run affcli " in refused(2, "figure", *args)


def test_without_matplotlib_it_says_what_to_install(used: Path) -> None:
    out = str(used.with_name("f.png"))
    ended = without("matplotlib", "figure", *FIGURES["trial"], "--db", str(used), "--out", out)
    assert ended.code == 2
    assert ended.err == (
        "affcli: figures need Matplotlib and Pillow; install them: pip install 'affcli[figures]'\n"
    )


def test_a_figure_by_itself_lists_the_figures() -> None:
    ended = done("figure", "--help", COLUMNS="40")
    for name in FIGURES:
        assert name in ended.out
