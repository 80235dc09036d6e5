"""``affcli figure prediction``: a picture of `affcli predict`, in each of the three formats."""

from pathlib import Path

import pytest

from tests.cli.program import done, names_in, refused

BEGINNINGS = {".png": b"\x89PNG\r\n", ".svg": b"<?xml", ".pdf": b"%PDF-"}


def draw(out: Path, database: Path, *more: str) -> tuple[str | Path, ...]:
    return ("figure", "prediction", "--out", out, "--db", database, "--pushes", "60", *more)


@pytest.mark.parametrize("ending", BEGINNINGS)
def test_the_same_figure_is_the_same_file(ending: str, learned: Path, tmp_path: Path) -> None:
    before = learned.read_bytes()
    first, second = tmp_path / f"a{ending}", tmp_path / f"b{ending}"
    ended = done(*draw(first, learned))
    assert ended.out == ""
    assert ended.err.startswith("Predictions of fresh pushes as the table grows; pushes: 60, of ")
    assert "their seed: 0; run 1: T-hook, seed " in ended.err
    done(*draw(second, learned))
    assert first.read_bytes() == second.read_bytes()
    assert first.read_bytes().startswith(BEGINNINGS[ending])
    assert learned.read_bytes() == before


def test_another_seed_or_tool_is_another_figure(learned: Path, tmp_path: Path) -> None:
    outs = [tmp_path / f"{n}.svg" for n in range(3)]
    for out, more in zip(outs, ((), ("--seed", "5"), ("--tool", "stick")), strict=True):
        done(*draw(out, learned, *more))
    assert len({out.read_bytes() for out in outs}) == 3


def test_a_table_of_a_single_row_and_pushes_that_move_nothing_can_be_drawn(
    empty: Path, tmp_path: Path
) -> None:
    done("learn", "--tool", "stick", "--behaviors", "12", "--seed", "2", "--db", empty)
    done("figure", "prediction", "--tool", "stick", "--pushes", "1", "--db", empty, "--out",
         tmp_path / "small.png")  # fmt: skip
    assert (tmp_path / "small.png").exists()


def test_a_file_that_is_there_is_kept_unless_forced(learned: Path, tmp_path: Path) -> None:
    out = tmp_path / "kept.png"
    out.write_text("mine")
    assert "exists already" in refused(4, *draw(out, learned))
    assert out.read_text() == "mine"
    done(*draw(out, learned, "--force"))
    assert out.read_bytes().startswith(BEGINNINGS[".png"])


@pytest.mark.parametrize(
    ("name", "says"),
    [("figure.jpg", "name it *.png or *.svg or *.pdf"), ("no/where.png", "folder does not exist")],
)
def test_a_file_that_cannot_be_is_refused_before_any_work(
    name: str, says: str, learned: Path, tmp_path: Path
) -> None:
    before = names_in(tmp_path)
    assert says in refused(4, *draw(tmp_path / name, learned))
    assert names_in(tmp_path) == before


def test_without_a_finished_run_there_is_nothing_to_draw(empty: Path, tmp_path: Path) -> None:
    out = tmp_path / "none.png"
    assert "nothing learned with the t-hook" in refused(2, *draw(out, empty))
    assert "no database there" in refused(3, *draw(out, tmp_path / "no.db"))
    assert "--pushes 0" in refused(4, *draw(out, empty, "--pushes", "0"))
    assert not out.exists()
