"""Whatever stands in a database, every command works with it or says so in one line."""

import json
import shutil
import sqlite3
from collections.abc import Callable, Sequence
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import strategies as st

from tests.cli.forked import Forked
from tests.fuzz.commands import CommandLine, command_lines, every_command
from tests.fuzz.conftest import Fuzz
from tests.fuzz.running import check_ending, check_json
from tests.fuzz.test_config_files import altered

INTEGERS = (0, 1, -1, 2, 3, 5, 9, 100, 2**31, 2**53 + 1, 2**63 - 1, -(2**63))
REALS = (0.5, -0.5, 1e-300, 1e6, 1e7, 1e300, -1e300, float("inf"), float("-inf"), 2.5, -12.25)
TEXTS = (
    *("", "x", "1", "nan", "t-hook", "stick", "l-hook", "done", "running", "solve", "reproduce"),
    *("break-tool", "stored", "as learned", "solved", "no row left", "no plan found", "invalid"),
    "blocked",
    *("tool adaptation", "extension of reach", "noisy", "camera", "exact", "grasp", "extend arm"),
    *("position wrist", "\x1b[31m", "a\nb", "[/]", "<script>x</script>", "=1+1", "x" * 20_000),
    *("{}", "[]", "null", "1", '"x"', "{", "[" * 5_000, "NaN", '{"a": NaN}', '{"sensor": 1}'),
    *('{"offset_distance": 1e999}', '{"offset_distance": "x"}', '{"offset_distance": null}'),
    *('{"offset_distance": 5.0, "x": 1}', '{"grasp_point": 1.0}', '{"x": 1, "y": 2}'),
    *('{"offset_distance": [1]}', '{"offset_distance": 7.0}', '{"offset_distance": -5}'),
    *("2026-13-45T99:99:99", "0001-01-01", "\u202e", "\U0001f528", "undecided", "lost"),
)
BLOBS = (b"", b"\x00", b"\xff\xfe", b"t-hook", b"x" * 5_000)
NO_TEXT = "\0no text"
"""Stands for text that is not in UTF-8, which can only be written by a cast."""
scalars = (
    st.none()
    | st.sampled_from(INTEGERS)
    | st.sampled_from(REALS)
    | st.sampled_from(TEXTS)
    | st.sampled_from(BLOBS)
    | st.just(NO_TEXT)
)
JSON_VALUES = st.sampled_from(
    (
        *("null", "true", "[]", "{}", '"x"', "-1", "0", "1", "1.5", "1e6", "1e999", "NaN", "1e308"),
        *("9223372036854775808", "9" * 400, "[1, 2]", '"camera"', "[" * 900 + "]" * 900, "-1e9"),
    )
)
Change = tuple[str, float, float, Any]
"""What to do, in which table and column and to which row (shares of all there are), and how."""

shares = st.integers(0, 9_999).map(lambda part: part / 10_000)
cells = st.one_of(
    st.tuples(st.just("set"), shares, shares, st.tuples(shares, scalars)),
    st.tuples(st.just("set"), shares, shares, st.tuples(shares, scalars)),
    st.tuples(st.just("set all"), shares, shares, scalars),
    st.tuples(st.just("swap"), shares, shares, st.tuples(shares, shares)),
    st.tuples(
        st.just("within"),
        shares,
        shares,
        st.tuples(st.integers(0, 300), JSON_VALUES, st.booleans()),
    ),
    st.tuples(st.just("delete"), shares, shares, shares),
    st.tuples(st.just("delete all"), shares, shares, st.none()),
    st.tuples(st.just("double"), shares, shares, shares),
)
structures = st.one_of(
    st.tuples(st.just("drop column"), shares, shares, st.none()),
    st.tuples(st.just("rename column"), shares, shares, st.none()),
    st.tuples(st.just("drop"), shares, shares, st.none()),
    st.tuples(st.just("empty table"), shares, shares, st.none()),
    st.tuples(st.just("pragma"), shares, shares, st.sampled_from(INTEGERS)),
    st.tuples(st.just("revision"), shares, shares, scalars),
)


DEEPER = (
    *("learn --resume", "learn --tool l-hook --behaviors 30 --seed 7 --config settings.toml"),
    *("reproduce --resume --workers 1", "verify --rows 20 --update", "predict --pushes 5"),
    *("solve --goal 2 --start 1", "solve --goal 1 --start 3 --explain", "break-tool"),
    *("camera view --trial 1 --step 1 --out new.png", "camera view --run 1 --step 3 --out new.png"),
    *("report", "report --json", "report --html new.html", "report --html new.html --robot 0"),
    *("replay --all", "replay 1", "replay 12 --steps 1 --gif new.gif", "replay --run 1"),
    *("db check", "db backup"),
    *("figure trial 9 --out new.svg", "figure affordances --run 1 --out new.svg"),
    *("figure affordances --run 1 --after-trial 2 --out new.svg", "figure row 3 --out new.svg"),
    *("figure learning --out new.svg", "figure results --out new.svg", "table list --all-runs"),
    *("runs list --all-runs", "runs show 1", "runs note 1 x", "runs delete 2 --yes"),
    *("figure adaptation --out new.svg", "table export --what steps", "table export --what trials"),
)
"""What reads most of a database; beside calls drawn at random, which reach it seldom."""


def commands_on_a_database() -> st.SearchStrategy[CommandLine]:
    """Draw plausible calls of all commands that read or write a database."""
    drawn = command_lines(hostile=False)
    known = st.sampled_from(DEEPER).map(called)
    return known | drawn.filter(lambda line: any(o == "--db" for o, _ in line.command.options))


def called(text: str) -> CommandLine:
    """Return a command line written as one."""
    words = text.split()
    named = {command.words: command for command in every_command()}
    length = 2 if tuple(words[:2]) in named else 1
    return CommandLine(named[tuple(words[:length])], tuple(words[length:]))


def tables_of(driver: sqlite3.Connection) -> list[str]:
    named = driver.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name")
    return [name for (name,) in named]


def spoil(database: Path, changes: Sequence[Change]) -> None:
    """Change a database; a change that its constraints refuse is left out."""
    with closing(sqlite3.connect(database, isolation_level=None)) as driver:
        for change in changes:
            with suppress(sqlite3.Error):
                spoil_once(driver, *change)


def spoil_once(
    driver: sqlite3.Connection, what: str, which_table: float, which_column: float, how: Any
) -> None:
    tables = tables_of(driver)
    table = tables[int(which_table * len(tables))]
    about = driver.execute(f"PRAGMA table_info({table})").fetchall()
    columns = [name for _, name, *_ in about]
    column = columns[int(which_column * len(columns))]
    if what in STRUCTURE:
        STRUCTURE[what](driver, table, column, how)
        return
    (count,) = driver.execute(f"SELECT count(*) FROM {table}").fetchone()
    key = [name for _, name, *_, primary in about if primary] or ["rowid"]
    names = ", ".join(key)

    def row(share: float) -> tuple[Any, ...]:
        at = int(share * count)
        wanted = f"SELECT {names} FROM {table} ORDER BY {names} LIMIT 1 OFFSET {at}"
        found: tuple[Any, ...] = driver.execute(wanted).fetchone() or (None,) * len(key)
        return found

    here = f"WHERE ({names}) = ({', '.join('?' * len(key))})"
    if what in {"set", "set all"}:
        share, value = how if what == "set" else (None, how)
        placeholder = "CAST(x'ff00fe' AS TEXT)" if value == NO_TEXT else "?"
        given = () if value == NO_TEXT else (value,)
        where, at = ("", ()) if share is None else (here, row(share))
        driver.execute(f"UPDATE {table} SET {column} = {placeholder} {where}", (*given, *at))
    elif what == "swap":
        one, other = row(how[0]), row(how[1])
        driver.execute(
            f"UPDATE {table} SET {column} = (SELECT {column} FROM {table} {here}) {here}",
            (*other, *one),
        )
    elif what == "within":
        written = [name for name in columns if name in WITH_JSON]
        column = written[int(which_column * len(written))] if written else column
        kept = driver.execute(f"SELECT {column} FROM {table} WHERE {column} LIKE '{{%'").fetchone()
        if kept:
            changed = altered(json.loads(kept[0]), *how)
            driver.execute(
                f"UPDATE {table} SET {column} = ? WHERE {column} = ?", (changed, kept[0])
            )
    elif what == "delete":
        driver.execute(f"DELETE FROM {table} {here}", row(how))
    elif what == "delete all":
        driver.execute(f"DELETE FROM {table}")
    elif what == "double":
        kept = ", ".join(name for name in columns if name != "id")
        driver.execute(
            f"INSERT OR REPLACE INTO {table} ({kept}) SELECT {kept} FROM {table} {here}", row(how)
        )


WITH_JSON = (
    *("settings", "versions", "checkpoint", "calibration", "repertoire", "reasons", "definition"),
    *("binding_params", "exploratory_params"),
)


def _drop(driver: sqlite3.Connection, table: str, column: str, how: Any) -> None:
    """Drop one of all tables, views and indexes."""
    everything = driver.execute("SELECT type, name FROM sqlite_master ORDER BY name").fetchall()
    kind, name = everything[(len(table) * 31 + len(column) * 7 + ord(column[0])) % len(everything)]
    driver.execute(f"DROP {kind} {name}")


STRUCTURE: dict[str, Callable[[sqlite3.Connection, str, str, Any], Any]] = {
    "drop column": lambda driver, table, column, how: driver.execute(
        f"ALTER TABLE {table} DROP COLUMN {column}"
    ),
    "rename column": lambda driver, table, column, how: driver.execute(
        f"ALTER TABLE {table} RENAME COLUMN {column} TO another"
    ),
    "drop": _drop,
    "empty table": lambda driver, table, column, how: (
        driver.execute("PRAGMA foreign_keys = OFF"),
        driver.execute(f"DROP TABLE {table}"),
        driver.execute(f"CREATE TABLE {table} ({column})"),
    ),
    "pragma": lambda driver, table, column, how: driver.execute(
        f"PRAGMA {'application_id' if len(column) % 2 else 'user_version'} = {how}"
    ),
    "revision": lambda driver, table, column, how: driver.execute(
        "UPDATE alembic_version SET version_num = ?", (how,)
    ),
}


def check_on(program: Forked, home: Path, line: CommandLine) -> None:
    """Run a command on the spoilt database and check what must hold."""
    args = [*line.command.words, *line.args, "--db", "spoilt.db"]
    ended = program.run(args, home)
    check_ending(line.command.name, ended)
    if ended.code in {0, 1} and line.args.count("--json") == 1 and ended.out[:1] in b"[{":
        check_json(ended)


def emptied(home: Path) -> None:
    """Remove what a command may have written."""
    for made in home.glob("new.*"):
        made.unlink()
    for made in home.glob("spoilt.db*"):
        made.unlink()


@pytest.mark.torture
@pytest.mark.fault(21)
@pytest.mark.fault(22)
@pytest.mark.fault(23)
@pytest.mark.parametrize(
    ("kind", "changes", "few", "share"),
    [
        ("cells", st.lists(cells, min_size=1, max_size=3), 24, 0.2),
        ("structure", st.lists(structures | cells, min_size=1, max_size=2), 16, 0.05),
    ],
    ids=["cells", "structure"],
)
def test_every_content_of_a_database_is_worked_with_or_refused(
    kind: str,
    changes: st.SearchStrategy[list[Change]],
    few: int,
    share: float,
    program: Forked,
    place: Callable[[], Path],
    fuzzing: Fuzz,
) -> None:
    home = place()

    def check(case: tuple[list[Change], CommandLine]) -> None:
        made, line = case
        emptied(home)
        database = Path(shutil.copy(home / "filled.db", home / "spoilt.db"))
        spoil(database, made)
        check_on(program, home, line)

    cases = st.tuples(changes, commands_on_a_database())
    fuzzing(f"databases: {kind}", check, cases, few=few, share=share)


@pytest.mark.torture
@pytest.mark.fault(13)
def test_every_flipped_bit_of_a_database_is_worked_with_or_refused(
    program: Forked, place: Callable[[], Path], fuzzing: Fuzz
) -> None:
    home = place()
    whole = (home / "filled.db").read_bytes()

    def check(case: tuple[list[tuple[float, int]], float, CommandLine]) -> None:
        flips, length, line = case
        emptied(home)
        spoilt = bytearray(whole)
        for at, value in flips:
            spoilt[int(at * len(whole))] ^= value
        kept = spoilt if length > 0.2 else spoilt[: int(5.0 * length * len(whole))]
        (home / "spoilt.db").write_bytes(kept)
        check_on(program, home, line)

    flips = st.tuples(shares | st.floats(0.0, 0.0003), st.integers(1, 255))
    cases = st.tuples(st.lists(flips, min_size=1, max_size=3), shares, commands_on_a_database())
    fuzzing("databases: bits", check, cases, few=16, share=0.05)
