"""The database is missing, empty, damaged, another program's, from the future (3), or odd."""

import os
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from affcli.store.database_file import REVISION
from tests.cli.program import done, names_in, refused, rows

READING = {
    "report": ("report",),
    "report --json": ("report", "--json"),
    "sql": ("sql", "select 1"),
    "db info": ("db", "info"),
    "table list": ("table", "list"),
    "table show": ("table", "show", "1"),
    "table export": ("table", "export"),
    "replay": ("replay", "1"),
    "replay --run": ("replay", "--run", "1"),
    "replay --all": ("replay", "--all"),
    "report --html": ("report", "--html", "page.html"),
    "predict": ("predict",),
    "db check": ("db", "check"),
    "db backup": ("db", "backup"),
    "figure affordances": ("figure", "affordances", "--out", "a.png"),
    "figure results": ("figure", "results", "--out", "a.png"),
    "camera view": ("camera", "view", "--trial", "1", "--out", "a.png"),
}
WRITING_WHAT_IS_THERE = {
    "solve": ("solve", "--goal", "2"),
    "break-tool": ("break-tool",),
    "db upgrade": ("db", "upgrade"),
    "verify --update": ("verify", "--update"),
    "learn --resume": ("learn", "--resume"),
}
MAKING = {
    "learn": ("learn", "--tool", "stick", "--behaviors", "5"),
    "reproduce": ("reproduce", "--robots", "1"),
}
NEEDING = READING | WRITING_WHAT_IS_THERE
EVERY = NEEDING | MAKING
SOME = {name: EVERY[name] for name in ("report", "sql", "solve", "learn")}


@pytest.mark.fault(15)
@pytest.mark.parametrize("args", NEEDING.values(), ids=NEEDING.keys())
def test_a_missing_file_is_named_and_not_made(args: tuple[str, ...], tmp_path: Path) -> None:
    line = refused(3, *args, cwd=tmp_path)
    assert line.startswith("affcli: affcli.db: no database there; `affcli learn` makes one")
    assert names_in(tmp_path) == []


@pytest.mark.fault(14)
@pytest.mark.parametrize("args", NEEDING.values(), ids=NEEDING.keys())
def test_an_empty_file_stays_empty_when_it_is_read(args: tuple[str, ...], tmp_path: Path) -> None:
    path = tmp_path / "affcli.db"
    path.touch()
    assert "an empty file; `affcli learn` makes a database of it" in refused(3, *args, cwd=tmp_path)
    assert path.stat().st_size == 0


@pytest.mark.fault(14)
def test_an_empty_file_is_initialised_by_learning(tmp_path: Path) -> None:
    path = tmp_path / "mine.db"
    path.touch()
    done(*MAKING["learn"], "--db", path)
    assert rows(path, "SELECT tool, status FROM learning_run") == [("stick", "done")]


def test_it_is_initialised_below_a_folder_that_exists_only(tmp_path: Path) -> None:
    line = refused(3, *MAKING["learn"], "--db", "none/mine.db", cwd=tmp_path)
    assert "its folder does not exist; make it" in line
    assert names_in(tmp_path) == []


def not_a_database(path: Path) -> None:
    path.write_text("Dear diary,\n" * 500)


def truncated(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-5000])


def with_a_flipped_page(path: Path) -> None:
    whole = bytearray(path.read_bytes())
    middle = len(whole) // 8192 * 4096
    whole[middle : middle + 4096] = bytes(255 - byte for byte in whole[middle : middle + 4096])
    path.write_bytes(whole)


def of_another_program(path: Path) -> None:
    path.unlink()
    with closing(sqlite3.connect(path)) as other:
        other.execute("CREATE TABLE learning_run (id INTEGER)")


def from_the_future(path: Path) -> None:
    with closing(sqlite3.connect(path)) as driver, driver:
        driver.execute("UPDATE alembic_version SET version_num = '0099'")


SPOILT: dict[Callable[[Path], None], str] = {
    not_a_database: "not a SQLite database; name another file with --db",
    truncated: "damaged; restore a copy of the file",
    with_a_flipped_page: "damaged; restore a copy of the file",
    of_another_program: "of another program; name another file with --db",
    from_the_future: f"at revision 0099, this affcli knows {REVISION}: install a newer",
}


@pytest.mark.fault(11)
@pytest.mark.fault(13)
@pytest.mark.fault(14)
@pytest.mark.parametrize("spoil", SPOILT, ids=lambda spoil: spoil.__name__)
@pytest.mark.parametrize("args", SOME.values(), ids=SOME.keys())
def test_a_spoilt_file_is_left_as_it_is(
    args: tuple[str, ...], spoil: Callable[[Path], None], learned: Path
) -> None:
    spoil(learned)
    before = learned.read_bytes()
    line = refused(3, *args, "--db", learned)
    assert line.startswith(f"affcli: {learned}: ")
    assert SPOILT[spoil] in line
    assert learned.read_bytes() == before
    assert names_in(learned.parent) == [learned.name]


@pytest.mark.fault(14)
@pytest.mark.parametrize("name", sorted(EVERY.keys() - SOME.keys()))
def test_every_other_command_refuses_another_programs_file(name: str, learned: Path) -> None:
    of_another_program(learned)
    before = learned.read_bytes()
    assert SPOILT[of_another_program] in refused(3, *EVERY[name], "--db", learned)
    assert learned.read_bytes() == before


def test_db_info_says_which_revision_a_newer_file_has(learned: Path) -> None:
    from_the_future(learned)
    info = done("db", "info", "--json", "--db", learned).result
    assert (info["revision"], info["code_revision"]) == ("0099", REVISION)


PATHS = {
    "a folder": (b".", "not a file"),
    "a device": (b"/dev/null", "not a file"),
    "10 kB": (b"x" * 10_000, "File name too long"),
    "escape sequence": (b"no/\x1b[31mred.db", "no/\\x1b[31mred.db: "),
    "no character at all": (b"no/\xff.db", "no/\\udcff.db: "),
    "markup": (b"no/[/].db", "no/[/].db: "),
}


@pytest.mark.fault(21)
@pytest.mark.parametrize(("path", "says"), PATHS.values(), ids=PATHS.keys())
def test_an_impossible_path_is_one_line(path: bytes, says: str, tmp_path: Path) -> None:
    for args in (EVERY["learn"], EVERY["sql"]):
        assert says in refused(3, *args, "--db", path, cwd=tmp_path)
    assert names_in(tmp_path) == []


@pytest.mark.fault(22)
@pytest.mark.parametrize(
    "name", ["a'; DROP TABLE learning_run; --.db", "50% of #1?.db", "[x] b.db"]
)
def test_a_strange_path_is_only_a_path(name: str, tmp_path: Path) -> None:
    done(*MAKING["learn"], "--db", name, cwd=tmp_path)
    done("report", "--db", name, cwd=tmp_path)
    info = done("db", "info", "--db", name, cwd=tmp_path)
    assert info.out.startswith("path ")
    assert name in info.out
    assert names_in(tmp_path) == [name]


@pytest.mark.fault(21)
def test_a_path_of_no_character_is_shown_escaped(tmp_path: Path) -> None:
    name = b"\xff.db"
    done(*MAKING["learn"], "--db", name, cwd=tmp_path)
    assert "\\udcff.db" in done("db", "info", "--db", name, cwd=tmp_path).out
    assert done("db", "info", "--db", name, "--json", cwd=tmp_path).result["path"] == "\udcff.db"
    assert [os.fsencode(path.name) for path in tmp_path.iterdir()] == [name]


def test_the_database_is_db_else_the_environment_else_here(tmp_path: Path) -> None:
    learn = MAKING["learn"]
    done(*learn, "--db", "option.db", cwd=tmp_path, AFFCLI_DB="environment.db")
    assert names_in(tmp_path) == ["option.db"]
    done(*learn, cwd=tmp_path, AFFCLI_DB="environment.db")
    assert names_in(tmp_path) == ["environment.db", "option.db"]
    done(*learn, cwd=tmp_path)
    assert names_in(tmp_path) == ["affcli.db", "environment.db", "option.db"]


def test_db_upgrade_says_that_there_is_nothing_to_do(learned: Path) -> None:
    before = learned.read_bytes()
    assert "up to date" in done("db", "upgrade", "--db", learned).err
    assert learned.read_bytes() == before


def test_db_info_counts_what_is_there(learned: Path) -> None:
    info = done("db", "info", "--json", "--db", learned).result
    assert info["bytes"] == learned.stat().st_size
    counts = info["counts"]
    assert (counts["learning runs"], counts["behaviors"], counts["trials"]) == (2, 1600, 0)
    ((affordances,),) = rows(learned, "SELECT count(*) FROM affordance")
    assert counts["affordances"] == affordances
