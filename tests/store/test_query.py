"""``affcli sql``: whatever a person writes, it reads, briefly, and nothing else (faults 22, 30)."""

import sqlite3
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from affcli.bounded import LARGEST_VALUE
from affcli.errors import BadInputError
from affcli.store import open_store, query, run_sql
from affcli.store.query import LARGEST_RESULT
from tests.store.records import learned

WRITES = [
    "INSERT INTO session VALUES (1, 2)",
    "UPDATE learning_run SET seed = 0",
    "DELETE FROM learning_run",
    "WITH x AS (SELECT 1) DELETE FROM learning_run",
    "REPLACE INTO alembic_version VALUES ('0002')",
    "DROP TABLE learning_run",
    "DROP VIEW affordance_table",
    "CREATE TABLE t (x)",
    "CREATE TEMP TABLE t (x)",
    "CREATE VIRTUAL TABLE t USING fts5(x)",
    "ALTER TABLE learning_run RENAME TO t",
    "REINDEX",
    "ANALYZE",
    "VACUUM",
    "VACUUM INTO 'stolen.db'",
    "ATTACH 'other.db' AS other",
    "DETACH main",
    "PRAGMA user_version = 5",
    "PRAGMA writable_schema = ON",
    "PRAGMA query_only = OFF",
    "PRAGMA table_info(session)",
    "SELECT * FROM pragma_table_info('session')",
    "BEGIN IMMEDIATE",
    "SAVEPOINT s",
    "COMMIT",
    "SELECT load_extension('evil')",
    "SELECT 1; DROP TABLE learning_run",
    "x'); DROP TABLE learning_run; --",
    "SELECT fts3_tokenizer('simple', x'00')",
]

GENEROUS = 10.0
"""Seconds: five times what a person is promised."""

FOREVER = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) "

ENDLESS = [
    FOREVER + "SELECT count(*) FROM c",
    FOREVER + "SELECT x FROM c ORDER BY -x",
    "WITH RECURSIVE c(x) AS (SELECT 1 UNION SELECT x + 1 FROM c) SELECT max(x) FROM c",
    "SELECT count(*) FROM " + ", ".join(f"behavior b{i}" for i in range(8)),
    "WITH RECURSIVE c(x) AS (SELECT 'a' UNION ALL SELECT x || x FROM c) SELECT length(x) FROM c",
    FOREVER + "SELECT length(group_concat(x)) FROM c",
    FOREVER + "SELECT randomblob(90000) FROM c",
    FOREVER + "SELECT max(instr(hex(zeroblob(40000)), hex(zeroblob(20000)) || x)) FROM c",
]

HUGE = [
    "SELECT zeroblob(2000000000)",
    "SELECT randomblob(2000000000)",
    "SELECT hex(zeroblob(900000))",
    "SELECT printf('%2000000000d', 1)",
    "SELECT replace(zeroblob(900000), x'00', 'aaaaaaaaaa')",
    "SELECT '" + "a" * 2_000_000 + "'",
    "SELECT 1 WHERE 'a' LIKE '" + "%a" * 20_000 + "'",
    "SELECT " + "(" * 5_000 + "1" + ")" * 5_000,
    "SELECT " + "+".join(["1"] * 5_000),
    " UNION ALL ".join(["SELECT 1"] * 2_000),
]


@pytest.fixture
def filled(database: Path) -> Path:
    """A database with one learning run."""
    with open_store(database, create=False, write=True) as store:
        learned(store, 60)
    return database


def outcome(path: Path, text: str, max_seconds: float) -> str:
    """Run a query; say whether it was refused in one line, cut off, or gave a small result."""
    try:
        result = run_sql(path, text, max_seconds=max_seconds)
    except BadInputError as error:
        return "refused" if str(error).isprintable() else "more than one line"
    if result.truncated:
        return "truncated"
    size = sum(len(str(value)) for row in result.rows for value in row)
    return "small" if size < LARGEST_VALUE else "large"


@pytest.mark.fault(22)
@pytest.mark.fault(30)
@pytest.mark.parametrize("text", WRITES)
def test_only_reading_is_allowed(text: str, filled: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(filled.parent)
    before = filled.read_bytes()
    with pytest.raises(BadInputError) as caught:
        run_sql(filled, text)
    assert str(caught.value).isprintable()
    assert filled.read_bytes() == before
    assert [path.name for path in filled.parent.iterdir()] == [filled.name]


@pytest.mark.fault(30)
@pytest.mark.parametrize("text", ENDLESS)
def test_what_would_not_end_is_stopped(text: str, filled: Path) -> None:
    began = time.monotonic()
    assert outcome(filled, text, max_seconds=0.3) in ("refused", "truncated")
    assert time.monotonic() - began < GENEROUS


@pytest.mark.fault(30)
@pytest.mark.parametrize("text", HUGE)
def test_what_is_too_large_is_refused(text: str, filled: Path) -> None:
    began = time.monotonic()
    assert outcome(filled, text, max_seconds=2.0) in ("refused", "small")
    assert time.monotonic() - began < GENEROUS


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "nothing to run"),
        ("-- only a remark", "nothing to run"),
        ("selekt 1", 'near "selekt": syntax error'),
        ("SELECT x FROM nowhere", "no such table: nowhere"),
        ("SELECT missing FROM session", "no such column: missing"),
        ("SELECT ?", "give one SELECT"),
        ("SELECT 1; SELECT 2", "one statement"),
        ("SELECT 1\0", "give one SELECT"),
        ("SELECT '\ud800'", "give one SELECT"),
        ("SELECT " + "x" * 300, r"\.\.\.$"),
    ],
)
def test_mistakes_are_explained_in_one_line(text: str, words: str, filled: Path) -> None:
    with pytest.raises(BadInputError, match=words) as caught:
        run_sql(filled, text)
    assert str(caught.value).isprintable()


def test_columns_rows_and_types(filled: Path) -> None:
    result = run_sql(
        filled, "SELECT 1 AS one, 2.5, NULL, 'text', x'00ff' UNION ALL VALUES (2, 3, 4, 5, 6)"
    )
    assert result.columns[:2] == ("one", "2.5")
    assert result.rows == ((1, 2.5, None, "text", b"\x00\xff"), (2, 3, 4, 5, 6))
    assert not result.truncated
    assert run_sql(filled, "SELECT * FROM session").columns[0] == "id"
    assert run_sql(filled, "EXPLAIN QUERY PLAN SELECT 1").rows


def test_no_more_rows_than_asked_for(filled: Path) -> None:
    everything = run_sql(filled, "SELECT step FROM behavior", max_rows=60)
    assert (len(everything.rows), everything.truncated) == (60, False)
    some = run_sql(filled, "SELECT step FROM behavior", max_rows=59)
    assert (some.rows, some.truncated) == (everything.rows[:59], True)
    assert run_sql(filled, "SELECT 1 WHERE 0").rows == ()


def test_a_result_has_a_largest_size(filled: Path) -> None:
    result = run_sql(
        filled, f"SELECT zeroblob({LARGEST_VALUE - 100}) FROM behavior a, behavior b LIMIT 2000"
    )
    assert result.truncated
    assert len(result.rows) == LARGEST_RESULT // (LARGEST_VALUE - 100)


def test_text_that_is_no_text_is_shown(filled: Path) -> None:
    assert run_sql(filled, "SELECT CAST(x'ff41' AS TEXT)").rows == (("\ufffdA",),)


@pytest.mark.fault(30)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(
    st.text() | st.lists(st.sampled_from([*WRITES, "SELECT", ";", "(", "'", "--"])).map(" ".join)
)
def test_any_text_gives_rows_or_one_line(filled: Path, text: str) -> None:
    """Nothing a person can type ends in a traceback, or changes the file."""
    before = filled.stat().st_mtime_ns
    assert outcome(filled, text, max_seconds=0.5) in ("refused", "truncated", "small")
    assert filled.stat().st_mtime_ns == before


@pytest.mark.parametrize("name", ["load_extension", "fts3_tokenizer", "readfile", "writefile"])
def test_a_function_that_reaches_beyond_the_file_is_denied_where_sqlite_has_it(name: str) -> None:
    """Python's has none of them; another build may."""
    denied = query._judge(sqlite3.SQLITE_FUNCTION, None, name, None, None)
    assert denied == sqlite3.SQLITE_DENY
    allowed = query._judge(sqlite3.SQLITE_FUNCTION, None, "count", None, None)
    assert allowed == sqlite3.SQLITE_OK
