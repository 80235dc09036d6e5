"""``affcli invent``: what it says and saves, how that is used and looked at, what is refused."""

import shutil
from pathlib import Path

import pytest

from tests.cli.program import done, refused, rows

INVENT = ("invent", "--tool", "stick", "--minutes", "16", "--seed", "4")
LEARN = ("learn", "--tool", "stick", "--behaviors", "60", "--repertoire", "paper")
USE = (*LEARN, "--repertoire", "invented:run=1")


@pytest.fixture(scope="session")
def _invented(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("cli") / "invented.db"
    done(*INVENT, "--db", path)
    done(*USE, "--set", "trial.max_steps=4", "--db", path)
    return path


@pytest.fixture
def invented(_invented: Path, tmp_path: Path) -> Path:
    """A database in which a robot invented, and another used that, for this test alone."""
    return Path(shutil.copy(_invented, tmp_path / "invented.db"))


def test_it_says_what_it_kept_and_how_to_use_it(tmp_path: Path) -> None:
    ended = done(*INVENT, "--db", "my.db", cwd=tmp_path)
    title, headings, *_ = ended.out.splitlines()
    assert title == "Run 1: what was invented with the stick"
    assert headings.split() == ["behavior", "kept", "brings", "first", "for", "against"]
    learned, kept, using = ended.err.splitlines()
    assert learned.startswith("learned stick (run 1, seed 4): 16 min ")
    assert " kept: turn " in kept
    command = using.removeprefix("to use them: affcli ").split()
    assert command[-2:] == ["--db", "my.db"]
    done(*command, "--minutes", "1", cwd=tmp_path)
    again = done(*INVENT, "--db", "my.db", "--json", cwd=tmp_path)
    assert again.err.startswith("already learned, nothing to do: stick (run 1")
    assert again.result["new"] is False


def test_json_and_the_run_in_full_say_the_same_as_the_database(invented: Path) -> None:
    (value,) = done(*INVENT, "--json", "--db", invented).results
    (shown,) = done("runs", "show", "1", "--json", "--db", invented).results
    assert value["inventions"] == shown["inventions"]
    kept = [one for one in value["inventions"] if one["kept"]]
    assert kept
    for one in kept:
        assert sum(tried["alike"] for tried in one["tries"]) >= 2
    stored = rows(invented, "SELECT exploratory_behavior, kept FROM invention ORDER BY number")
    assert stored == [(one["behavior"], one["kept"]) for one in value["inventions"]]
    (other,) = done("runs", "show", "2", "--json", "--db", invented).results
    assert other["inventions"] == []
    words = [
        " ".join([one["behavior"], *map("{:g}".format, one["params"].values())]) for one in kept
    ]
    assert other["repertoire"][8:] == words


def test_what_was_invented_is_used_listed_drawn_verified_and_replayed(invented: Path) -> None:
    """Also in the run that invented it: there what was tried in passing is one group."""
    db = ("--db", invented)
    (name,) = rows(
        invented,
        "SELECT exploratory_behavior || ' ' || CAST(json_extract(exploratory_params, '$.angle') AS "
        "INTEGER) FROM invention WHERE kept AND exploratory_behavior = 'turn' LIMIT 1",
    )[0]
    for run in ("1", "2"):
        listed = done("table", "list", "--run", run, "--behavior", name, "--json", *db).results
        assert {row["behavior"] for row in listed} <= {"turn"}
        picture = invented.with_suffix(f".{run}.svg")
        done("figure", "affordances", "--run", run, "--out", picture, *db)
        title = name.replace("turn ", "Turn, ")
        assert f"{title} deg" in picture.read_text()
        done("verify", "--run", run, "--rows", "3", *db)
        assert done("replay", "--run", run, *db).err.startswith(f"run {run}: the replay equals")
    groups = done("runs", "show", "1", *db).out
    assert "composed in passing" in groups
    assert groups.count("turn ") < 20
    done("solve", "--goal", "1", "--run", "2", *db)
    assert all(one["equal"] for one in done("replay", "--all", "--json", *db).results)
    assert not any(one["wrong"] for one in done("db", "check", "--json", *db).results)


def test_a_run_that_invented_can_be_deleted_and_what_used_it_stays(invented: Path) -> None:
    done("runs", "delete", "1", "--yes", "--db", invented)
    assert rows(invented, "SELECT count(*) FROM invention_try") == [(0,)]
    assert done("replay", "--run", "2", "--db", invented).err.startswith("run 2: the replay equals")
    before = invented.read_bytes()
    said = refused(2, *USE, "--db", invented)
    assert "no learning run 1; it was deleted; invent anew: affcli invent --tool stick" in said
    assert invented.read_bytes() == before


@pytest.mark.parametrize(
    ("code", "args", "says"),
    [
        (4, ("invent", "--tool", "stick", "--minutes", "3"), "too few to invent anything; give 6"),
        (2, ("invent", "--tool", "stik"), "did you mean stick"),
        (2, (*LEARN, "--repertoire", "invented:run=9"), "invent anew"),
        (
            2,
            (*LEARN, "--repertoire", "invented:run=2"),
            "explored by random, it did not invent",
        ),
        (4, (*LEARN, "--repertoire", "invented"), "invented:run=ID"),
        (2, (*USE, "--repertoire", "invented:run=1"), "comes twice"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line_and_nothing_is_lost(
    code: int, args: tuple[str, ...], says: str, invented: Path
) -> None:
    before = invented.read_bytes()
    assert says in refused(code, *args, "--db", invented)
    assert invented.read_bytes() == before
