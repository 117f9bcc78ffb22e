"""A table that is aligned lines in a file and a table of its own on a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.console import Console
from rich.table import Table


@dataclass(frozen=True)
class TextTable:
    """Columns of words, all but the first aligned to the right, under a title."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def text(self) -> str:
        lines = [self.columns, *self.rows]
        widths = [max(len(line[place]) for line in lines) for place in range(len(self.columns))]
        return "\n".join([self.title, *("  ".join(
            [line[0].ljust(widths[0]),
             *(word.rjust(width) for word, width in zip(line[1:], widths[1:], strict=True))]
        ).rstrip() for line in lines)])

    def print(self) -> None:
        """On a terminal: headings wrap at their words, figures never; wider than it if need be."""
        table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
        widths = [max([*map(len, self.columns[place].split()), *(len(row[place])
                                                                 for row in self.rows)])
                  for place in range(len(self.columns))]
        for place, (column, width) in enumerate(zip(self.columns, widths, strict=True)):
            table.add_column(column, style="bold" if place == 0 else None, width=width,
                             justify="right" if place else "left", vertical="bottom")
        for row in self.rows:
            table.add_row(*row)
        wanted = sum(widths) + 2 * len(widths)
        Console(width=max(wanted, Console().width)).print(table)


def tables_text(headline: Sequence[str], tables: Sequence[TextTable],
                remarks: Sequence[str] = ()) -> str:
    """Lines, tables and further lines as plain text, the columns aligned."""
    return "\n\n".join(["\n".join(headline), *(table.text() for table in tables),
                        *(["\n".join(remarks)] if remarks else [])])


def print_tables(headline: Sequence[str], tables: Sequence[TextTable],
                 remarks: Sequence[str] = ()) -> None:
    """The same on the terminal."""
    console = Console()

    def say(lines: Sequence[str]) -> None:
        for line in lines:
            console.print(line, highlight=False, soft_wrap=True)

    say(headline)
    for table in tables:
        say([f"\n{table.title}"])
        table.print()
    if remarks:
        console.print()
        say(remarks)
