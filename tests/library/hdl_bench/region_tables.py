"""What becomes of the tables that a host sends: by the words of ``docs/command-words.md``."""

from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode
from cardcage.testbenches.frames.heard_tables import HeardTables

from .bench import Agent

#: By the words of ``docs/command-words.md``.
Tables = HeardTables


def region_word(configuration, region, element):
    """A ``REGION`` command; ``region``: its number, or column and row."""
    columns = configuration.dealt_regions.columns
    column, row = region if isinstance(region, tuple) else (region % columns, region // columns)
    return commands.command(Opcode.REGION, commands.pack(
        commands.region_layout(configuration), {"column": column, "row": row, "element": element}))


def table_words(configuration, table):
    return [region_word(configuration, region, int(element))
            for region, element in enumerate(table)]


class RegionLinesWatch(Agent):
    """Keeps both tables as they are written, and looks at the rules of ``RegionLines``.

    ``drawn``, ``shown``: (element, slot) of each region, in every clock, of the tables in use; None
    where something of it was never written.
    """

    def __init__(self, dut, configuration):
        self.dut = dut
        self.regions = configuration.dealt_regions
        self.tables = [[None] * self.regions.count for _ in range(2)]
        self.written = [0, 0]
        self.drawn, self.shown, self.banks = [], [], []

    def sample(self, ctx):
        lines = self.dut.regions
        drawn, shown = ctx.get(lines.table), ctx.get(self.dut.shown_table)
        self.banks.append((drawn, shown))
        self.drawn.append(self._whole(drawn))
        self.shown.append(self._whole(shown))
        if not ctx.get(lines.valid):
            return
        bank = ctx.get(lines.bank)
        assert bank != drawn, "a table in use is written"
        assert ctx.get(lines.element) < 1 << len(lines.element)
        region = ctx.get(lines.row) * self.regions.columns + ctx.get(lines.column)
        if region == 0:
            self.written[bank] = 0
        assert region == self.written[bank], "not row by row"
        entry = ctx.get(lines.element), ctx.get(lines.slot)
        before = [element for element, _ in self.tables[bank][:region]]
        assert entry[1] == before.count(entry[0])
        self.tables[bank][region] = entry
        self.written[bank] += 1

    def _whole(self, bank):
        table = self.tables[bank]
        return None if None in table else tuple(table)
