"""What a command imports, for that is most of the time a short command takes."""

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from affcli.store import open_store
from tests.cli.program import done

CAMERA = {"cv2", "scipy", "PIL"}
PICTURES = {"matplotlib", "jinja2", "pyarrow"}
CLUSTER = {"distributed", "dask"}
RUN = """\
import json, sys
from affcli.cli.main import main
for words in json.loads(sys.argv[1]):
    sys.argv = ["affcli", *words]
    assert main() == 0, words
sys.stderr.write("\\n".join(["", "all done", *sys.modules]))
"""


def imported_by(*args: str | Path) -> set[str]:
    """Run a command to its end and return the modules that it imported."""
    return imported_by_all(args)


def imported_by_all(*commands: Sequence[str | Path]) -> set[str]:
    """Run commands, one after the other in one process; return what all of them imported.

    What none of them may import is asked of all at once: starting Python takes longer than they do.
    """
    ended = subprocess.run(
        [sys.executable, "-c", RUN, json.dumps([[*map(str, one)] for one in commands])],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    modules = ended.stderr.splitlines()
    assert "all done" in modules, ended
    return set(modules)


@pytest.fixture
def empty(tmp_path: Path) -> Path:
    """A database without records."""
    path = tmp_path / "empty.db"
    with open_store(path, create=True, write=True):
        pass
    return path


def test_the_help_of_the_program_imports_nothing_heavy() -> None:
    heavy = {
        "numpy",
        "sqlalchemy",
        "pymunk",
        "alembic",
        "sqlite3",
        "rich.table",
        *CAMERA,
        *PICTURES,
        *CLUSTER,
    }
    assert not imported_by_all(("--help",), ("figure", "--help"), ("--version",)) & heavy


def test_the_help_of_a_command_imports_no_engine_and_no_database() -> None:
    """Its module imports at the top; what is slow, or may be missing, waits for its first use."""
    heavy = {"sqlalchemy", "pymunk", "alembic", *CAMERA, *PICTURES, *CLUSTER}
    commands = (
        *(("learn",), ("solve",), ("replay",), ("report",), ("experiment",)),
        ("camera", "view"),
        *(("table", "export"), ("figure", "row"), ("figure", "trial")),
    )
    assert not imported_by_all(*((*command, "--help") for command in commands)) & heavy


def test_sql_imports_neither_sqlalchemy_nor_physics(empty: Path) -> None:
    heavy = {"numpy", "sqlalchemy", "pymunk", "alembic"}
    query = ("sql", "select * from affordance_table", "--db", empty)
    assert not imported_by(*query) & heavy
    forms = ((*query, form) for form in ("--json", "--csv"))
    assert not imported_by_all(*forms) & (heavy | {"rich.table"})
    assert not imported_by("db", "info", "--json", "--db", empty) & heavy


def test_learning_in_an_existing_database_imports_no_alembic(empty: Path, tmp_path: Path) -> None:
    learn = ("learn", "--tool", "stick", "--behaviors", "5", "--db")
    assert "alembic" in imported_by(*learn, tmp_path / "new.db")
    modules = imported_by(*learn, empty)
    assert "alembic" not in modules
    assert {"numpy", "pymunk", "sqlalchemy"} <= modules
    assert "rich.progress" not in modules  # there is no terminal to show it on


def test_pyarrow_loads_only_for_parquet(empty: Path, tmp_path: Path) -> None:
    done("learn", "--tool", "stick", "--behaviors", "20", "--db", empty)
    asked = (("list",), ("export", "--format", "json"), ("export", "--out", tmp_path / "x.csv"))
    modules = imported_by_all(*(("table", *args, "--db", empty) for args in asked))
    assert not modules & {"pyarrow", "pymunk", *CAMERA}
    assert "pyarrow" in imported_by(
        "table", "export", "--out", tmp_path / "x.parquet", "--db", empty
    )


def test_the_camera_s_libraries_load_only_to_look_through_it(empty: Path) -> None:
    learn = ("learn", "--tool", "stick", "--behaviors", "5", "--db", empty)
    exact = (*learn, "--seed", "1", "--sensor", "exact")
    assert not imported_by_all(learn, exact, ("report", "--db", empty)) & CAMERA
    assert {"cv2", "scipy"} <= imported_by(*learn, "--sensor", "camera")
    assert "pymunk" not in imported_by("camera", "calibrate")


def test_matplotlib_and_pillow_load_only_for_a_film(empty: Path, tmp_path: Path) -> None:
    done("learn", "--tool", "l-hook", "--behaviors", "200", "--db", empty)
    done("solve", "--goal", "3", "--start", "1", "--db", empty)
    shown = (("1",), ("1", "--json"), ("--all",), ("--run", "1", "--steps", "1"))
    replays = (("replay", *words, "--db", empty) for words in shown)
    assert not imported_by_all(*replays) & {*CAMERA, *PICTURES}
    film = ("--steps", "1", "--gif", tmp_path / "film.gif")
    modules = imported_by("replay", "1", *film, "--db", empty)
    assert {"matplotlib", "PIL"} <= modules
    assert not modules & {"matplotlib.pyplot", "cv2", "scipy"}


def test_the_tests_libraries_stay_with_the_tests(empty: Path) -> None:
    modules = imported_by("report", "--db", empty)
    assert not modules & {
        "pytest",
        "hypothesis",
        "scipy",
        "shapely",
        "syrupy",
        "matplotlib",
        "pyarrow",
    }
