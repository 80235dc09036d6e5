"""A laboratory in Python: each method does what the command does, and says what it says."""

import pydoc
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import affcli
from affcli.core.trial import Outcome
from tests.cli.program import done, refused, rows
from tests.logs.made_up import MAP, TOOLS, written

HEAVY = {
    *("numpy", "sqlalchemy", "alembic", "pymunk", "sqlite3", "scipy", "cv2", "PIL"),
    *("matplotlib", "jinja2", "pyarrow", "distributed", "rich", "typer", "pandas", "polars"),
}
SHORT = {"trial.max_steps": 6}


def imported_after(code: str) -> set[str]:
    """Return what is imported after some code in a fresh interpreter."""
    text = f"import sys\n{code}\nprint(*sys.modules)"
    ended = subprocess.run(
        [sys.executable, "-c", text], capture_output=True, text=True, timeout=60, check=True
    )
    return set(ended.stdout.split())


@pytest.fixture(scope="module")
def learned(tmp_path_factory: pytest.TempPathFactory) -> affcli.Laboratory:
    """A laboratory in which a T-hook was learned, and used once."""
    lab = affcli.Laboratory(tmp_path_factory.mktemp("lab") / "my.db")
    lab.learn("t-hook", minutes=20, seed=1, settings=SHORT, note="first")
    lab.solve(goal=2, start=2)
    return lab


def test_to_import_it_imports_nothing_heavy() -> None:
    """No more than `--help` does; asking what there is, and for its errors, loads no more."""
    for code in ("import affcli", "import affcli; dir(affcli); affcli.AffcliError"):
        modules = imported_after(code)
        assert not modules & HEAVY
        assert {name for name in modules if name.startswith("affcli")} <= {
            *("affcli", "affcli.errors"),
        }


def test_every_public_name_is_there() -> None:
    names = [name for homes in affcli._HOMES.values() for name in homes]  # type: ignore[attr-defined]
    for name in (*names, *affcli.__all__):
        assert name in dir(affcli)
        assert getattr(affcli, name).__doc__
    stub = Path(affcli.__file__).with_suffix(".pyi").read_text()
    assert all(f"import {name} as {name}" in stub for name in names)
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        _ = affcli.nothing  # type: ignore[attr-defined]


def test_help_is_a_page() -> None:
    page = pydoc.plain(pydoc.render_doc(affcli))
    methods = [name for name in vars(affcli.Laboratory) if not name.startswith("_")]
    assert set(methods) >= {"learn", "solve", "experiment", "compare", "query", "import_log"}
    for name in methods:
        assert f" {name}" in page
        assert getattr(affcli.Laboratory, name).__doc__
    assert 'lab = affcli.Laboratory("my.db")' in page
    assert len(page.splitlines()) < 500


def test_a_run_is_that_of_the_command(learned: affcli.Laboratory) -> None:
    """The same call, and the same command, find it done."""
    again = learned.learn("t-hook", minutes=20, seed=1, settings=SHORT)
    command = ("learn", "--tool", "t-hook", "--minutes", "20", "--seed", "1", "--json")
    given = ("--set", "trial.max_steps=6", "--db", learned.path)
    (by_command,) = done(*command, *given).results
    assert (by_command["run"], by_command["new"]) == (again.id, False)
    (only,) = learned.runs()
    assert (only, only.note) == (again, "first")
    assert learned.runs("stick") == ()


def test_what_robots_solve_is_saved(tmp_path: Path) -> None:
    lab = affcli.Laboratory(tmp_path / "my.db")
    lab.learn("t-hook", minutes=20, seed=1, settings=SHORT)
    trials = lab.solve(goal="2", start="all", tool="t-hook", planner="nested-query:share=0.5")
    stored = rows(lab.path, "SELECT id, outcome, steps, planner FROM trial ORDER BY id")
    assert [(one.id, str(one.end.outcome), one.end.steps) for one in trials] == [
        row[:3] for row in stored
    ]
    assert {row[3] for row in stored} == {"nested-query:share=0.5"}
    one = trials[0]
    assert repr(one) == (
        f"SolvedTrial(id={one.id}, tool='t-hook', goal='2', start={one.trial.task.start_name!r}, "
        f"outcome={one.end.outcome.value!r}, steps={one.end.steps})"
    )
    assert {one.solved for one in trials} == {one.end.outcome is Outcome.SOLVED for one in trials}
    assert all(one["equal"] for one in done("replay", "--all", "--json", "--db", lab.path).results)


def test_an_experiment_and_its_comparison_are_those_of_the_commands(tmp_path: Path) -> None:
    lab = affcli.Laboratory(tmp_path / "my.db")
    short = {"trial": {"max_steps": 3}}
    asked = {
        "experiment": {"name": "two", "robots": 2},
        "base": {"minutes": 3, "tools": ["t-hook"], "tasks": ["extension-of-reach"], **short},
        "condition": [{"name": "usual"}, {"name": "few", "planner": "nested-query:share=0.05"}],
    }
    told: list[tuple[int, int]] = []
    result = lab.experiment(asked, progress=lambda saved, of: told.append((saved, of)))
    assert result.robots == 2
    assert told == [(0, 2), (1, 2), (2, 2)]
    (total,) = lab.compare("two", by=()).totals
    (by_command,) = done("compare", "two", "--json", "--db", lab.path).results
    assert by_command["totals"][0]["p"] == total.p
    with pytest.raises(affcli.UsageError, match="no way to tell trials apart 'tol'"):
        lab.compare("two", by=["tol"])


def test_a_log_is_imported(tmp_path: Path) -> None:
    folder, lab = written(tmp_path, bad=1), affcli.Laboratory(tmp_path / "my.db")
    files, how = str(folder / "log" / "**" / "*.txt"), folder / "map.toml"
    assert how.read_text() == MAP
    with pytest.raises(affcli.BadInputError, match="cannot be read: 1 line; the first"):
        lab.import_log(files, how, strict=True)
    with pytest.warns(UserWarning, match="left out 1 line; the first: "):
        runs = lab.import_log([files], how, note="theirs")
    assert {run.spec.tool for run in runs} == set(TOOLS)
    run, effect = lab.which("nearer", behavior="draw")[0]
    assert (run.spec.tool, effect.moved) == ("hook", effect.tried)
    array = lab.rows(tool="rake").array()
    assert all(map(bool, array["start_wrist_to_object_x"] != array["start_wrist_to_object_x"]))
    with pytest.raises(affcli.UsageError, match="but from a log, which no robot can use"):
        lab.solve(goal=1)


@pytest.mark.parametrize(
    ("call", "error", "says"),
    [
        (lambda lab: lab.learn("hammer"), affcli.UsageError, "did you mean"),
        (lambda lab: lab.learn("stick", hours=1, minutes=1), affcli.UsageError, "give one of"),
        (lambda lab: lab.learn("stick", hours=0), affcli.BadInputError, "hours = 0: must be"),
        (lambda lab: lab.learn("stick", minutes=float("nan")), affcli.BadInputError, "minutes"),
        (lambda lab: lab.learn("stick", minutes="1"), affcli.BadInputError, "minutes = 1: must be"),
        (lambda lab: lab.learn("stick", seed="1"), affcli.BadInputError, "seed = 1: must be"),
        (lambda lab: lab.learn("stick", behaviors=2.5), affcli.BadInputError, "a whole number"),
        (lambda lab: lab.learn("stick", seed=2**63), affcli.BadInputError, "seed = 92233"),
        (lambda lab: lab.learn("stick", sensor="nose"), affcli.UsageError, "no sensor 'nose'"),
        (lambda lab: lab.learn("stick", settings={"arm.x": 1}), affcli.BadInputError, "no key"),
        (lambda lab: lab.learn("stick", note="x" * 501), affcli.BadInputError, "501|500"),
        (lambda lab: lab.solve(), affcli.UsageError, "goal"),
        (lambda lab: lab.solve(goal=9), affcli.UsageError, "no goal '9'"),
        (lambda lab: lab.solve(goal=1, planner="plan"), affcli.UsageError, "no planner 'plan'"),
        (lambda lab: lab.rows("cells"), affcli.UsageError, "no kind of record 'cells'"),
        (lambda lab: lab.rows("steps", region="handle"), affcli.UsageError, "choose rows"),
        (lambda lab: lab.rows(run=9), affcli.UsageError, "numbered 1 to 1"),
        (lambda lab: lab.which("up"), affcli.UsageError, "no way 'up'"),
        (lambda lab: lab.compare("none"), affcli.UsageError, "no experiment 'none'"),
        (lambda lab: lab.compare(), affcli.UsageError, "name an experiment"),
        (lambda lab: lab.query("drop table trial"), affcli.BadInputError, "sql: "),
        (lambda lab: lab.experiment("none.toml"), affcli.BadInputError, "No such file"),
    ],
)
def test_what_cannot_be_is_said_in_a_line(
    call: Callable[[Any], object], error: type[Exception], says: str, learned: affcli.Laboratory
) -> None:
    before = learned.path.read_bytes()
    with pytest.raises(error, match=says) as told:
        call(learned)
    assert str(told.value).isprintable()
    assert learned.path.read_bytes() == before


def test_reading_makes_no_database(tmp_path: Path) -> None:
    lab = affcli.Laboratory(tmp_path / "none.db")
    for call in (lab.runs, lab.rows, lambda: lab.query("select 1"), lambda: lab.solve(goal=1)):
        with pytest.raises(affcli.DatabaseError, match="no database there"):
            call()
    assert not lab.path.exists()
    assert "no database there" in refused(3, "runs", "list", "--db", lab.path)


def test_a_record_that_cannot_be_read_is_left_out_with_a_warning(
    learned: affcli.Laboratory, tmp_path: Path
) -> None:
    import sqlite3

    path = tmp_path / "my.db"
    path.write_bytes(learned.path.read_bytes())
    lab = affcli.Laboratory(path)
    lab.learn("stick", behaviors=2)
    driver = sqlite3.connect(path, isolation_level=None)
    driver.execute("UPDATE learning_run SET repertoire = '[1]' WHERE id = 1")
    driver.close()
    with pytest.warns(UserWarning, match="left out: learning run 1"):
        (run,) = lab.runs()
    assert run.spec.tool == "stick"


def test_a_robot_invents_and_another_run_uses_that(tmp_path: Path) -> None:
    lab = affcli.Laboratory(tmp_path / "my.db")
    run, inventions = lab.invent("stick", minutes=16, seed=4)
    kept = [str(one.behavior.call) for one in inventions if one.kept]
    assert kept
    used = lab.learn("stick", behaviors=20, repertoire=["paper", f"invented:run={run.id}"])
    assert [str(one.call) for one in used.spec.repertoire][8:] == kept
    with pytest.raises(affcli.BadInputError, match="too few to invent"):
        lab.invent("stick", minutes=1)


def test_a_robot_carries_over_what_it_learned_with_another_tool(tmp_path: Path) -> None:
    lab = affcli.Laboratory(tmp_path / "my.db")
    lab.learn("l-hook", minutes=5)
    run = lab.learn("mirrored-hook", minutes=0, transfer_from="1:each=20")
    assert (run.behaviors, run.status) == (0, "done")
    assert 0 < run.rows <= 150
    with pytest.raises(affcli.UsageError, match="no learning run 7"):
        lab.learn("mirrored-hook", minutes=0, transfer_from="7")
    assert lab.learn("mirrored-hook", hours=-0.0, transfer_from="1:each=20") == run
    with pytest.raises(affcli.BadInputError, match="minutes"):
        lab.learn("mirrored-hook", minutes=0)
    number: Any = 1
    with pytest.raises(affcli.BadInputError, match="transfer_from = 1: must be a text as '1,2'"):
        lab.learn("mirrored-hook", minutes=0, transfer_from=number)
    nowhere = affcli.Laboratory(tmp_path / "none.db")
    with pytest.raises(affcli.DatabaseError):
        nowhere.learn("mirrored-hook", minutes=0, transfer_from="1")
    assert not nowhere.path.exists()
