"""``affcli figure``: affordances, row, workspace, tools, learning."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from affcli.cli.options import FIGURE_ENDINGS
from affcli.report.figures.canvas import FORMATS
from affcli.store import open_store
from tests.cli.program import Arg, Ended, done, names_in, refused, rows
from tests.cli.without import without
from tests.factories import learning_spec
from tests.lab.quick import NOW

OF_DATABASE: dict[str, tuple[tuple[str, ...], str]] = {
    "the latest run of the T-hook": (("affordances",), "What the T-hook affords; "),
    "a run": (("affordances", "--run", "2"), "What the Stick affords; "),
    "the latest run of a tool": (("affordances", "--tool", "stick"), "What the Stick affords; "),
    "two runs": (("affordances", "--compare", "2"), "What runs 1 and 2 have in common; "),
    "a broken tool's trial": (
        ("affordances", "--after-trial", "9"),
        "Trial 9: what the T-hook that became L-hook unlearned; ",
    ),
    "a whole tool's trial": (
        ("affordances", "--after-trial", "1"),
        "Trial 1: what the Stick unlearned",
    ),
    "a row": (("row", "1"), "Row 1 of the T-hook's affordance table; run 1: T-hook, seed "),
    "all runs": (("learning",), "Learning over robot time; 2 learning runs; "),
    "a run's curve": (("learning", "--run", "2"), "Learning over robot time; run 2: Stick, seed "),
    "a tool's curve": (
        ("learning", "--tool", "t-hook"),
        "Learning over robot time; run 1: T-hook, seed ",
    ),
}
OF_NOTHING: dict[str, tuple[tuple[str, ...], str]] = {
    "workspace": (
        ("workspace",),
        "T-hook at the centre; the bare arm reaches from 0.0 to 18.8 in; default settings",
    ),
    "workspace with a stick": (("workspace", "--tool", "stick"), "Stick at the centre; "),
    "tools": (("tools",), "The tools, to scale; T-hook that became L-hook; default settings: "),
    "tools, another break": (("tools", "--becomes", "stick"), "T-hook that became Stick; "),
    "tools of other sizes": (
        ("tools", "--set", "tools.bar_reach=7"),
        "; not default: tools.bar_reach = 7: ",
    ),
}
MAGIC = {".png": b"\x89PNG\r\n", ".svg": b"<?xml ", ".pdf": b"%PDF-"}


def drawn(ended: Ended, path: Path) -> str:
    """Check what a command that drew a figure says and leaves; return what it says it drew."""
    assert ended.out == ""
    assert ended.err.endswith(f": {path}\n")
    assert ended.err.count("\n") == 1
    assert path.read_bytes().startswith(MAGIC[path.suffix.lower()])
    return ended.err


@pytest.mark.parametrize("what", OF_DATABASE)
def test_figures_of_a_database(what: str, used: Path) -> None:
    """Reading changes nothing."""
    (command, says), before = OF_DATABASE[what], used.read_bytes()
    ended = done("figure", *command, "--out", used.parent / "one.png", "--db", used)
    assert drawn(ended, used.parent / "one.png").startswith(says)
    assert used.read_bytes() == before
    assert names_in(used.parent) == ["one.png", used.name]


@pytest.mark.parametrize("what", OF_NOTHING)
def test_figures_of_the_laboratory_need_no_database(what: str, tmp_path: Path) -> None:
    command, says = OF_NOTHING[what]
    ended = done("figure", *command, "--out", tmp_path / "f.svg", cwd=tmp_path)
    assert says in drawn(ended, tmp_path / "f.svg")
    assert names_in(tmp_path) == ["f.svg"]


@pytest.mark.parametrize("ending", [*FIGURE_ENDINGS, ".PDF"])
def test_the_ending_says_the_format(ending: str, used: Path) -> None:
    assert set(FIGURE_ENDINGS) == set(FORMATS)
    path = used.parent / f"figure{ending}"
    drawn(done("figure", "row", "2", "--out", path, "--db", used), path)


def test_robots_of_a_reproduction(reproduced: Path) -> None:
    path = reproduced.parent / "robots.pdf"
    learning = ("figure", "learning", "--db", reproduced, "--out", path)
    ended = done(*learning, "--session", "1")
    assert drawn(ended, path).startswith(
        "Learning over robot time; session 1 (reproduce), 2 robots, seed "
    )
    line = refused(2, *learning, "--force")
    assert "no learning runs but of robots: --session 1 draws these" in line
    run = done("figure", "affordances", "--run", "3", "--out", path, "--force", "--db", reproduced)
    assert "; run 3: L-hook, seed 0, robot 0 of session 1; not default: motion" in drawn(run, path)


def unfinish(database: Path, run: int) -> None:
    """Make a learning run one that has not come to its end."""
    with closing(sqlite3.connect(database)) as driver, driver:
        driver.execute(
            f"UPDATE learning_run SET status = 'running', finished_at = NULL WHERE id = {run}"
        )


def test_an_unfinished_run_is_drawn_as_far_as_it_came(learned: Path) -> None:
    unfinish(learned, 1)
    path = learned.parent / "f.svg"
    out = ("--out", path, "--force", "--db", learned)
    line = refused(2, "figure", "affordances", *out)
    assert "no finished run with the t-hook; --run 1 draws what run 1 has so far" in line
    said = drawn(done("figure", "affordances", "--run", "1", *out), path)
    assert "; run 1: T-hook, seed " in said
    assert " so far (unfinished); " in said
    said = drawn(done("figure", "affordances", "--run", "2", "--compare", "1", *out), path)
    assert said.startswith("What runs 2 and 1 have in common; ")
    said = drawn(done("figure", "learning", "--run", "1", *out), path)
    assert " so far (unfinished); not default: trial.max_steps = 6: " in said


NUMBERS = "they are numbered 1 to"
WRONG: dict[str, tuple[int, tuple[str, ...], str]] = {
    "no run": (2, ("affordances", "--run", "9"), f"no learning run 9; {NUMBERS} 2"),
    "no run to compare": (2, ("affordances", "--compare", "9"), f"no learning run 9; {NUMBERS} 2"),
    "the run itself": (2, ("affordances", "--run", "2", "--compare", "2"), "name another"),
    "no trial": (2, ("affordances", "--after-trial", "99"), f"no trial 99; {NUMBERS} 40"),
    "no row": (2, ("row", "99999"), f"no affordance 99999; {NUMBERS} "),
    "no curve": (2, ("learning", "--run", "3"), f"no learning run 3; {NUMBERS} 2"),
    "no session": (2, ("learning", "--session", "1"), "no such reproduction; there is none yet"),
    "no such tool": (2, ("affordances", "--tool", "hook"), "no tool 'hook'; did you mean "),
    "tool not learned": (2, ("affordances", "--tool", "l-hook"), "affcli learn --tool l-hook"),
    "curve not learned": (2, ("learning", "--tool", "l-hook"), "affcli learn --tool l-hook"),
    "run and tool": (2, ("affordances", "--run", "1", "--tool", "stick"), "not both"),
    "trial and run": (2, ("affordances", "--after-trial", "1", "--run", "1"), "leave out --run"),
    "trial and other": (2, ("affordances", "--after-trial", "1", "--compare", "1"), "leave out"),
    "curves and robots": (2, ("learning", "--run", "1", "--session", "1"), "give --run alone"),
    "id 0": (4, ("affordances", "--run", "0"), "--run 0: must lie in 1 to 9223372036854775807"),
    "id 2^63": (4, ("row", "9223372036854775808"), "row 9223372036854775808: must lie in 1 to "),
    "negative id": (4, ("learning", "--session", "-1"), "--session -1: must lie in 1 to "),
    "id in words": (2, ("row", "one"), "row one: must be a whole number"),
    "no id": (2, ("row",), "Missing argument"),
    "no such shape": (2, ("tools", "--becomes", "spoon"), "no tool 'spoon'"),
    "the same shape": (2, ("tools", "--becomes", "t-hook"), "does not become that by losing parts"),
    "more than it was": (2, ("tools", "--tool", "stick"), "does not become that by losing parts"),
    "no such tool to lie": (2, ("workspace", "--tool", "T-hook"), "did you mean t-hook"),
    "no settings": (4, ("workspace", "--config", "none.toml"), "config none.toml: "),
    "bad settings": (4, ("tools", "--config", "bad.toml"), "tools.part_width"),
    "an arm that reaches nothing": (4, ("workspace", "--config", "short.toml"), "lower arm."),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_cannot_be_drawn_is_one_line_and_no_file(what: str, used: Path) -> None:
    code, command, says = WRONG[what]
    (used.parent / "bad.toml").write_text("[tools]\npart_width = 1e9\n")
    (used.parent / "short.toml").write_text("[arm]\nshoulder_height = 100.0\n")
    before = names_in(used.parent)
    database = () if command[0] in {"workspace", "tools"} else ("--db", used)
    line = refused(code, "figure", *command, "--out", "f.png", *database, cwd=used.parent)
    assert says in line
    assert names_in(used.parent) == before


OUT: dict[str, tuple[int, tuple[Arg, ...], str]] = {
    "no file": (2, (), "Missing option '--out'"),
    "another ending": (4, ("--out", "f.gif"), "f.gif: name it *.png or *.svg or *.pdf"),
    "no ending": (4, ("--out", "figure"), "figure: name it "),
    "there already": (4, ("--out", "there.png"), "there.png: exists already; "),
    "a folder": (4, ("--out", "."), ".: not a file"),
    "in no folder": (4, ("--out", "no/f.png"), "no/f.png: its folder does not exist"),
}


@pytest.mark.parametrize("what", OUT)
def test_where_it_cannot_be_drawn_is_one_line(what: str, tmp_path: Path) -> None:
    """And is said first: there is no database."""
    code, out, says = OUT[what]
    (tmp_path / "there.png").write_bytes(b"mine")
    for command in (("affordances",), ("row", "1"), ("tools",), ("learning",)):
        assert says in refused(code, "figure", *command, *out, cwd=tmp_path)
    assert names_in(tmp_path) == ["there.png"]
    assert (tmp_path / "there.png").read_bytes() == b"mine"


def test_files_are_written_over_by_force(tmp_path: Path) -> None:
    path = tmp_path / "f.png"
    path.write_bytes(b"mine")
    drawn(done("figure", "tools", "--out", path, "--force"), path)


def test_a_strange_name_is_only_a_name(tmp_path: Path) -> None:
    names = ["[x] %03d; <script>.svg", "$č机$.pdf", "-.png"]
    for name in names:
        done("figure", "workspace", "--out", name, cwd=tmp_path)
    assert names_in(tmp_path) == sorted(names)
    said = done("figure", "workspace", "--out", b"\xff\x1b[31m.png", cwd=tmp_path).err
    assert said[:-1].isprintable()


DATABASE = (("affordances",), ("affordances", "--after-trial", "1"), ("row", "1"), ("learning",))


@pytest.mark.parametrize("command", DATABASE)
def test_with_nothing_to_draw_it_says_what_to_do(command: tuple[str, ...], empty: Path) -> None:
    line = refused(2, "figure", *command, "--out", "f.png", "--db", empty, cwd=empty.parent)
    assert "affcli learn --tool t-hook" in line or "there are none yet" in line
    missing = refused(3, "figure", *command, "--out", "f.png", "--db", "no.db", cwd=empty.parent)
    assert "no.db: no database there" in missing
    assert names_in(empty.parent) == [empty.name]


def test_more_runs_than_can_be_told_apart_are_drawn_as_means(learned: Path) -> None:
    for seed in range(1, 12):
        learn = ("learn", "--tool", "stick", "--behaviors", "5", "--seed", str(seed))
        done(*learn, "--db", learned)
    out = ("--out", learned.parent / "f.svg", "--force", "--db", learned)
    said = done("figure", "learning", *out).err
    assert "; 13 learning runs; 1, 2: not default: trial.max_steps = 6; 3, 4, 5, " in said
    means = (learned.parent / "f.svg").read_bytes()
    chosen = [("--run", str(number)) for number in range(2, 14)]
    done("figure", "learning", *(word for pair in chosen for word in pair), *out)
    assert (learned.parent / "f.svg").read_bytes() != means


def test_a_run_is_drawn_with_the_sizes_it_was_learned_with(learned: Path) -> None:
    """A run with a larger tool has larger axes: another figure, drawn without --config."""
    config = learned.parent / "long.toml"
    config.write_text("[tools]\nbar_reach = 7.0\n")
    learn = ("learn", "--tool", "t-hook", "--behaviors", "1", "--seed", "4", "--config", config)
    done(*learn, "--db", learned)
    path, other = (learned.parent / name for name in ("a.svg", "b.svg"))
    draw = ("figure", "affordances", "--run", "3", "--db", learned)
    done(*draw, "--out", path)
    with closing(sqlite3.connect(learned)) as driver, driver:
        usual = "(SELECT tool_key FROM learning_run WHERE id = 1)"
        driver.execute(f"UPDATE learning_run SET tool_key = {usual} WHERE id = 3")
    done(*draw, "--out", other)
    assert path.read_bytes() != other.read_bytes()


@pytest.mark.parametrize("command", [("affordances",), ("workspace",)])
def test_without_matplotlib_it_says_what_to_install(command: tuple[str, ...], used: Path) -> None:
    before = names_in(used.parent)
    out = ("--out", used.parent / "f.png")
    database = () if command[0] in {"workspace", "tools"} else ("--db", used)
    ended = without("matplotlib", "figure", *command, *out, *database)
    line = (
        "affcli: figures need Matplotlib and Pillow; install them: pip install 'affcli[figures]'\n"
    )
    assert ended == Ended(2, "", line)
    assert names_in(used.parent) == before


def test_without_matplotlib_nothing_else_is_missed(learned: Path) -> None:
    for command in (("report",), ("solve", "--goal", "3", "--start", "1", "--tool", "stick")):
        assert without("matplotlib", *command, "--db", learned).code == 0
    assert rows(learned, "SELECT count(*) FROM trial") == [(1,)]


def test_a_run_that_was_killed_before_its_first_behavior_does_not_keep_others_from_being_drawn(
    learned: Path, tmp_path: Path
) -> None:
    with open_store(learned, create=False, write=True) as store:
        store.learning.begin(learning_spec("l-hook", seed=9), {}, NOW)
    out = ("--db", learned, "--out", tmp_path / "a.svg")
    assert "Learning over robot time; 2 learning runs; " in done("figure", "learning", *out).err
    assert "run 3 has not begun" in refused(2, "figure", "learning", "--run", "3", *out, "--force")
