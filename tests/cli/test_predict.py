"""``affcli predict``: what the table foretells of fresh pushes."""

from pathlib import Path

import pytest

from tests.cli.program import done, refused, rows


def predict(database: Path, *more: str) -> tuple[str | Path, ...]:
    return ("predict", *more, "--db", database)


def test_the_scores_of_a_growing_table_are_told_and_nothing_is_written(learned: Path) -> None:
    before = learned.read_bytes()
    ended = done(*predict(learned, "--pushes", "300"))
    assert ended.err == ""
    assert ended.out.startswith("Run 1, t-hook: 300 fresh pushes predicted, ")
    value = done(*predict(learned, "--pushes", "300", "--json")).result
    ((in_table,),) = rows(learned, "SELECT rows FROM learning_run WHERE tool = 't-hook'")
    assert [score["rows"] for score in value["scores"]] == [5, 10, 20, 40, 80, in_table]
    for score in value["scores"]:
        assert score["moved"] + score["still"] == 300
        assert 0 <= score["hits"] <= score["moved"]
        assert 0 <= score["false_alarms"] <= score["still"]
    first, last = value["scores"][0], value["scores"][-1]
    assert first["hits"] < last["hits"]
    assert last["by_row"]["degrees"] < 10
    assert (value["run"], value["tool"], value["shape"], value["radius"]) == (
        *(1, "t-hook", "t-hook"),
        1.5,
    )
    assert learned.read_bytes() == before


def test_the_same_seed_says_the_same_and_another_something_else(learned: Path) -> None:
    args = predict(learned, "--pushes", "60", "--json")
    assert done(*args).result == done(*args).result
    assert done(*args).result["scores"] != done(*args, "--seed", "8").result["scores"]


def test_excluded_rows_foretell_nothing(learned: Path) -> None:
    done("verify", "--shape", "l-hook", "--update", "--rows", "40", "--db", learned)
    live = (
        "SELECT count(*) FROM affordance WHERE tool = 't-hook'"
        " AND 2 * times_successful > times_used"
    )
    ((count,),) = rows(learned, live)
    value = done(*predict(learned, "--pushes", "20", "--json")).result
    assert value["scores"][-1]["rows"] == count


@pytest.mark.parametrize("columns", ["80", "40"])
def test_it_fits_the_screen(columns: str, learned: Path) -> None:
    out = done(*predict(learned, "--pushes", "40"), COLUMNS=columns).out
    assert max(map(len, out.splitlines())) <= int(columns)


def test_without_rows_there_is_nothing_to_predict_by(empty: Path, tmp_path: Path) -> None:
    assert "nothing learned with the t-hook" in refused(2, *predict(empty))
    done("learn", "--tool", "stick", "--behaviors", "1", "--seed", "1", "--db", empty)
    assert "made no rows" in refused(2, *predict(empty, "--tool", "stick"))
    assert "no database there" in refused(3, *predict(tmp_path / "no.db"))


@pytest.mark.parametrize(
    ("args", "code", "says"),
    [
        (("--pushes", "0"), 4, "--pushes 0: must lie in 1 to 100000"),
        (("--pushes", "9" * 25), 4, "must lie in 1 to 100000"),
        (("--seed", "-1"), 4, "--seed -1: must lie in 0 to 2^63 - 1"),
        (("--sensor", "x"), 2, "no sensor 'x'"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_opened(
    args: tuple[str, ...], code: int, says: str, tmp_path: Path
) -> None:
    assert says in refused(code, "predict", *args, cwd=tmp_path)
    assert list(tmp_path.iterdir()) == []
