"""Whatever is written on the command line is done or refused: no traceback, no abort, no harm."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import strategies as st

from tests.cli.forked import Forked
from tests.fuzz.commands import CommandLine, command_lines
from tests.fuzz.conftest import Fuzz
from tests.fuzz.running import check_ending, check_json, files_in, is_sound
from tests.states.commands import ALWAYS_WRITE

DATABASES = ("filled.db", "empty.db")
PLACES = ("--db", "--out", "--html", "--gif", "--video")
"""Options that name a file that may be written."""


def writes(line: CommandLine) -> bool:
    """Tell whether a command may change the database it is given."""
    return line.command.name in ALWAYS_WRITE - {"db backup"} or "--update" in line.args


def named_places(line: CommandLine, home: Path) -> list[str]:
    """Return the files that a command line names, by their whole paths."""
    named = [value for _, value in line.env] + ["affcli.db"]
    makes = line.command.words[:1] == ("new",)  # a file, or the folder of a package
    if makes:
        slugs = [arg.replace(" ", "-") for arg in line.args]
        named += [*slugs, *(f"{slug}.toml" for slug in slugs)]
    for at, arg in enumerate(line.args):
        option, _, value = arg.partition("=")
        if option in PLACES:
            named.append(value or next(iter(line.args[at + 1 :]), ""))
    places = [os.path.normpath(os.path.join(home, name)) for name in named]  # noqa: PTH118
    folders = [
        Path(place) for place in places if makes and Path(place) not in {home, *home.parents}
    ]
    return [*places, *(str(file) for folder in folders for file in folder.rglob("*"))]


def came_of(made: str, named: list[str]) -> bool:
    """Tell whether a file is one that was named, or a database's journal or copy."""
    return any(
        made == name or made in {f"{name}-wal", f"{name}-shm", f"{name}-journal", f"{name}.backup"}
        for name in named
    )


@pytest.mark.torture
@pytest.mark.fault(20)
@pytest.mark.fault(21)
@pytest.mark.fault(22)
def test_every_command_line_is_done_or_refused_and_harms_nothing(
    program: Forked, place: Callable[[], Path], fuzzing: Fuzz
) -> None:
    def check(line: CommandLine) -> None:
        home = place()
        outside = home.parents[1]
        before = {name: (home / name).read_bytes() for name in DATABASES}
        there = files_in(outside)
        env = {"TMPDIR": str(outside / "temporary"), **dict(line.env)}
        ended = program.run([*line.command.words, *line.args], home, env=env)
        check_ending(line.command.name, ended)
        named = named_places(line, home)
        for made in files_in(outside) - there:
            path = os.path.join(outside, made)  # noqa: PTH118 names of any bytes
            assert came_of(os.path.normpath(path), named), made
        for name, bytes_before in before.items():
            if "--force" in line.args:
                continue
            if writes(line):
                assert is_sound(home / name)
            else:
                assert (home / name).read_bytes() == bytes_before, name
        # `learn --json --help`, and a path that is named like the option.
        if ended.code in {0, 1} and line.args.count("--json") == 1 and ended.out[:1] in b"[{":
            check_json(ended)

    fuzzing("command lines", check, command_lines(), few=40, share=0.3)


WORDS = (
    *("select", "select * from", "from", "where", "with recursive t(n) as", "union all", "values"),
    *("(select 1 union all select n + 1 from t)", "t", "(", ")", ",", ";", "*", "order by 1"),
    *("affordance", "affordance_table", "sqlite_master", "step", "learning_run", "pragma"),
    *("pragma_table_info('step')", "attach 'x.db' as x", "vacuum into 'x.db'", "begin", "commit"),
    *("drop table step", "delete from step", "update step set number = 1", "insert into step"),
    *("create table x (y)", "create temp table x as", "pragma writable_schema = 1", "explain"),
    *("load_extension('x')", "readfile('/etc/passwd')", "randomblob(1000000000)", "zeroblob(1e9)"),
    *("hex(zeroblob(90000))", "printf('%.*c', 1000000000, 'x')", "group_concat(step)", "'", '"'),
    *("replace(hex(zeroblob(1e5)), '0', hex(zeroblob(1e5)))", "like", "glob", "'%%%%%%%%x'", "--"),
    *("/*", "*/", "x'ff'", "cast(x'ff' as text)", "1e999", "-1e999", "null", "9223372036854775808"),
    *("json_extract('[', '$')", "json_each('[1,2]')", "fts3_tokenizer('x')", "sum(1)", "1/0", "?"),
    *(":x", "$y", "@z", "limit -1", "collate x", "in", "case when 1 then 2 end", "as [/]", "abs"),
)
"""Pieces of SQL, some of which would write, read other files, or never end."""

queries = st.one_of(
    st.lists(st.sampled_from(WORDS), min_size=1, max_size=8).map(" ".join),
    st.sampled_from(WORDS).map(lambda word: f"select {word}"),
    st.sampled_from(WORDS).map(lambda word: f"select * from {word}"),
    st.text(max_size=60).map(lambda text: text.replace("\0", "")).filter(str.isprintable),
)


@pytest.mark.torture
@pytest.mark.fault(30)
@pytest.mark.fault(22)
def test_every_query_is_answered_or_refused_and_changes_nothing(
    program: Forked, place: Callable[[], Path], fuzzing: Fuzz
) -> None:
    home = place()
    before, there = (home / "filled.db").read_bytes(), files_in(home.parents[1])

    def check(case: tuple[str, str]) -> None:
        query, form = case
        ended = program.run(["sql", f"--{form}", "--db", "filled.db", "--", query], home)
        check_ending("sql", ended)
        assert not ended.stopped, query
        if ended.code == 0 and form == "json":
            check_json(ended)
        assert (home / "filled.db").read_bytes() == before
        assert files_in(home.parents[1]) == there

    cases = st.tuples(queries, st.sampled_from(("json", "csv")))
    fuzzing("queries", check, cases, few=30, share=0.1)
