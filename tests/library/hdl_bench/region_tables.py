"""What becomes of the tables that a host sends: by the words of ``docs/command-words.md``."""

from cardcage.golden.organisations.region_table import static_table
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode

from .bench import Agent


def region_word(configuration, region, element):
    """A ``REGION`` command; ``region``: its number, or column and row."""
    columns = configuration.dealt_regions.columns
    column, row = region if isinstance(region, tuple) else (region % columns, region // columns)
    return commands.command(Opcode.REGION, commands.pack(
        commands.region_layout(configuration), {"column": column, "row": row, "element": element}))


def table_words(configuration, table):
    return [region_word(configuration, region, int(element))
            for region, element in enumerate(table)]


class Tables:
    """Takes command after command, and says what is answered to those that are about tables.

    ``used``: the table of the frame begun last.
    """

    def __init__(self, configuration, elements=None):
        self.configuration = configuration
        self.regions = configuration.dealt_regions
        self.elements = configuration.processing_elements if elements is None else elements
        self.used = static_table(self.regions.count, self.elements).tolist()
        self.coming, self.waiting = [], None
        self.refused = self.in_frame = False

    def take(self, word):
        """The fault that is answered, or None."""
        opcode = commands.opcode_of(word)
        if opcode == Opcode.FRAME_END:
            self.in_frame = False
        if opcode == Opcode.FRAME_START:
            return self._start()
        if opcode != Opcode.REGION:
            return None
        fields = commands.unpack(commands.region_layout(self.configuration),
                                 word >> commands.BODY_OFFSET)
        place, element = (fields["row"], fields["column"]), fields["element"]
        if self.refused and place != (0, 0):
            return None
        fault = self._fault(place, element)
        self.refused = fault is not None
        if place == (0, 0) or self.refused:
            self.coming, self.waiting = [], None
        if not self.refused:
            self.coming.append(element)
            if len(self.coming) == self.regions.count:
                self.waiting, self.coming = self.coming, []
        return fault

    def _start(self):
        unfinished, self.in_frame = bool(self.coming), True
        self.coming = []
        if self.waiting is not None:
            self.used, self.waiting = self.waiting, None
        if not unfinished:
            return None
        self.refused = True
        return Fault.REGION_TO_NOBODY

    def _fault(self, place, element):
        if self.in_frame:
            return Fault.TABLE_LATE
        before = []
        if place != (0, 0):
            before = self.coming
            expected = divmod(len(before), self.regions.columns)
            if self.waiting is not None or place < expected:
                return Fault.REGION_TWICE
            if place > expected:
                return Fault.REGION_TO_NOBODY
        if element >= self.elements:
            return Fault.REGION_TO_NOBODY
        return Fault.NO_SLOT if before.count(element) == self.configuration.slots else None


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
