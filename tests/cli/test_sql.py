"""``affcli sql``: one question, read-only for certain, and an answer that is safe to read."""

import time
from pathlib import Path

import pytest

from tests.cli.program import done, names_in, refused

FORBIDDEN = {
    "insert": "insert into trial select * from trial",
    "update": "update affordance set times_used = 9",
    "delete": "delete from affordance",
    "replace": "replace into session select * from session",
    "drop": "drop table affordance",
    "create": "create table mine (x)",
    "temporary": "create temp table mine (x)",
    "as select": "create table mine as select 1",
    "alter": "alter table trial add column mine",
    "attach": "attach 'other.db' as other",
    "attach as select": "attach ':memory:' as other",
    "vacuum": "vacuum",
    "vacuum into": "vacuum into 'other.db'",
    "pragma": "pragma user_version = 7",
    "reading pragma": "pragma table_info(trial)",
    "pragma function": "select * from pragma_table_info('trial')",
    "begin": "begin immediate",
    "reindex": "reindex",
    "analyze": "analyze",
    "returning": "delete from step returning *",
    "in a with": "with x as (select 1) delete from step",
    "load": "select load_extension('evil')",
    "two": "select 1; delete from step",
    "two selects": "select 1; select 2",
    "nothing": "",
    "a remark": "/* select 1 */",
    "a semicolon": ";",
    "no SQL": "how many rows are there?",
    "half": "select 'x",
    "unknown table": "select * from tools",
    "unknown column": "select colour from affordance",
    "unknown function": "select sum_of_all_fears(1)",
    "10 kB of brackets": "select " + "(" * 5000 + "1" + ")" * 5000,
    "200 kB": "select 1 -- " + "x" * 200_000,
    "escape sequence": "select \x1b[31m",
    "no character": b"select '\xff'",
}


@pytest.mark.fault(30)
@pytest.mark.parametrize("query", FORBIDDEN.values(), ids=FORBIDDEN.keys())
def test_all_but_one_select_is_refused(query: str | bytes, learned: Path) -> None:
    before = learned.read_bytes()
    refused(4, "sql", query, "--db", learned, cwd=learned.parent)
    assert learned.read_bytes() == before
    assert names_in(learned.parent) == [learned.name]


ENDLESS = {
    "counting": "with recursive c(n) as (select 1 union all select n + 1 from c) "
    "select count(*) from c",
    "joining": "select count(*) from behavior a, behavior b, behavior c, behavior d",
    "rows without end": "with recursive c(n) as (select 1 union all select n + 1 from c) "
    "select n from c where n < 0",
}


@pytest.mark.fault(30)
@pytest.mark.parametrize("query", ENDLESS.values(), ids=ENDLESS.keys())
def test_an_endless_query_is_stopped(query: str, learned: Path) -> None:
    began = time.monotonic()
    line = refused(4, "sql", query, "--db", learned)
    assert time.monotonic() - began < 10.0  # five times what a person is promised
    assert line.endswith("sql: stopped after 2 s; ask for less (where, limit)")


@pytest.mark.fault(30)
@pytest.mark.parametrize("query", ["select zeroblob(1000000000)", "select hex(zeroblob(900000))"])
def test_a_huge_value_is_refused(query: str, learned: Path) -> None:
    assert "sql: a value of more than " in refused(4, "sql", query, "--db", learned)


def test_of_very_many_rows_the_first_are_shown(learned: Path) -> None:
    query = "with recursive c(n) as (select 1 union all select n + 1 from c) select n from c"
    ended = done("sql", query, "--json", "--db", learned)
    assert [row["n"] for row in ended.results] == list(range(1, 10_001))
    assert ended.err == "only the first 10000 rows are shown; add a limit or a where\n"


@pytest.mark.fault(33)
def test_json_of_every_kind_of_value(learned: Path) -> None:
    query = """select 1 as a, 2.5 as b, 'x' as c, null as d, x'00ff' as e, 9e999 as f, -9e999 as g,
        9e999 - 9e999 as h, 9223372036854775807 as i, char(27, 0, 10) as j, 'ä' as k"""
    (row,) = done("sql", query, "--json", "--db", learned).results
    values = [1, 2.5, "x", None, "00ff", None, None, None, str(2**63 - 1), "\x1b\x00\n", "ä"]
    assert row == dict(zip("abcdefghijk", values, strict=True))


def test_columns_of_one_name_are_told_apart(learned: Path) -> None:
    query = "select 1 as a, 2 as a, 3 as 'a 2', 4 as a"
    (row,) = done("sql", query, "--json", "--db", learned).results
    assert row == {"a": 1, "a 2": 2, "a 2 2": 3, "a 3": 4}


@pytest.mark.fault(21)
def test_control_characters_are_shown_escaped(learned: Path) -> None:
    query = """select 'red' || char(27) || '[31m' as a, 'x' || char(0) || 'y' as b,
        'one' || char(10) || 'two' as 'c\x1b[0m\n', '[/]' as d, char(8238) || 'x' as e,
        cast(x'ff' as text) as f"""
    for columns in ("200", "40"):
        out = done("sql", query, "--db", learned, COLUMNS=columns).out
        assert all(line.isprintable() for line in out.splitlines())
        for shown in (r"red\x1b[31m", r"x\x00y", r"one\ntwo", "[/]", r"\u202ex", "\ufffd"):
            assert shown in out
        assert r"c\x1b[0m\n" in out


def test_a_table_becomes_records_where_it_does_not_fit(learned: Path) -> None:
    """The view has more columns than a screen; nothing of it is cut off."""
    query = "select * from affordance_table order by id limit 2"
    first, second = done("sql", query, "--json", "--db", learned).results
    for columns in (80, 40):
        out = done("sql", query, "--db", learned, COLUMNS=str(columns)).out
        assert max(map(len, out.splitlines())) <= columns
        one, two = out.split("\n\n")
        for record, values in ((one, first), (two, second)):
            joined = "".join(record.split())
            for name, value in values.items():
                assert "".join(str(value).split()) in joined or columns < 80
                assert name in joined or columns < 80


def test_no_rows_are_said_to_be_none(learned: Path) -> None:
    ended = done("sql", "select tool from trial", "--db", learned)
    assert (ended.out.split()[0], ended.err) == ("tool", "no rows\n")
    ended = done("sql", "select tool from trial", "--json", "--db", learned)
    assert ended.results == []


@pytest.mark.parametrize("view", ["affordance_table", "affordance_wide"])
def test_the_views_can_be_read(view: str, learned: Path) -> None:
    ((count,),) = [row.values() for row in query(f"select count(*) from {view}", learned)]
    assert count == len(query(f"select * from {view}", learned)) > 0


def query(text: str, database: Path) -> list[dict[str, object]]:
    """Return the rows of a query."""
    value: list[dict[str, object]] = done("sql", text, "--json", "--db", database).results
    return value


@pytest.mark.fault(22)
def test_injection_is_inert(learned: Path) -> None:
    """A name made of SQL is a name, wherever it stands."""
    evil = "x'); DROP TABLE learning_run; --"
    for args in (
        ("learn", "--tool", evil),
        ("solve", "--goal", "1", "--tool", evil),
        ("solve", "--goal", "1", "--start", evil),
        ("break-tool", "--becomes", evil),
    ):
        refused(2, *args, "--db", learned)
    assert query("select count(*) as n from learning_run", learned) == [{"n": 2}]


def test_a_table_too_large_to_be_looked_at_is_drawn_in_part(learned: Path) -> None:
    wide = "select * from behavior a, behavior b limit 5000"
    drawn = done("sql", wide, "--db", learned, COLUMNS="40")
    assert drawn.out.count("step 2") == 312
    assert "only the first 312 rows are shown" in drawn.err
    assert "--json or --csv" in drawn.err
    assert done("sql", wide, "--csv", "--db", learned).out.count("\n") == 5001


def test_a_large_seed_is_the_same_in_json_and_csv(tmp_path: Path) -> None:
    """A reader that takes numbers for doubles would read another seed: another robot."""
    path, seed = tmp_path / "my.db", "9007199254740993"
    done("learn", "--tool", "stick", "--behaviors", "5", "--seed", seed, "--db", path)
    query = "select seed, robot from learning_run"
    assert done("sql", query, "--json", "--db", path).results == [{"seed": seed, "robot": 0}]
    assert f"{seed},0" in done("sql", query, "--csv", "--db", path).out
