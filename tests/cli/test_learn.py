"""``affcli learn``: what it says and saves; again, at once, and by many (faults 6, 8)."""

from dataclasses import replace
from pathlib import Path

import pytest

from affcli.config import Settings
from affcli.errors import BadInputError, UsageError
from affcli.lab.learning import begun
from affcli.lab.run_parts import RunParts
from affcli.lab.transferring import transfer_from
from affcli.simulation.tools.paper import TOOL_PARTS
from affcli.store import open_store
from tests.cli.program import Ended, affcli, contents, done, executed, refused, rows, side_by_side

SHORT = ("learn", "--tool", "stick", "--behaviors", "60")


def json_of(*args: str | Path) -> list[dict[str, object]]:
    """Return what a successful ``learn`` gives as JSON."""
    value: list[dict[str, object]] = done(*args, "--json").results
    return value


def test_it_says_what_it_did_and_shows_the_groups(tmp_path: Path) -> None:
    ended = done(*SHORT, "--db", "my.db", cwd=tmp_path)
    (message,) = ended.err.splitlines()
    assert message.startswith("learned stick (run 1, seed 0): ")
    assert "60 behaviors" in message
    title, headings, _, *table, caption = ended.out.splitlines()
    assert title == "Run 1: what the stick affords, by behavior"
    assert headings.split() == ["behavior", "tried", "rows", "inches", "degrees"]
    assert caption.startswith("mean movement of the rows; degrees: ")
    tried = dict(line.rsplit(maxsplit=4)[:2] for line in table)
    known = {f"{name} {inches}" for name in BEHAVIORS for inches in (2, 5)}
    assert tried.keys() <= known
    assert sum(map(int, tried.values())) == 60


BEHAVIORS = ("extend arm", "contract arm", "slide arm left", "slide arm right")


def test_json_holds_the_same_and_nothing_else_is_on_stdout(tmp_path: Path) -> None:
    database = tmp_path / "my.db"
    (first,) = json_of(*SHORT, "--db", database)
    (again,) = json_of(*SHORT, "--db", database)
    assert (first.pop("new"), again.pop("new")) == (True, False)
    assert first == again
    groups = again.pop("groups")
    assert isinstance(groups, list)
    assert sum(group["tried"] for group in groups) == again["behaviors"] == 60
    assert sum(group["rows"] for group in groups) == again["rows"]
    ((behaviors, made, resets, seconds, begun),) = rows(
        database, "SELECT behaviors, rows, resets, robot_seconds, started_at FROM learning_run"
    )
    assert again == {
        "run": 1,
        "tool": "stick",
        "seed": 0,
        "status": "done",
        "behaviors": behaviors,
        "rows": made,
        "resets": resets,
        "robot_seconds": seconds,
        "world": "table@2",
        "sensor": "noisy",
        "explorer": "random",
        "binding": "grasp 1",
        "repertoire": [f"{name} {inches}" for name in BEHAVIORS for inches in (2, 5)],
        "settings": "defaults",
        "session": None,
        "begun": begun,
        "note": None,
    }


def test_the_same_run_again_says_so_and_changes_nothing(learned: Path, impatient: Path) -> None:
    before = learned.read_bytes()
    again = ("learn", "--tool", "stick,t-hook", "--behaviors", "800", "--config", impatient)
    ended = done(*again, "--db", learned)
    first, second = ended.err.splitlines()
    assert first.startswith("already learned, nothing to do: stick (run 2, seed 0): ")
    assert second.startswith("already learned, nothing to do: t-hook (run 1, seed 0): ")
    assert ended.out.count("affords, by behavior") == 2
    assert learned.read_bytes() == before


def test_another_seed_is_another_run(empty: Path) -> None:
    for seed in ("1", str(2**63 - 1)):
        done(*SHORT, "--seed", seed, "--db", empty)
    assert rows(empty, "SELECT seed FROM learning_run") == [(1,), (2**63 - 1,)]
    per_run = "SELECT count(DISTINCT true_start_x) FROM behavior WHERE step = 1"
    assert rows(empty, per_run) == [(2,)]


def test_the_same_seed_gives_the_same_rows(empty: Path, tmp_path: Path) -> None:
    done(*SHORT, "--db", empty)
    done(*SHORT, "--db", tmp_path / "other.db")
    assert contents(empty) == contents(tmp_path / "other.db")


def test_an_hour_is_an_hour_of_robot_time(leisurely: Path, empty: Path) -> None:
    """The behavior during which the hour ends is the last."""
    args = ("learn", "--all-tools", "--config", leisurely, "--db", empty)
    learned = json_of(*args)
    assert [run["tool"] for run in learned] == list(TOOL_PARTS)
    for run in learned:
        seconds = run["robot_seconds"]
        assert isinstance(seconds, float)
        assert seconds >= 3600
    clocks = "SELECT max(clock) FROM behavior GROUP BY learning_run_id ORDER BY learning_run_id"
    assert [(run["robot_seconds"],) for run in learned] == rows(empty, clocks)
    before_last = "SELECT count(*) FROM behavior WHERE clock < 3600"
    assert rows(empty, before_last) == [(sum(int(str(run["behaviors"])) - 1 for run in learned),)]
    one_hour = json_of(*args, "--hours", "1")
    assert [run["new"] for run in one_hour] == [False] * 5
    sixty_minutes = json_of(*args, "--minutes", "60")
    assert [run["new"] for run in sixty_minutes] == [False] * 5


def one_run(database: Path, behaviors: int) -> None:
    """Check that a database holds one finished run without holes or repeats."""
    assert rows(database, "SELECT status, behaviors FROM learning_run") == [("done", behaviors)]
    steps = "SELECT count(*), count(DISTINCT step), min(step), max(step) FROM behavior"
    assert rows(database, steps) == [(behaviors, behaviors, 1, behaviors)]
    assert rows(database, "PRAGMA integrity_check") == [("ok",)]


def all_well(ended: list[Ended]) -> None:
    """Check that processes side by side all ended well."""
    assert [one.code for one in ended] == [0] * len(ended)
    for one in ended:
        assert "what the stick affords" in one.out
        assert len(one.err.splitlines()) == 1


@pytest.mark.fault(6)
@pytest.mark.fault(8)
@pytest.mark.parametrize("first_runs", [2, 8])
def test_several_at_once_make_one_run(first_runs: int, tmp_path: Path) -> None:
    """Even the first on a new file: one migrates, the others wait, nobody fails."""
    behaviors = 1600 if first_runs == 2 else 60
    args = ("learn", "--tool", "stick", "--behaviors", str(behaviors), "--db", tmp_path / "new.db")
    all_well(side_by_side(first_runs, *args))
    one_run(tmp_path / "new.db", behaviors)
    alone = tmp_path / "alone.db"
    done(*args[:-1], alone)
    assert contents(tmp_path / "new.db") == contents(alone)


def test_it_runs_from_the_start_of_python_on(tmp_path: Path) -> None:
    """Not forked from a warm process, as most tests are: migration, learning, table."""
    all_well([executed(*SHORT, "--db", tmp_path / "new.db")])
    one_run(tmp_path / "new.db", 60)


def test_several_grasps_are_one_run_and_those_that_cannot_be_leave_nothing(tmp_path: Path) -> None:
    database = tmp_path / "grasps.db"
    two = ("--binding", "grasp", "--binding", "grasp:grasp_point=7", "--db", database)
    (both,) = json_of(*SHORT, *two)
    assert (both["binding"], both["new"]) == ("grasp 1 or grasp 7", True)
    again = done(*SHORT, *two)
    assert again.err.startswith("already learned, nothing to do: stick (run 1, seed 0): ")
    alone = done(*SHORT, "--db", database)
    assert "same command" not in alone.err  # another grasp is no other default
    before = contents(database)
    for wrong, code, says in (
        ("grasp:grasp_point=16", 4, "grasp_point = 16 lies beyond the end of the handle, at 15.6"),
        ("grasp:grasp_point=1", 2, "grasp 1 comes twice; leave one out"),
    ):
        ended = executed(*SHORT, *two, "--binding", wrong)
        assert (ended.code, len(ended.err.splitlines())) == (code, 1)
        assert says in ended.err
    ended = executed("invent", "--tool", "stick", "--minutes", "6", *two)
    assert (ended.code, len(ended.err.splitlines())) == (4, 1)
    assert "inventing: invents with one grasp; give one --binding" in ended.err
    assert contents(database) == before


def test_what_borrows_is_begun_with_all_its_tools_or_with_none(tmp_path: Path) -> None:
    """And no time is one time, however it is written."""
    database = tmp_path / "my.db"
    done("learn", "--tool", "t-hook", "--minutes", "8", "--db", database)
    borrow = ("learn", "--transfer-from", "1:radius=8,limit=1,shifts=0", "--db", database)
    both = affcli(*borrow, "--tool", "l-hook", "--tool", "fork", "--minutes", "0")
    assert both.code == UsageError.exit_code
    assert both.err.splitlines()[-1].endswith("--transfer-from 1:radius=8,limit=2,shifts=0")
    assert rows(database, "SELECT count(*) FROM learning_run") == [(1,)]
    itself = affcli(*borrow, "--tool", "t-hook", "--minutes", "0")
    assert (itself.code, len(itself.err.splitlines())) == (UsageError.exit_code, 1)
    assert "run 1 was learned with the t-hook itself" in itself.err
    assert rows(database, "SELECT count(*) FROM learning_run") == [(1,)]

    ended = done(*borrow, "--tool", "l-hook", "--hours", "0")
    assert ended.err.startswith("learned l-hook (run 2, seed 0): 0 min 00 s, 0 behaviors")
    for alike in ("--minutes=-0", "--minutes=0", "--hours=-0.0"):
        again = done(*borrow, "--tool", "l-hook", alike)
        assert again.err.startswith("already learned, nothing to do: l-hook (run 2, seed 0)")
    done("learn", "--tool", "l-stick", "--minutes", "4", "--db", database)
    two = ("--tool", "fork", "--minutes", "0", "--db", database, "--transfer-from")
    done("learn", *two, "1,3:each=9")
    again = done("learn", *two, "1", "--transfer-from", "3:each=9")
    assert again.err.startswith("already learned, nothing to do: fork (run 4, seed 0)")
    twice = affcli("learn", *two, "1:each=9", "--transfer-from", "3:each=8")
    assert (twice.code, len(twice.err.splitlines())) == (BadInputError.exit_code, 1)
    assert "--transfer-from: how to borrow is said twice (each=9 and each=8)" in twice.err
    for said in ("--minutes=0", "--hours=0"):
        refused = affcli("learn", "--tool", "fork", said, "--db", database)
        assert refused.err.startswith(
            f"affcli: {said[:-2]} 0.0: must be more than 0, but for what "
        )


def test_a_run_that_only_borrowed_is_told_from_one_that_has_not_begun(tmp_path: Path) -> None:
    """And no table of what it tried is shown, for it tried nothing."""
    database = tmp_path / "my.db"
    done("learn", "--tool", "t-hook", "--minutes", "8", "--db", database)
    borrow = ("learn", "--tool", "l-hook", "--transfer-from", "1", "--minutes", "0")
    for shown in (done(*borrow, "--db", database), done("runs", "show", "2", "--db", database)):
        assert "Run 2: what it borrowed" in shown.out
        assert "Run 2: what the l-hook affords" not in shown.out
    report = done("report", "--db", database).out
    assert "Run 1: what the t-hook affords" in report
    assert "Run 2: what the l-hook affords" not in report
    which = done("which", "nearer", "--tool", "l-hook", "--db", database)
    assert which.err == "nothing was tried by run 2, whose rows were borrowed\n"
    figure = ("figure", "learning", "--db", database, "--out", tmp_path / "a.svg")
    for asked in (("--run", "2"), ("--tool", "l-hook")):
        assert "run 2 only borrowed: it has no curve" in refused(2, *figure, *asked)
    assert "Learning over robot time; run 1: T-hook" in done(*figure).err


def test_a_run_that_borrows_goes_on_and_says_no_more_than_it_must(tmp_path: Path) -> None:
    database = tmp_path / "my.db"
    done("learn", "--tool", "t-hook", "--minutes", "8", "--db", database)
    parts = RunParts.chosen(Settings())
    with open_store(database, create=False, write=True) as store:
        spec = parts.spec("l-hook", 0, 0, None, 3)
        begun(store, replace(spec, transfer=transfer_from(store, "1")), lambda: "now")
    ended = done("learn", "--resume", "--db", database)
    (line,) = ended.err.splitlines()
    assert line.startswith("learned l-hook (run 2, seed 0): ")
