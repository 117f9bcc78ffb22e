"""Machines whose regions are dealt out, the lines that deal them, and visits as golden has them."""

import random
from dataclasses import dataclass

import numpy as np

from cardcage.golden.balancing.region_grid import RegionGrid
from cardcage.golden.balancing.region_visits import region_visits
from cardcage.golden.organisations.region_table import slots_of
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.specification.sampling_grid import Grid

from .bench import Agent
from .pictures import prepare, prepared_values, small_machine

#: Cards, picture, columns and rows of regions, slots (0: as many as there are by themselves):
#: squares, strips, regions that reach beyond the picture, one region for each element.
MACHINES = {
    "squares": ("3x(PM)", (32, 32), (8, 8), 0),
    "wide": ("2x(PMM)", (37, 19), (5, 10), 25),
    "columns": ("3x(PM)", (24, 20), (12, 1), 0),
    "rows": ("4x(PM)", (20, 24), (1, 12), 0),
    "few": ("2x(PMMMM)", (16, 9), (2, 2), 0),
    "one each": ("4x(PM)", (16, 16), (2, 2), 1),
}

#: Where no box is large.
NEVER_LARGE = ("few", "one each")


def region_machine(name, **changes):
    cards, size, regions, slots = MACHINES[name]
    return small_machine(cards, *size, regions=regions, **{"slots": slots} | changes)


def random_table(configuration, seed):
    """int64 (regions,): elements in any order, none with more regions than it has slots."""
    source = random.Random(f"table {seed}")
    places = list(range(configuration.processing_elements)) * configuration.slots
    source.shuffle(places)
    return np.array(places[:configuration.dealt_regions.count])


def region_words(configuration, table):
    """What the lines say of each region of a table."""
    columns, slots = configuration.dealt_regions.columns, slots_of(table)
    return [{"column": region % columns, "row": region // columns, "element": int(element),
             "slot": int(slots[region])} for region, element in enumerate(table)]


class RegionDriver(Agent):
    """Sets the ``lines`` of a component: a word, or nothing, and the table in use."""

    def __init__(self, lines):
        self._lines = lines

    def say(self, ctx, word, table):
        """``word`` goes into the table that is not in use."""
        for name, value in {"valid": word is not None, "bank": 1 - table, "table": table,
                            **(word or {})}.items():
            if len(getattr(self._lines, name)):
                ctx.set(getattr(self._lines, name), value)


class Deal(RegionDriver):
    """Writes ``tables`` one after the other, each of which is used once it is there.

    ``element`` is the component's input of that name, ``number`` its value.  Agents that need the
    last table wait for ``clocks``.
    """

    def __init__(self, lines, configuration, tables, element, number):
        super().__init__(lines)
        self._element, self._number = element, number
        self._words = []
        for place, table in enumerate(tables):
            self._words += [(word, place & 1) for word in region_words(configuration, table)]
        self._words.append((None, len(tables) & 1))
        self.clocks = len(self._words)
        self._clock = 0

    @property
    def finished(self):
        return self._clock >= self.clocks

    def drive(self, ctx):
        ctx.set(self._element, self._number)
        if not self.finished:
            self.say(ctx, *self._words[self._clock])
        self._clock += 1


class DealFrames(RegionDriver):
    """Writes the table of each frame while the one before is drawn; its start waits for it."""

    def __init__(self, dut, announcer, tables):
        super().__init__(dut.regions)
        self._announcer = announcer
        self._tables = [region_words(dut.configuration, table) for table in tables]
        self._left = list(self._tables[0])
        self._frames = 0
        announcer.may_start = lambda: not self._left

    def drive(self, ctx):
        if self._announcer.frames > self._frames:
            self._frames += 1
            self._left = list(self._tables[self._frames]) if self._frames < len(
                self._tables) else []
        # The first table is written into bank 0.
        self.say(ctx, self._left.pop(0) if self._left else None, 1 - (self._frames & 1))


@dataclass(frozen=True)
class Visit:
    """A triangle in a region: column, row and slot of this, and (y, first, beyond) of each row,
    the two columns cut to the region."""

    column: int
    row: int
    slot: int
    rows: tuple[tuple[int, int, int], ...]

    @property
    def pixels(self):
        return sum(max(0, beyond - first) for _, first, beyond in self.rows)


def edge_column(edges, index, row):
    """Of an edge of ``golden.reference.triangle_setup``, so many rows below its first."""
    column, remainder, column_step, remainder_step, denominator = (
        int(getattr(edges, name)[index]) for name in (
            "column", "remainder", "column_step", "remainder_step", "denominator"))
    return ((column + row * column_step) * denominator + remainder
            + row * remainder_step) // denominator


def row_extent(prepared, index, y, width):
    """Columns from the first up to, without, the last, held to the picture."""
    top, middle = int(prepared.top[index]), int(prepared.middle[index])
    short = (edge_column(prepared.upper, index, y - top) if y < middle
             else edge_column(prepared.lower, index, y - middle))
    columns = [edge_column(prepared.long, index, y - top), short]
    if not prepared.long_edge_left[index]:
        columns.reverse()
    return [min(max(column, 0), width) for column in columns]


class Dealt:
    """What the triangles of a list are to an element, by a table."""

    def __init__(self, configuration, table, element, display_list):
        self.configuration, self.table, self.element = configuration, table, element
        self.regions = configuration.dealt_regions
        self.slots = slots_of(table)
        self.prepared = prepare(configuration, display_list)
        self.values = prepared_values(configuration, self.prepared)
        self.boxes = [self._box(value) for value in self.values]
        self._visits = [[] for _ in self.values]  # region, rows, fragments
        for visits in region_visits(Triangles.of(display_list, Grid.of(display_list)),
                                    RegionGrid.of(self.regions)):
            for triangle, *visit in zip(visits.triangle, visits.region, visits.rows,
                                        visits.fragments, strict=True):
                self._visits[triangle].append(tuple(map(int, visit)))

    def _box(self, value):
        x, y = self.regions.x_bits, self.regions.y_bits
        return (value["left"] >> x, value["right"] - 1 >> x,
                value["top"] >> y, value["bottom"] - 1 >> y)

    def large(self, index):
        left, right, top, bottom = self.boxes[index]
        return right - left > 1 or bottom - top > 1

    def own(self, column, row):
        return self.table[row * self.regions.columns + column] == self.element

    def own_bits(self, index):
        """Of the box's at most 2 × 2 regions."""
        left, right, top, bottom = self.boxes[index]
        return sum(self.own(left + x, top + y) << (2 * y + x)
                   for y in range(bottom - top + 1) for x in range(right - left + 1))

    def kept(self):
        """Indices of those that the filter keeps."""
        return [index for index in range(len(self.values))
                if self.large(index) or self.own_bits(index)]

    def outline(self, index):
        """As the queue gives it to the walker."""
        value = {name: field for name, field in self.values[index].items() if name != "planes"}
        large = self.large(index)
        return value | {"own": 0 if large else int(self.own_bits(index)), "large": large}

    def band(self, index, row):
        """Rows of the triangle's box in a row of regions."""
        value, bits = self.values[index], self.regions.y_bits
        return range(max(value["top"], row << bits), min(value["bottom"], row + 1 << bits))

    def extents(self, index, row):
        """(y, first, beyond) of each."""
        return [(y, *row_extent(self.prepared, index, y, self.configuration.width))
                for y in self.band(index, row)]

    def visits(self, index):
        """Those that golden knows, its own ones; with the rows of each, from the exact edges."""
        found, bits = [], self.regions.x_bits
        for region, rows, fragments in self._visits[index]:
            row, column = divmod(region, self.regions.columns)
            if self.own(column, row):
                visit = Visit(column, row, int(self.slots[region]), tuple(
                    (y, max(first, column << bits), min(beyond, column + 1 << bits))
                    for y, first, beyond in self.extents(index, row)))
                assert (len(visit.rows), visit.pixels) == (rows, fragments)
                found.append(visit)
        return found
