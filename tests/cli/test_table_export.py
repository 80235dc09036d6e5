"""``affcli table export`` and ``affcli sql --csv``: what leaves the database leaves it whole."""

import csv
import io
import json
import shlex
import sqlite3
import subprocess
import tempfile
from contextlib import closing
from pathlib import Path
from typing import Any

import pyarrow.csv
import pyarrow.parquet as pq
import pytest

from tests.cli.program import (
    PROGRAM,
    ROOT,
    Arg,
    Ended,
    done,
    environment,
    names_in,
    one_printable_line,
    refused,
)
from tests.cli.pseudo_terminal import on_terminal
from tests.cli.table_rows import EVIL, listed, tamper, vary_counters
from tests.cli.test_read_only import as_nobody
from tests.cli.without import without

RELATIONS = {"behaviors": "behavior", "trials": "trial", "steps": "step"}
INSTALL = "affcli: Parquet needs pyarrow; install it: pip install 'affcli[parquet]'\n"
Record = dict[str, Any]


def selected(database: Path, query: str) -> list[Record]:
    """Return the records of a query, asked without affcli."""
    with closing(sqlite3.connect(database)) as driver:
        driver.row_factory = sqlite3.Row
        return [dict(row) for row in driver.execute(query)]


def wide(database: Path, *args: Arg) -> list[Record]:
    """Return all columns of the rows that ``table list`` lists, each with its region."""
    regions = {row["id"]: row["region"] for row in listed(database, *args)}
    every = selected(database, "SELECT * FROM affordance_wide ORDER BY run, id")
    return [{**row, "region": regions[row["id"]]} for row in every if row["id"] in regions]


def exported(database: Path, *args: Arg) -> str:
    """Return what is exported to stdout, which says nothing else."""
    ended = done("table", "export", *args, "--db", database)
    assert ended.err == ""
    return ended.out


def read_csv(text: str) -> list[dict[str, str]]:
    """Return the records of a CSV file as Python's reader finds them."""
    return list(csv.DictReader(io.StringIO(text, newline=""), strict=True))


def read_bytes_as_text(path: Path) -> str:
    """Return a file as text, its lines' ends as they are."""
    return path.read_bytes().decode()


def as_csv(records: list[Record]) -> list[dict[str, str]]:
    """Return records as CSV holds them: numbers as Python writes them, NULL as nothing."""
    return [
        {
            name: "" if value is None else value if isinstance(value, str) else repr(value)
            for name, value in record.items()
        }
        for record in records
    ]


def as_pandas_does(path: Path) -> list[Record]:
    """Return the records of a CSV file, its kinds guessed; not by Python's reader."""
    parse = pyarrow.csv.ParseOptions(newlines_in_values=True)
    found: list[Record] = pyarrow.csv.read_csv(path, parse_options=parse).to_pylist()
    return found


def test_every_format_holds_all_columns_and_the_region(learned: Path, tmp_path: Path) -> None:
    vary_counters(learned)
    wanted = wide(learned)
    assert len(wanted) > 100
    for ending in ("csv", "json", "parquet"):
        path = tmp_path / f"rows.{ending}"
        ended = done("table", "export", "--out", path, "--db", learned)
        assert (ended.out, ended.err) == ("", f"{len(wanted)} rows: {path}\n")
    assert read_csv(read_bytes_as_text(tmp_path / "rows.csv")) == as_csv(wanted)
    assert as_pandas_does(tmp_path / "rows.csv") == wanted
    assert json.loads((tmp_path / "rows.json").read_text()) == wanted
    assert pq.read_table(tmp_path / "rows.parquet").to_pylist() == wanted


@pytest.mark.parametrize("what", RELATIONS)
def test_the_tables_behind_can_be_taken_out_too(what: str, used: Path, tmp_path: Path) -> None:
    wanted = selected(used, f"SELECT * FROM {RELATIONS[what]}")
    assert len(wanted) > 30
    assert read_csv(exported(used, "--what", what)) == as_csv(wanted)
    assert json.loads(exported(used, "--what", what, "--format", "json")) == wanted
    path = tmp_path / "all.parquet"
    done("table", "export", "--what", what, "--out", path, "--db", used)
    assert pq.read_table(path).to_pylist() == wanted
    of_stick = read_csv(exported(used, "--what", what, "--tool", "stick", "--limit", "3"))
    assert len(of_stick) == 3
    run = {"behaviors": "learning_run_id", "trials": "learning_run_id"}.get(what)
    assert run is None or {record[run] for record in of_stick} == {"2"}


def test_the_filters_are_those_of_the_list(learned: Path) -> None:
    vary_counters(learned)
    for args in (
        ("--tool", "stick"),
        ("--run", "1", "--limit", "7"),
        ("--behavior", "slide arm left 5", "--probability", "0.2..0.8"),
        ("--region", "left hook", "--limit", "3"),
        ("--all-runs", "--probability", ">0.9", "--region", "handle"),
    ):
        wanted = wide(learned, *args)
        assert wanted
        assert json.loads(exported(learned, *args, "--format", "json")) == wanted


def test_all_robots_of_a_reproduction_go_into_one_file(reproduced: Path, tmp_path: Path) -> None:
    path = tmp_path / "robots.parquet"
    done("table", "export", "--all-runs", "--out", path, "--db", reproduced)
    assert pq.read_table(path).to_pylist() == wide(reproduced, "--all-runs")
    assert set(pq.read_table(path)["run"].to_pylist()) == set(range(1, 11))
    behaviors = read_csv(exported(reproduced, "--all-runs", "--what", "behaviors"))
    assert behaviors == as_csv(selected(reproduced, "SELECT * FROM behavior"))
    assert "give --run ID or --all-runs" in refused(2, "table", "export", "--db", reproduced)


def test_no_rows_leave_the_headings(learned: Path, tmp_path: Path) -> None:
    none = ("--probability", "<=0.5", "--db", learned)
    ended = done("table", "export", *none)
    (headings,) = csv.reader([ended.out])
    assert (headings[0], headings[-1], ended.err) == ("id", "region", "no rows\n")
    ended = done("table", "export", *none, "--format", "json")
    assert (ended.json, ended.err) == ([], "no rows\n")
    path = tmp_path / "none.parquet"
    assert done("table", "export", *none, "--out", path).err == f"no rows: {path}\n"
    assert pq.read_table(path).column_names == headings
    assert pq.read_table(path).num_rows == 0
    ended = done("table", "export", "--limit", "1", "--out", tmp_path / "one.csv", "--db", learned)
    assert ended.err == f"1 row: {tmp_path / 'one.csv'}\n"


def test_stdout_has_a_name_and_the_format_need_not_be_that_of_the_ending(
    learned: Path, tmp_path: Path
) -> None:
    text = exported(learned, "--out", "-")
    assert text == exported(learned) == exported(learned, "--format", "csv")
    path = tmp_path / "rows.txt"
    done("table", "export", "--format", "csv", "--out", path, "--db", learned)
    assert read_bytes_as_text(path).replace("\r\n", "\n") == text.replace("\r\n", "\n")
    done("table", "export", "--out", tmp_path / "ROWS.CSV", "--db", learned)
    assert (tmp_path / "ROWS.CSV").read_bytes() == path.read_bytes()
    assert path.read_bytes().count(b"\r\n") == path.read_bytes().count(b"\n")
    assert path.stat().st_mode & 0o777 == 0o644


USAGE: dict[str, tuple[tuple[str, ...], str]] = {
    "unknown format": (("--format", "xls"), "no format 'xls'; did you mean csv or json or parquet"),
    "near a format": (("--format", "parket"), "no format 'parket'; did you mean parquet?"),
    "Parquet without a file": (
        ("--format", "parquet"),
        "Parquet is not text: give --out FILE.parq",
    ),
    "Parquet to stdout": (("--format", "parquet", "--out", "-"), "Parquet is not text"),
    "unknown records": (
        ("--what", "row"),
        "no kind of record 'row'; did you mean rows?",
    ),
    "behaviors by region": (
        ("--what", "behaviors", "--region", "handle"),
        "--behavior, --probability and --region choose rows: not --what behaviors",
    ),
    "trials by probability": (("--what", "trials", "--probability", ">0.5"), "choose rows: not "),
    "steps by behavior": (("--what", "steps", "--behavior", "extend arm"), "choose rows: not --wh"),
}
PLACES: dict[str, tuple[tuple[str, ...], str]] = {
    "another ending": (
        ("--out", "x.txt"),
        "x.txt: name it *.csv or *.json or *.parquet, or give --format",
    ),
    "no ending": (("--out", "rows"), "rows: name it *.csv or *.json"),
    "an escape sequence": (("--out", "\x1b[31m"), r"\x1b[31m: name it *.csv"),
    "over a file": (("--out", "mine.csv"), "mine.csv: exists already; name another file, or give"),
    "into no folder": (("--out", "none/x.csv"), "none/x.csv: its folder does not exist; make it"),
    "over a folder": (("--out", "folder.csv", "--force"), "folder.csv: not a file; name another"),
    "10 kB": (("--out", "x" * 10_000 + ".csv"), "File name too long"),
    "over the database": (
        ("--out", "learned.db", "--format", "csv", "--force"),
        "learned.db: the database itself; name another file",
    ),
    "over the database by another name": (
        ("--out", "link.csv", "--force"),
        "link.csv: the database itself",
    ),
}


@pytest.fixture
def folder(learned: Path) -> Path:
    """A folder with a database, learned.db, and a few things that are not to be touched."""
    (learned.parent / "mine.csv").write_text("precious")
    (learned.parent / "folder.csv").mkdir()
    (learned.parent / "link.csv").symlink_to(learned)
    return learned.parent


@pytest.mark.parametrize(
    ("code", "args", "says"),
    [(code, *one) for code, all_ in ((2, USAGE), (4, PLACES)) for one in all_.values()],
    ids=[*USAGE, *PLACES],
)
def test_what_cannot_be_exported_is_one_line_and_no_file(
    code: int, args: tuple[str, ...], says: str, folder: Path
) -> None:
    before, stored = names_in(folder), (folder / "learned.db").read_bytes()
    line = refused(code, "table", "export", *args, "--db", "learned.db", cwd=folder)
    assert says in line
    assert names_in(folder) == before
    assert (folder / "mine.csv").read_text() == "precious"
    assert (folder / "learned.db").read_bytes() == stored


def test_a_file_is_written_over_by_force(folder: Path) -> None:
    before = names_in(folder)
    args = ("--out", "mine.csv", "--force", "--db", "learned.db")
    done("table", "export", *args, cwd=folder)
    assert len(read_csv(read_bytes_as_text(folder / "mine.csv"))) == len(
        listed(folder / "learned.db")
    )
    assert names_in(folder) == before


@pytest.mark.fault(4)
@pytest.mark.parametrize("ending", ["csv", "json", "parquet"])
def test_on_a_full_disk_no_file_is_left_and_none_is_promised(
    ending: str, learned: Path, tmp_path: Path
) -> None:
    (tmp_path / f"full.{ending}").write_text("as it was")
    before = names_in(tmp_path)
    export = ("table", "export", "--force", "--db", str(learned), "--out", f"full.{ending}")
    ended = subprocess.run(
        ["/bin/sh", "-c", f"ulimit -f 20; {shlex.join([*PROGRAM, *export])}"],
        cwd=tmp_path,
        env=environment(PYTHONPATH=str(ROOT)),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (ended.returncode, ended.stdout) == (4, "")
    line = one_printable_line(ended.stderr)
    assert line.startswith(f"affcli: full.{ending}: cannot be written: ")
    assert names_in(tmp_path) == before
    assert (tmp_path / f"full.{ending}").read_text() == "as it was"


def test_where_one_may_not_write_is_named(learned: Path) -> None:
    with tempfile.TemporaryDirectory() as name:
        database = Path(name) / "kept.db"
        database.write_bytes(learned.read_bytes())
        Path(name).chmod(0o555)
        out = str(Path(name) / "rows.csv")
        export = ("table", "export", "--db", str(database))
        written, shown = as_nobody((*export, "--out", out), export)
        Path(name).chmod(0o755)
        assert (written.code, written.out) == (4, "")
        assert one_printable_line(written.err) == (
            f"affcli: {out}: cannot be written: Permission denied; name another file"
        )
        assert len(read_csv(shown.out)) == len(listed(learned))
        assert names_in(Path(name)) == ["kept.db"]


def test_without_pyarrow_parquet_alone_is_missed(learned: Path, tmp_path: Path) -> None:
    export = ("table", "export", "--db", learned, "--out")
    for args in (("rows.parquet",), ("rows.csv", "--format", "parquet"), ("-", "--format=parquet")):
        assert without("pyarrow", *export, *args) == Ended(2, "", INSTALL)
    ended = without("pyarrow", *export, tmp_path / "rows.csv")
    assert ended.code == 0
    assert len(read_csv(read_bytes_as_text(tmp_path / "rows.csv"))) == len(listed(learned))


TEXT = ("tool", "binding_behavior", "binding_params", "exploratory_behavior", "exploratory_params")


@pytest.mark.fault(32)
@pytest.mark.parametrize("text", EVIL.values(), ids=EVIL.keys())
def test_words_in_the_database_come_out_inert_and_whole(
    text: str, learned: Path, tmp_path: Path
) -> None:
    """In CSV behind an apostrophe where a spreadsheet would execute them, elsewhere as they are."""
    for column in TEXT:
        tamper(learned, f"UPDATE affordance SET {column} = ?", text)
    export = ("table", "export", "--run", "1", "--db", learned, "--out")
    done(*export, tmp_path / "rows.csv")
    for row in read_csv(read_bytes_as_text(tmp_path / "rows.csv")):
        for column in TEXT:
            assert row[column] in (text, f"'{text}")
            assert row[column][0] not in "=+-@\t\r"
            assert row[column].lstrip("\x00\u202e \r\n")[0] not in "=+-@" or text[0] == "\u202e"
        assert float(row["direction"]) >= 0.0
    for row in json.loads(exported(learned, "--run", "1", "--limit", "3", "--format", "json")):
        assert {row[column] for column in TEXT} == {text}
    path = tmp_path / "rows.parquet"
    done(*export, path)
    for column in TEXT:
        assert set(pq.read_table(path)[column].to_pylist()) == {text}


@pytest.mark.parametrize("form", ["csv", "json", "parquet"])
def test_what_affcli_did_not_write_is_named(form: str, learned: Path, tmp_path: Path) -> None:
    export = ("table", "export", "--db", learned, "--out", tmp_path / f"rows.{form}")
    tamper(learned, "UPDATE affordance SET exploratory_params = CAST(x'41ff' AS TEXT)")
    assert "holds text that is none and that affcli did not write" in refused(3, *export)
    assert names_in(tmp_path) == [learned.name]


@pytest.mark.fault(33)
def test_a_number_that_is_not_finite_is_null_in_json_alone(learned: Path, tmp_path: Path) -> None:
    tamper(learned, "UPDATE affordance SET start_object_z = 9e999, end_object_z = -9e999")
    (row,) = json.loads(exported(learned, "--limit", "1", "--format", "json"))
    assert (row["start_object_z"], row["end_object_z"]) == (None, None)
    (line,) = read_csv(exported(learned, "--limit", "1"))
    assert (line["start_object_z"], line["end_object_z"]) == ("inf", "-inf")
    path = tmp_path / "rows.parquet"
    done("table", "export", "--limit", "1", "--out", path, "--db", learned)
    assert pq.read_table(path)["end_object_z"].to_pylist() == [-float("inf")]


@pytest.mark.fault(32)
def test_sql_as_csv(learned: Path) -> None:
    query = """select 1 as a, -2.5 as b, 'x,"y"' as c, null as d, x'00ff' as e, 9e999 as f,
        '=1+1' as g, '-1' as '=h', '' as i, char(10) || 'ä' as j, 0.1 + 0.2 as k, 7 as a"""
    out = done("sql", query, "--csv", "--db", learned).out
    ((headings, values),) = [csv.reader(io.StringIO(out, newline=""), strict=True)]
    assert headings == ["a", "b", "c", "d", "e", "f", "g", "'=h", "i", "j", "k", "a 2"]
    assert values == [
        *("1", "-2.5", 'x,"y"', "", "00ff", "inf", "'=1+1", "'-1", "", "'\nä"),
        *("0.30000000000000004", "7"),
    ]


def test_sql_as_csv_says_what_else_there_is_to_say(learned: Path) -> None:
    many = "with recursive c(n) as (select 1 union all select n + 1 from c) select n from c"
    ended = done("sql", many, "--csv", "--db", learned)
    assert [int(row["n"]) for row in read_csv(ended.out)] == list(range(1, 10_001))
    assert ended.err == "only the first 10000 rows are shown; add a limit or a where\n"
    ended = done("sql", "select tool from trial", "--csv", "--db", learned)
    assert (ended.out, ended.err) == ("tool\n", "no rows\n")
    line = refused(2, "sql", "select 1", "--csv", "--json", "--db", learned)
    assert line == "affcli: give --json or --csv, not both"


@pytest.mark.fault(21)
def test_a_terminal_gets_no_command_of_the_data(learned: Path, tmp_path: Path) -> None:
    """A file gets the data as they are."""
    query = "select 'red' || char(27) || '[31m' || char(13) || 'x' || char(7) as a"
    for args in (("sql", query, "--csv"), ("table", "export", "--limit", "1")):
        tamper(learned, "UPDATE affordance SET tool = 'red\x1b[31m\rx\x07'")
        code, shown = on_terminal(*args, "--db", learned)
        assert code == 0
        assert all(line.isprintable() for line in shown.splitlines())
        assert r"red\x1b[31m\rx\x07" in shown
        on_terminal(*args, "--db", learned, results_to=tmp_path / "out.csv")
        assert b"red\x1b[31m\rx\x07" in (tmp_path / "out.csv").read_bytes()
