"""``affcli runs``: listed, shown, noted and deleted; what is left is replayed equal."""

import shutil
from pathlib import Path

import pytest

from affcli.core.limits import LONGEST_NOTE
from tests.cli.program import contents, done, names_in, refused, rows, started, wait_until
from tests.cli.pseudo_terminal import on_terminal
from tests.lab.quick import altered

LEARN = ("learn", "--behaviors", "20", "--tool")
BELONGING = {
    "behavior": "learning_run_id",
    "affordance": "learning_run_id",
    "trial": "learning_run_id",
    "verification": "learning_run_id",
}
"""Tables, and the column that says which run a record belongs to."""


@pytest.fixture(scope="module")
def _shared(_used: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = Path(shutil.copy(_used, tmp_path_factory.mktemp("runs") / "shared.db"))
    done("verify", "--tool", "stick", "--rows", "4", "--update", "--db", path)
    done("verify", "--rows", "4", "--update", "--db", path)
    done("solve", "--goal", "4", "--db", path)
    return path


@pytest.fixture
def shared(_shared: Path, tmp_path: Path) -> Path:
    """Trials and verifications of two runs that take turns, for this test alone."""
    return Path(shutil.copy(_shared, tmp_path / "shared.db"))


def of_run(database: Path, run: int) -> dict[str, list[tuple[object, ...]]]:
    """Return all that belongs to a run."""
    found = {
        table: rows(database, f"SELECT * FROM {table} WHERE {column} = {run} ORDER BY 1, 2")
        for table, column in BELONGING.items()
    }
    for table, owner in (("step", "trial"), ("replication", "verification")):
        chosen = f"SELECT id FROM {owner} WHERE learning_run_id = {run}"
        query = f"SELECT * FROM {table} WHERE {owner}_id IN ({chosen}) ORDER BY 1, 2"
        found[table] = rows(database, query)
    found["learning_run"] = rows(database, f"SELECT * FROM learning_run WHERE id = {run}")
    return found


def sound(database: Path) -> bool:
    """Tell whether nothing is wrong with a database."""
    return all(one["wrong"] == 0 for one in done("db", "check", "--json", "--db", database).results)


def test_the_list_says_of_each_run_what_it_is_and_what_used_it(shared: Path) -> None:
    done("runs", "note", "2", "the short one", "--db", shared)
    shown = done("runs", "list", "--db", shared).out
    first, second = (line for line in shown.splitlines() if line.split()[0] in {"1", "2"})
    run, tool, seed, _, tried, _, trials, *_ = first.split()
    assert (run, tool, seed, tried, trials) == ("1", "t-hook", "0", "800", "40")
    assert second.split()[1] == "stick"
    assert '"the short one"' in shown
    assert "trial.max_steps = 6" in " ".join(shown.split())
    assert max(map(len, shown.splitlines())) <= 80
    one, two = done("runs", "list", "--json", "--db", shared).results
    assert (one["run"], one["trials"], one["verifications"], one["note"]) == (1, 40, 1, None)
    assert (two["run"], two["trials"], two["verifications"]) == (2, 8, 1)
    (only,) = done("runs", "list", "--tool", "stick", "--json", "--db", shared).results
    assert only["run"] == 2


def test_one_run_is_shown_in_full(shared: Path) -> None:
    shown = " ".join(done("runs", "show", "1", "--db", shared).out.split())
    for words in ("asked for 800 behaviors, seed 0", "40 trials", "1 verification (4 tries)"):
        assert words in shown
    assert "what the t-hook affords, by behavior" in shown
    narrow = done("runs", "show", "1", "--db", shared, COLUMNS="40").out
    assert max(map(len, narrow.splitlines())) <= 40


def test_robots_of_a_reproduction_are_listed_when_asked_for_and_kept_whole(
    reproduced: Path,
) -> None:
    ended = done("runs", "list", "--db", reproduced)
    assert (ended.out, ended.err.splitlines()[0]) == ("", "no runs")
    assert "and 10 of robots of reproductions: --all-runs" in ended.err
    shown = done("runs", "list", "--all-runs", "--json", "--db", reproduced).results
    assert [run["run"] for run in shown] == list(range(1, 11))
    before = reproduced.read_bytes()
    line = refused(2, "runs", "delete", "7", "--yes", "--db", reproduced)
    assert "run 7 is part of reproduction 1, which is kept whole" in line
    assert reproduced.read_bytes() == before


def test_a_note_is_set_changed_shown_and_taken_away(learned: Path) -> None:
    note = "it's; DROP TABLE x -- <b>\x1b[31m"
    done("runs", "note", "1", note, "--db", learned)
    assert rows(learned, "SELECT note FROM learning_run WHERE id = 1") == [(note,)]
    for command in (("runs", "list"), ("runs", "show", "1")):
        shown = done(*command, "--db", learned).out
        assert "\x1b" not in shown
        assert "DROP TABLE x" in " ".join(shown.split())
    done("runs", "note", "1", "other", "--db", learned)
    assert rows(learned, "SELECT note FROM learning_run") == [("other",), (None,)]
    assert done("runs", "note", "1", "", "--db", learned).err == "run 1: no note any more\n"
    assert rows(learned, "SELECT note FROM learning_run") == [(None,), (None,)]


@pytest.mark.parametrize("note", ["x" * (LONGEST_NOTE + 1), b"\xff"], ids=["long", "no text"])
def test_a_note_that_is_none_is_refused(note: str | bytes, learned: Path, tmp_path: Path) -> None:
    assert "at most 500 letters" in refused(4, "runs", "note", "1", note, "--db", learned)
    new = tmp_path / "new" / "x.db"
    assert "at most 500" in refused(4, *LEARN, "stick", "--note", note, "--db", new)
    assert not new.exists()


def test_a_note_is_no_part_of_what_a_run_is(tmp_path: Path) -> None:
    database = tmp_path / "my.db"
    done(*LEARN, "stick", "--note", "first", "--db", database)
    ended = done(*LEARN, "stick", "--note", "second", "--db", database)
    assert ended.err.startswith("already learned")
    assert rows(database, "SELECT id, note FROM learning_run") == [(1, "second")]
    done(*LEARN, "stick", "--db", database)
    assert rows(database, "SELECT id, note FROM learning_run") == [(1, "second")]


@pytest.mark.parametrize("run", [1, 2])
def test_what_other_runs_did_stays_and_is_replayed_equal(run: int, shared: Path) -> None:
    """Verifications and trials of the two took turns."""
    other = 3 - run
    before = of_run(shared, other)
    ended = done("runs", "delete", str(run), "--yes", "--db", shared)
    assert ended.err.startswith(f"deleted run {run} of the ")
    assert of_run(shared, other) == before
    assert of_run(shared, run) == {table: [] for table in before}
    assert sound(shared)
    trials = len(before["trial"])
    assert done("replay", "--all", "--db", shared).err.startswith(f"{trials} of {trials} trials")
    assert f"no learning run {run}" in refused(2, "runs", "show", str(run), "--db", shared)


def test_what_comes_after_a_deletion_is_replayed_equal(shared: Path) -> None:
    """No id is given twice: a verification remembers the latest trial before it."""
    done("solve", "--goal", "1", "--tool", "stick", "--db", shared)
    done("verify", "--rows", "3", "--update", "--db", shared)
    ((after,),) = rows(shared, "SELECT max(after_trial) FROM verification")
    done("runs", "delete", "2", "--yes", "--db", shared)
    done("solve", "--goal", "3", "--tool", "t-hook", "--db", shared)
    done("learn", "--tool", "stick", "--behaviors", "20", "--db", shared)
    assert rows(shared, f"SELECT min(id) FROM trial WHERE id >= {after}") == [(after + 1,)]
    assert rows(shared, "SELECT id FROM learning_run ORDER BY id") == [(1,), (3,)]
    assert done("replay", "--all", "--db", shared).code == 0
    assert sound(shared)


def test_all_that_a_run_left_goes_with_it(shared: Path) -> None:
    """Sessions without trials and tools that no record names go too."""
    for run in ("1", "2"):
        done("runs", "delete", run, "--yes", "--db", shared)
    left = {table: len(held) for table, held in contents(shared).items() if held}
    assert left.keys() == {"alembic_version"}


def test_without_a_terminal_and_without_yes_nothing_is_deleted(shared: Path) -> None:
    before = shared.read_bytes()
    line = refused(2, "runs", "delete", "2", "--db", shared)
    assert "8 trials" in line
    assert line.endswith("to delete it, give --yes")
    assert shared.read_bytes() == before


@pytest.mark.parametrize(("typed", "left"), [("y\n", [1]), ("\n", [1, 2]), ("\x04", [1, 2])])
def test_on_a_terminal_it_asks(typed: str, left: list[int], shared: Path) -> None:
    asking = (("y: yes > ", typed),)
    code, shown = on_terminal("runs", "delete", "2", "--db", shared, answers=asking)
    assert code == 0
    assert "Delete it, with 800 behaviors" in shown
    assert [run for (run,) in rows(shared, "SELECT id FROM learning_run ORDER BY id")] == left


def test_a_run_that_is_deleted_while_it_learns_ends_in_one_line(tmp_path: Path) -> None:
    database = tmp_path / "my.db"
    long = ("learn", "--tool", "stick", "--behaviors", "200000", "--db", database)

    def begun() -> bool:
        known = "SELECT count(*) FROM sqlite_master WHERE name = 'learning_run'"
        if not database.exists() or rows(database, known) == [(0,)]:
            return False
        return rows(database, "SELECT 1 FROM learning_run WHERE behaviors > 0") != []

    with started(*long) as process:
        wait_until(begun, process)
        done("runs", "delete", "1", "--yes", "--db", database)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (2, "")
    assert "no learning run 1" in err
    assert "Traceback" not in err
    assert sound(database)
    assert names_in(tmp_path) == ["my.db"]


def test_a_run_that_there_is_not_is_a_usage_error(shared: Path) -> None:
    line = refused(2, "runs", "delete", "9", "--yes", "--db", shared)
    assert line == "affcli: no learning run 9; they are numbered 1 to 2"


def test_what_was_deleted_is_told_from_what_never_was(shared: Path) -> None:
    """Also of what was the last, and where nothing is left."""
    for run in ("2", "1"):
        done("runs", "delete", run, "--yes", "--db", shared)
        line = refused(2, "runs", "show", run, "--db", shared)
        assert line == f"affcli: no learning run {run}; it was deleted"
    line = refused(2, "runs", "show", "3", "--db", shared)
    assert line == "affcli: no learning run 3; they are numbered 1 to 2"
    assert "no affordance 1; it was deleted" in refused(2, "table", "show", "1", "--db", shared)
    assert "no trial 1; it was deleted" in refused(2, "replay", "1", "--db", shared)


@pytest.mark.parametrize("kept", ["rows", "trials"])
def test_a_run_of_which_not_all_was_kept_is_shown(shared: Path, kept: str) -> None:
    whole = done("runs", "show", "1", "--json", "--db", shared).result
    altered(
        shared,
        "DELETE FROM behavior WHERE learning_run_id = 1",
        f"UPDATE learning_run SET kept = '{kept}' WHERE id = 1",
    )
    shown = done("runs", "show", "1", "--json", "--db", shared)
    assert shown.result == {**whole, "groups": None}
    assert shown.err.strip() == f"its behaviors were not kept (--keep {kept})"
    told = done("runs", "show", "1", "--db", shared)
    assert "asked for" in told.out
    assert "what the t-hook affords" not in told.out
    assert "what the stick affords" in done("runs", "show", "2", "--db", shared).out
