"""Every fault of the list has a test that names it, and no test names another."""

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from tests.faults import FAULTS

TESTS = Path(__file__).parent


def marked(tree: ast.Module) -> Iterator[tuple[str, int]]:
    """Yield each test function of a file with the number of each fault that it is marked with."""
    for node in tree.body:
        if not isinstance(node, ast.FunctionDef) or not node.name.startswith("test_"):
            continue
        for decorator in node.decorator_list:
            match decorator:
                case ast.Call(
                    func=ast.Attribute(attr="fault", value=ast.Attribute(attr="mark")),
                    args=[ast.Constant(value=int(number))],
                ):
                    yield node.name, number


@cache
def named_by() -> dict[int, list[str]]:
    """Return the tests that name each fault."""
    found = defaultdict(list)
    for path in sorted(TESTS.rglob("test_*.py")):
        for name, number in marked(ast.parse(path.read_text(encoding="utf-8"))):
            found[number].append(f"{path.relative_to(TESTS)}::{name}")
    return found


def test_every_fault_has_a_test_that_names_it() -> None:
    assert not FAULTS.keys() - named_by().keys()


def test_no_test_names_a_fault_that_is_not_on_the_list() -> None:
    assert not named_by().keys() - FAULTS.keys()


def test_every_mark_is_found() -> None:
    """A mark that is written otherwise, or stands where pytest does not see it, would not count."""
    written = sum(
        line.lstrip().startswith("@pytest.mark.fault(")
        for path in TESTS.rglob("*.py")
        for line in path.read_text(encoding="utf-8").splitlines()
    )
    assert sum(map(len, named_by().values())) == written


def test_the_list_says_in_whole_sentences_what_must_happen() -> None:
    for words in FAULTS.values():
        assert words.endswith(".")
        assert ": " in words
