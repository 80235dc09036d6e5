"""A table that stays readable at any width: columns while they fit, records when they do not."""

from dataclasses import dataclass, field

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

from affcli.errors import one_line

GAP = 2
"""Blanks between two columns."""
LONGEST = 1_000_000
"""Letters of a cell."""


@dataclass(slots=True)
class Sheet:
    """Rows under headings.

    Where the columns do not fit even with words wrapped, each row becomes a record, one heading and
    value a line. Nothing is ever cut off; what is not printable is shown escaped.

    Args:
        columns: the headings.
        title, caption: lines above and below; none if empty.
        left: headings of columns of words, whose cells may be wrapped; the others are of numbers
            and stand to the right.
        wraps: wrap cells and headings before rows become records.
        records: show records in any case.
        rows: the cells.
    """

    columns: tuple[str, ...]
    title: str = ""
    caption: str = ""
    left: tuple[str, ...] = ()
    wraps: bool = True
    records: bool = False
    rows: list[tuple[str | Text, ...]] = field(default_factory=list)

    def add(self, *cells: str | Text) -> None:
        """Add a row: one cell for each column."""
        self.rows.append(tuple(c if isinstance(c, Text) else one_line(c, LONGEST) for c in cells))

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Draw for the width there is."""
        if self.title:
            yield Text(one_line(self.title, LONGEST), style="bold")
        widths = None if self.records else self._widths(options.max_width)
        if widths is not None:
            yield self._in_columns(widths)
        else:
            for number, row in enumerate(self.rows):
                if number:
                    yield ""
                yield self._record(row, options.max_width)
        if self.caption:
            lines = (one_line(line, LONGEST) for line in self.caption.split("\n"))
            yield Text("\n".join(lines), style="dim")

    def _widths(self, available: int) -> list[int] | None:
        """Return the columns' widths; None when there is no room for them."""
        room = available - GAP * (len(self.columns) - 1)
        widths, least = [], []
        for heading, *cells in zip(self.columns, *self.rows, strict=True):
            widest = max(map(_width, cells), default=0)
            words = max(map(_longest_word, cells), default=0) if heading in self.left else widest
            widths.append(max(_width(heading), widest))
            least.append(max(_longest_word(heading), words))
        if sum(least if self.wraps else widths) > room:
            return None
        while sum(widths) > room:
            # The widest of those that may still become narrower gives way.
            _, giving = max((width, i) for i, width in enumerate(widths) if width > least[i])
            widths[giving] -= 1
        return widths

    def _in_columns(self, widths: list[int]) -> Table:
        """Return the rows under their headings."""
        # The box puts one blank between columns, the padding the rest of the gap.
        table = Table(box=box.SIMPLE_HEAD, show_edge=False, padding=(0, GAP - 1, 0, 0))
        table.pad_edge = False
        for heading, width in zip(self.columns, widths, strict=True):
            justify = "left" if heading in self.left else "right"
            # Folded, where a word of double-width letters comes out a column too wide.
            table.add_column(heading, justify=justify, overflow="fold")  # type: ignore[arg-type]
            table.columns[-1].width = width
        for row in self.rows:
            table.add_row(*map(_text, row))
        return table

    def _record(self, row: tuple[str | Text, ...], available: int) -> Table:
        """Return one row as a list of headings and values."""
        longest = max(map(cell_len, self.columns), default=0)
        grid = Table.grid(padding=(0, GAP, 0, 0), pad_edge=False)
        grid.add_column(overflow="fold", width=min(longest, available // 2), style="bold")
        grid.add_column(overflow="fold")
        for heading, cell in zip(self.columns, row, strict=True):
            grid.add_row(Text(heading), _text(cell))
        return grid


def _text(cell: str | Text) -> Text:
    """Return a cell as text without markup."""
    return Text(cell) if isinstance(cell, str) else cell


def _width(cell: str | Text) -> int:
    """Return the width of a cell on one line."""
    return cell_len(str(cell))


def _longest_word(cell: str | Text) -> int:
    """Return the width of the longest word in a cell."""
    return max(map(cell_len, str(cell).split()), default=0)
