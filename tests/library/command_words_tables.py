"""The tables of ``docs/command-words.md``, for tests that hold code to them."""

from pathlib import Path

DOCUMENT = Path(__file__).parents[2] / "docs" / "command-words.md"
NOTHING = "\N{EN DASH}"  # an empty cell


def tables():
    """Header → list of rows, each a dict; cells without their code marks."""
    found, lines = {}, []
    for line in [*DOCUMENT.read_text(encoding="utf-8").splitlines(), ""]:
        if line.startswith("|"):
            lines.append([cell.strip().replace("`", "") for cell in line.strip("|").split("|")])
        elif lines:
            header, _, *rows = lines
            found[tuple(header)] = [dict(zip(header, row, strict=True)) for row in rows]
            lines = []
    return found


TABLES = tables()


def table(*columns):
    """The one table that has these columns."""
    (rows,) = [rows for header, rows in TABLES.items() if set(columns) <= set(header)]
    return rows
