"""``affcli compare`` and ``power``, and their figures: what they write, and what they refuse."""

import csv
import io
from pathlib import Path

import pytest

from affcli.report.paired import COLUMNS
from affcli.store import open_store
from tests.cli.program import done, names_in, refused
from tests.store.conditions import stored_conditions

TWO = ("--session", "1", "--session", "2")


@pytest.fixture(scope="module")
def _conditions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("compare") / "conditions.db"
    with open_store(path, create=True, write=True) as store:
        stored_conditions(store)
    return path


@pytest.fixture
def database(_conditions: Path, tmp_path: Path) -> Path:
    """Three conditions of hand-made robots, for this test alone."""
    path = tmp_path / "my.db"
    path.write_bytes(_conditions.read_bytes())
    return path


def test_the_tables_say_what_changed_what_did_not_and_who_is_missing(database: Path) -> None:
    before = database.read_bytes()
    ended = done("compare", *TWO, "--db", database, COLUMNS="80")
    assert ended.err == ""
    out = " ".join(ended.out.split())
    assert "session 2 against session 1: 8 pairs of robots" in out
    assert "stick 1 1.50 2.00 +0.50 +0.05 to +0.95 +0.94 4/0 0.125" in out
    assert "The same in all robots, so not tested" in out
    assert "t-hook as l-hook 1 1.00 of 1" in out
    assert "session 2 9 sensor.position_noise = 0.06 8" in out
    assert all(len(line) <= 80 for line in ended.out.splitlines())
    assert database.read_bytes() == before


def test_on_a_narrow_terminal_rows_are_records(database: Path) -> None:
    out = done("compare", *TWO, "--db", database, COLUMNS="40").out
    assert all(len(line) <= 40 for line in out.splitlines())
    assert "95 % interval  +0.05 to +0.95" in out


@pytest.mark.parametrize(
    "by", ["tool,goal", "tool", "start", "protocol", "task,protocol,goal,goal"]
)
def test_trials_are_told_apart_by_what_is_asked_for(by: str, database: Path) -> None:
    value = done("compare", *TWO, "--by", by, "--json", "--db", database).result
    assert [row["difference"] for row in value["totals"]] == [0.5, 0.0]
    told = value["cells"] + value["same"]
    asked = set(by.split(",")) & {"tool", "goal", "start"}
    assert bool(told) == bool(asked)
    for row in told:
        assert {name for name in ("tool", "goal", "start") if row[name]} == asked
    assert value["left_out"] == {"session 2": [8]}


def test_csv_has_a_row_for_each_difference(database: Path, tmp_path: Path) -> None:
    out = tmp_path / "all.csv"
    said = done("compare", *TWO, "--session", "3", "--out", out, "--db", database).err
    assert said == f"5 differences, 5 cells without: {out}\n"
    text = out.read_text()
    rows = list(csv.DictReader(io.StringIO(text)))
    assert tuple(rows[0]) == COLUMNS
    assert len(rows) == 10
    assert {row["p"] for row in rows[5:]} == {""}
    shown = done("compare", *TWO, "--session", "3", "--format", "csv", "--db", database).out
    assert shown.replace("\r\n", "\n") == text.replace("\r\n", "\n")


@pytest.mark.parametrize(
    ("name", "holds"),
    [("a.md", "| stick | 1 | 1.50 | 2.00 | +0.50 |"), ("a.tex", "stick & 1 & 1.50 & 2.00 & +0.50")],
)
def test_tables_for_a_paper(name: str, holds: str, database: Path, tmp_path: Path) -> None:
    done("compare", *TWO, "--out", tmp_path / name, "--db", database)
    text = (tmp_path / name).read_text()
    assert holds in text
    if name.endswith(".tex"):
        assert text.count("\\begin{tabular}") == text.count("\\end{tabular}") == 4
        assert "95 \\% interval" in text
        assert "sensor.position\\_noise" in text


def test_power_says_how_many_robots(database: Path) -> None:
    ended = done("power", *TWO, "--difference", "0.5", "--difference", "1", "--db", database)
    out = " ".join(ended.out.split())
    assert "extension of reach 0.53 14 7" in out
    assert "two-sided: all trials at 2.5 % (of as many as there are, Holm's first)" in out
    assert "not told, too few robots differ: tool adaptation" in out
    one = done("power", "--session", "1", "--correlation", "0.5", "--json", "--db", database).result
    assert one["plans"][0]["needed"][0] == {"difference": 1.0, "robots": 7}
    assert one["known_from"] == "from session 1, correlation 0.5"
    (untold,) = one["not_told"]
    assert (untold["protocol"], untold["why"]) == ("tool adaptation", "too few robots differ")


def test_without_a_plan_the_table_has_its_columns(tmp_path: Path) -> None:
    with open_store(tmp_path / "four.db", create=True, write=True) as store:
        stored_conditions(store, 3, conditions=2)
    out = done("power", *TWO, "--difference", "2", "--db", tmp_path / "four.db").out
    assert "trials  deviation  of 2  seen by as many" in out
    assert "not told, fewer than 5 robots: extension of reach; tool adaptation" in out


def test_in_json_significant_is_true_or_false_and_null_without_a_test(database: Path) -> None:
    value = done("compare", *TWO, "--json", "--db", database).result
    rows = [*value["totals"], *value["cells"], *value["same"]]
    assert [row["significant"] for row in rows] == [False, None, False, None, None]
    assert [row["p"] is None for row in rows] == [False, True, False, True, True]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("compare", *TWO), "session 2 against session 1: 8 pairs of robots"),
        (("compare", *TWO, "--session", "3", "--by", "tool"), "session 2 and session 3 against"),
        (("curve", *TWO, "--session", "3"), "solved trials against sensor.position_noise (in); "),
        (("curve", *TWO, "--y", "share", "--x", "minutes"), "share of behaviors with an effect ag"),
        (("curve", "--session", "1", "--y", "rows"), "rows of a table against robot time"),
    ],
)
def test_figures(words: tuple[str, ...], says: str, database: Path, tmp_path: Path) -> None:
    for ending in ("png", "pdf"):
        out = tmp_path / f"figure.{ending}"
        assert done("figure", *words, "--out", out, "--db", database).err.lower().startswith(says)
        assert out.stat().st_size > 4_000


REFUSED: list[tuple[int, tuple[str, ...], str]] = [
    (
        2,
        ("compare",),
        "name an experiment (there: none yet), or sessions, as in --session 1 --session 2 (fini",
    ),
    (2, ("compare", "--session", "1"), "or sessions, as in --session 1 --session 2"),
    (2, ("compare", "--session", "1", "--session", "1"), "--session 1: named twice"),
    (2, ("compare", *TWO, "--session", "9"), "no session 9; they are numbered 1 to 3"),
    (4, ("compare", *TWO, "--session", "0"), "--session 0: must lie in 1 to"),
    (2, ("compare", *TWO, "--by", "tol"), "no way to tell trials apart 'tol'; did you mean tool"),
    (2, ("compare", *TWO, "--against", "session 7"), "no condition 'session 7'; did you mean"),
    (2, ("compare", *TWO, "--format", "word"), "no format 'word'"),
    (4, ("compare", *TWO, "--out", "a.docx"), "a.docx: name it *.md or *.tex or *.csv, or give"),
    (2, ("compare", *TWO, "--json", "--format", "csv"), "--json writes to stdout: leave out"),
    (2, ("power",), "or sessions, as in --session 1 (finished"),
    (2, ("power", *TWO, "--session", "3"), "there are 3 conditions; name two of the sessions: --s"),
    (2, ("power", *TWO, "--correlation", "0"), "--correlation is of one session; the pairs of two"),
    (4, ("power", *TWO, "--difference", "0"), "--difference 0.0: must lie in 0.001 to 1000"),
    (4, ("power", *TWO, "--difference", "nan"), "--difference nan: must lie in"),
    (4, ("power", *TWO, "--power", "1"), "--power 1.0: must lie in 0.1 to 0.999"),
    (
        4,
        ("power", "--session", "1", "--correlation", "1"),
        "--correlation 1.0: must lie in",
    ),
    (2, ("figure", "compare", "--out", "a.png"), "or sessions, as in --session 1 --session 2"),
    (2, ("figure", "curve", "--out", "a.png", *TWO, "--y", "x"), "no measure 'x'"),
]


@pytest.mark.parametrize(("code", "words", "says"), REFUSED)
def test_what_is_asked_wrongly_is_refused_in_a_line(
    code: int, words: tuple[str, ...], says: str, database: Path
) -> None:
    assert says in refused(code, *words, "--db", database, cwd=database.parent)
    assert names_in(database.parent) == [database.name]


def test_nothing_is_written_over(database: Path, tmp_path: Path) -> None:
    out = tmp_path / "there.md"
    out.write_text("mine")
    assert "exists already" in refused(4, "compare", *TWO, "--out", out, "--db", database)
    assert out.read_text() == "mine"
    done("compare", *TWO, "--out", out, "--force", "--db", database)
