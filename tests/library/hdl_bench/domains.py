"""Domains of processing elements, and their lattices as the interlace alone has them."""

from .pictures import small_machine

#: Cards, the domain to walk, words (0: enough), picture.
MACHINES = {
    "one unit": ("PM", (0, 1), 0, (8, 8)),
    "all four units": ("PMMMM", (0, 4), 0, (8, 8)),
    "half of four": ("PMMPMM", (2, 4), 0, (9, 8)),
    "the first of four": ("PMPMMM", (0, 1), 0, (8, 8)),
    "three of four": ("PMPMMM", (1, 4), 0, (8, 7)),
    "unequal share of eight": ("PMPMMMMMPMM", (1, 6), 0, (8, 8)),
    "one of eight": ("PMMPMPMMMMM", (2, 3), 0, (8, 8)),
    "most of sixteen": ("PMMMPMMMMMMMMMMMPMM", (3, 14), 0, (8, 8)),
    "one of sixteen, small picture": ("PMMMMMPMPMMMMMMMMMM", (5, 6), 0, (8, 6)),
    "coarser": ("PMPMMM", (1, 4), 8, (8, 8)),
    "much coarser": ("PMM", (0, 2), 2, (8, 8)),
}

#: Cards, side of the squares, the share to walk, picture.
IN_SQUARES = {
    "one of two, rows only": ("2x(PMM)", 2, (2, 4), (13, 9)),
    "first of four": ("4x(PM)", 2, (0, 1), (16, 9)),
    "last of four, two units": ("4x(PMM)", 4, (6, 8), (19, 13)),
    "one share of eight": ("8x(PMM)", 2, (10, 12), (17, 16)),
    "one of sixteen": ("16x(PM)", 2, (9, 10), (17, 16)),
    "all": ("PMMMM", 4, (0, 4), (9, 8)),
}

#: The same, where ``block`` "lines" stands for lines in turn.
IN_LINES = {
    "lines of the first of four": ("4x(PMM)", "lines", (0, 2), (13, 9)),
    "lines of the last of eight": ("8x(PM)", "lines", (7, 8), (16, 17)),
}

#: Clocks until rows and columns know their lattice.
SETTLED = 3


def domain(name, **changes):
    """Configuration, first unit and end of one of ``MACHINES``, ``IN_SQUARES`` or ``IN_LINES``."""
    if name in MACHINES:
        cards, units, words, size = MACHINES[name]
        return small_machine(cards, *size, words=words, **changes), *units
    cards, block, units, size = (IN_SQUARES | IN_LINES)[name]
    shape = {"lines": True} if block == "lines" else {"block": block}
    return small_machine(cards, *size, **shape, **changes), *units


def blocks(first, end):
    """The domain as aligned blocks of a power of two of units, each as large as can be."""
    while first < end:
        size = 1
        while first % (2 * size) == 0 and first + 2 * size <= end:
            size *= 2
        yield first, size
        first += size


#: Pixels or squares to look at each way: of every lattice there are several rows and columns.
FAR = 32


class Lattice:
    """The pixels of ``size`` units from ``start`` on, found one by one.

    ``fields`` are those of ``lattice_layout``; of larger blocks the machine's offsets have further
    bits, which the masks leave out (``masked``).
    """

    def __init__(self, configuration, start, size):
        self._interlace = configuration.interlace
        self._units = range(start, start + size)
        side = 1 << self._interlace.square_bits
        squares = {y: columns for y in range(FAR) if (columns := [
            x for x in range(FAR) if self.owns(x * side, y * side)])}
        self._rows = [y * side + inside for y in squares for inside in range(side)]
        first, second, *_ = squares
        down = second - first
        # Rows that are shifted in turn differ in the bit of y by which they are apart.
        even, odd = sorted((first, second), key=lambda y: y & down)
        columns = squares[even]
        self.fields = {"x_offset": columns[0], "x_mask": columns[1] - columns[0] - 1,
                       "y_offset": first, "y_mask": down - 1}
        if configuration.skew:
            self.fields["shifted"] = columns != squares[odd]

    def owns(self, x, y):
        return self._interlace.unit(x, y) in self._units

    def rows(self, top, bottom=None):
        """Those from ``top`` up to, without, ``bottom`` that have a pixel of it."""
        return [y for y in self._rows if top <= y and (bottom is None or y < bottom)]


def masked(lattice):
    """The fields of a lattice that the machine says."""
    fields = {name: lattice[name] for name in lattice.shape().members}
    for axis in "xy":
        fields[f"{axis}_offset"] &= fields[f"{axis}_mask"]
    return fields
