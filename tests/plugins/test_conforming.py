"""``affcli check --part``: a part is held to the contract of its kind, by its name."""

import pytest

from affcli.core.part import Kind
from affcli.lab import conforming
from tests.cli.program import affcli, done, refused
from tests.plugins.conftest import Install
from tests.plugins.test_shop import NAMES, PACKAGE


@pytest.mark.usefixtures("shop")
@pytest.mark.parametrize("kind", [one for one in NAMES if one != "worlds"])
def test_a_part_of_a_package_keeps_its_contract(kind: Kind) -> None:
    ended = done("check", "--part", kind.removesuffix("s"), "--name", NAMES[kind], "--json")
    assert ended.result["kind"] == kind.removesuffix("s")
    assert f"@{PACKAGE}" in ended.result["part"]
    assert {one["outcome"] for one in ended.result["tests"]} == {"passed"}
    assert len(ended.result["tests"]) >= 5


@pytest.mark.usefixtures("shop")
def test_a_world_of_a_package_keeps_its_contract_with_all_that_stands_in_it() -> None:
    ended = done("check", "--part", "world", "--name", "yard", "--json")
    said = {one["test"]: one["outcome"] for one in ended.result["tests"]}
    assert set(said.values()) == {"passed"}
    assert "binding takes the tool and time" in said
    assert "learning twice gives the same" in said


@pytest.mark.parametrize(
    ("kind", "name", "tests"),
    [("binding", "grasp:angle=20", 5), ("task", "anywhere:n=3", 7), ("sensor", "exact", 7)],
)
def test_ours_can_be_checked_too_with_parameters(kind: str, name: str, tests: int) -> None:
    shown = done("check", "--part", kind, "--name", name).out
    assert shown.split()[:2] == [kind, name]
    assert f"{tests} of {tests} tests passed, 0 failed" in shown


def test_a_test_that_failed_often_is_one_line(install: Install) -> None:
    text = PLANNER.format(does="return Choice(0, ())")
    install("bad_one", text, {"planners": {"mine": "bad_one:MINE"}})
    shown = affcli("check", "--part", "planner", "--name", "mine", COLUMNS="200")
    assert shown.code == 1
    assert "4 times: AssertionError: assert 0 is None" in shown.out
    assert "53 of 81 tests passed, 28 failed" in shown.out


PLANNER = """
import os, time
from affcli.core.choice import Choice
from affcli.core.part import Part
from affcli.planning.nested_query import NestedQuery

class Bad(NestedQuery):
    def choose(self, situation):
        {does}

MINE = Part("planners", "mine", "mine", "a test", Bad)
"""


@pytest.mark.parametrize(
    ("does", "test", "why"),
    [
        ("1 / 0", "with rows that can be used one is chosen", "ZeroDivisionError: division"),
        ("os.abort()", "the row chosen is of the table", "the process ended (signal 6)"),
        ("time.sleep(99)", "the row chosen is of the table", "no end within 2 s"),
    ],
)
def test_a_part_that_breaks_its_contract_is_told_where(
    does: str, test: str, why: str, install: Install, monkeypatch: pytest.MonkeyPatch
) -> None:
    if "sleep" in does:
        monkeypatch.setattr(conforming, "LONGEST_TEST", 2.0)
    install("bad_one", PLANNER.format(does=does), {"planners": {"mine": "bad_one:MINE"}})
    ended = affcli("check", "--part", "planner", "--name", "mine", "--json")
    assert ended.code == 1
    failed = [one for one in ended.result["tests"] if one["outcome"] == "failed"]
    assert any(test in one["test"] and why in one["why"] for one in failed)


@pytest.mark.parametrize(
    ("code", "words", "says"),
    [
        (2, (), "give a file, or --part KIND with --name NAME"),
        (2, ("a.toml", "--part", "planner", "--name", "x"), "give a file, or --part KIND"),
        (2, ("--part", "planner"), "give a file, or --part KIND"),
        (2, ("--name", "nested-query"), "give a file, or --part KIND"),
        (2, ("--part", "planer", "--name", "x"), "did you mean planner"),
        (2, ("--part", "planner", "--name", "nested-quer"), "did you mean nested-query"),
        (2, ("--part", "planner", "--name", "nested-query", "--out", "a.png"), "leave out --out"),
    ],
)
def test_what_does_not_go_together_is_refused(code: int, words: tuple[str, ...], says: str) -> None:
    assert says in refused(code, "check", *words)
