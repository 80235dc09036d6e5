"""How many statements a package has, by room: what `python tests/statements.py` prints.

A statement is a node of the syntax tree that is an ``ast.stmt``, docstrings left out: so neither
comments nor the way a line is wrapped counts. ``affcli/testing`` is left out: it is there for
others' parts.
"""

import ast
import sys
from collections import Counter
from pathlib import Path

LEFT_OUT = "testing"


def statements(text: str) -> int:
    """Return the number of statements in a file of Python, without its docstrings."""
    return sum(
        isinstance(node, ast.stmt) and not _is_text(node) for node in ast.walk(ast.parse(text))
    )


def _is_text(node: ast.stmt) -> bool:
    """Tell whether a statement is a docstring: a text that stands for itself."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


def by_room(package: Path) -> dict[str, int]:
    """Return the statements of each room of a package; files beside the rooms are each one."""
    counted: Counter[str] = Counter()
    for path in sorted(package.rglob("*.py")):
        room = path.relative_to(package).parts[0]
        if room != LEFT_OUT:
            counted[room] += statements(path.read_text(encoding="utf-8"))
    return dict(counted)


if __name__ == "__main__":
    rooms = by_room(Path(sys.argv[1] if len(sys.argv) > 1 else "affcli"))
    lines = [f"{room:<16}{count:>6}" for room, count in rooms.items()]
    sys.stdout.write("\n".join([*lines, f"{'in all':<16}{sum(rooms.values()):>6}\n"]))
