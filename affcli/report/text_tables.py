"""Tables for a paper: Markdown and LaTeX."""

import re
from collections.abc import Sequence

from affcli.report.sheet import Sheet

_LATEX = {
    **{mark: f"\\{mark}" for mark in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "\\": r"\textbackslash{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
}


def markdown(tables: Sequence[Sheet]) -> str:
    """Return tables as GitHub's Markdown: title, table, caption."""
    return "\n".join(
        "\n\n".join(filter(None, (_bold(one.title), _rows(one), _marked(one.caption)))) + "\n"
        for one in tables
    )


def _bold(title: str) -> str:
    """Return a title in bold letters."""
    return f"**{_marked(title)}**" if title else ""


def _marked(text: str) -> str:
    """Return text in which nothing is a mark of Markdown."""
    return re.sub(r"([\\`*_\[\]|<>])", r"\\\1", text).replace("\n", "  \n")


def _rows(table: Sheet) -> str:
    """Return the rows under their headings; numbers stand to the right."""
    rule = ["---" if heading in table.left else "---:" for heading in table.columns]
    cells = [[_marked(str(cell).strip()) for cell in row] for row in (table.columns, *table.rows)]
    return "\n".join(f"| {' | '.join(row)} |" for row in (cells[0], rule, *cells[1:]))


def latex(tables: Sequence[Sheet]) -> str:
    """Return tables as LaTeX, each a ``table`` that needs no package."""
    return "\n".join(map(_latex_table, tables))


def _latex_table(table: Sheet) -> str:
    """Return one table."""
    rows = [" & ".join(_escaped(str(cell).strip()) for cell in row) for row in table.rows]
    letters = "".join("l" if heading in table.left else "r" for heading in table.columns)
    words = ". ".join(filter(None, (table.title, table.caption.replace("\n", ". "))))
    lines = [
        "\\begin{table}",
        *([f"\\caption{{{_escaped(words)}.}}"] if words else []),
        f"\\begin{{tabular}}{{{letters}}}",
        "\\hline",
        " & ".join(map(_escaped, table.columns)) + r" \\",
        "\\hline",
        *(f"{row} \\\\" for row in rows),
        "\\hline",
        "\\end{tabular}",
        "\\end{table}",
    ]
    return "\n".join(lines) + "\n"


def _escaped(text: str) -> str:
    """Return text in which nothing is a command of LaTeX."""
    return "".join(_LATEX.get(letter, letter) for letter in text)
