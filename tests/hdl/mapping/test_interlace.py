"""Pixel ↔ unit arithmetic: exhaustive over small pictures, for every number of units."""

from dataclasses import replace

import pytest
from hdl_bench.bench import evaluate
from hdl_bench.pictures import small_machine

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.interlace import interlace_for
from cardcage.hdl.mapping.interlace import PixelAddress, ScanAddress
from cardcage.hdl.mapping.lattice import LatticeBlock
from cardcage.testbenches.export.cell_count import count_cells

UNITS = (1, 2, 4, 8, 16)

#: Width, height, words of a unit: whole pictures, padded ones, and ones too large for the memory.
PICTURES = [(16, 8, 128), (7, 5, 35), (1, 1, 1), (16, 16, 16), (16, 16, 3), (9, 13, 8), (5, 16, 1)]


def machine(width, height, words):
    return small_machine("PM", width, height, words=words, maximum_units=16)


def settled(configuration, units):
    """The picture contract: y halves first, until the memory of all units holds the picture."""
    return interlace_for(configuration.width, configuration.height, words=configuration.words,
                         units=units)


def unit_of(units, x, y):
    """The number of a pixel's unit, spelled out: x0 y0 x1 y1 …, most significant first."""
    bits = {1: [], 2: [y], 4: [x, y], 8: [x, y, y >> 1], 16: [x, y, x >> 1, y >> 1]}[units]
    number = 0
    for bit in bits:
        number = number * 2 + (bit & 1)
    return number


PITCH = {1: (1, 1), 2: (1, 2), 4: (2, 2), 8: (2, 4), 16: (4, 4)}


@pytest.mark.parametrize("picture", PICTURES, ids=str)
def test_pixel_address(picture):
    configuration = machine(*picture)
    dut = PixelAddress(configuration=configuration)

    def steps(ctx):
        for units in UNITS:
            ctx.set(dut.total, units)
            interlace = settled(configuration, units)
            across, down = PITCH[units]
            places = set()
            for y in range(interlace.height):
                for x in range(interlace.width):
                    ctx.set(dut.x, x)
                    ctx.set(dut.y, y)
                    place = ctx.get(dut.unit), ctx.get(dut.address)
                    pitch = -(-interlace.width // across)
                    assert place == (unit_of(units, x, y), y // down * pitch + x // across)
                    places.add(place)
            assert len(places) == interlace.width * interlace.height
            assert ctx.get(dut.last_word) + 1 == interlace.words <= configuration.words
            assert max(address for _, address in places) < interlace.words
            assert {unit for unit, _ in places} <= set(range(units))

    evaluate(dut, steps)


def test_pixel_address_without_a_supported_total():
    dut = PixelAddress(configuration=machine(16, 8, 128))

    def steps(ctx):
        ctx.set(dut.x, 5)
        ctx.set(dut.y, 7)
        for total in set(range(32)) - set(UNITS):
            ctx.set(dut.total, total)
            assert ctx.get(dut.unit) == ctx.get(dut.address) == 0

    evaluate(dut, steps)


@pytest.mark.parametrize("picture", PICTURES, ids=str)
@pytest.mark.parametrize("units", UNITS)
def test_scan_address(picture, units):
    """Every scan address selects one unit, after a fetch of the right word by that unit."""
    configuration = machine(*picture)
    interlace = settled(configuration, units)
    dut = ScanAddress(configuration=configuration)

    def steps(ctx):
        ctx.set(dut.total, units)
        fetched = {}  # unit → address last fetched in this line
        reads = dict.fromkeys(range(units), 0)
        for scan_y in range(configuration.height):
            fetched.clear()
            reads = dict.fromkeys(range(units), 0)
            ctx.set(dut.y, scan_y)
            for scan_x in range(configuration.width):
                ctx.set(dut.x, scan_x)
                x, y = scan_x >> interlace.x_shift, scan_y >> interlace.y_shift
                selected = []
                across = PITCH[units][0]
                group = ({unit_of(units, x + step, y) for step in range(across)}
                         if scan_x % (across << interlace.x_shift) == 0 else set())
                for unit in range(units):
                    ctx.set(dut.id, unit)
                    # The units of the group, at its first pixel, and no other.
                    assert ctx.get(dut.fetch) == (unit in group)
                    if unit in group:
                        fetched[unit] = ctx.get(dut.address)
                        reads[unit] += 1
                    if ctx.get(dut.selected):
                        selected.append(unit)
                assert selected == [unit_of(units, x, y)]
                assert fetched[selected[0]] == interlace.address(x, y)
            assert max(reads.values()) <= interlace.pitch

    evaluate(dut, steps)


#: Cards, side of the squares, units that the cage may hold instead.
SQUARES = [("PM", 4, 16), ("PMM", 2, 16), ("PMMMM", 2, 16), ("PMM", 8, 8), ("PMMMM", 4, 8),
           ("PM", 32, 4)]


#: In lines: the share's units, and the cage's.
LINES = [("PM", "lines", 4), ("PMM", "lines", 16), ("PMMMM", "lines", 8), ("PMMMM", "lines", 4)]

#: The same, in no squares but skewed.
SKEWED = [("PM", None, units) for units in UNITS]

#: Diagonally.
DIAGONAL = [("PPDM", 1, units) for units in UNITS]


def squares(cards, block, units, picture):
    """The machine, and the interlace that it settles on with so many units; skewed where there
    are neither squares nor lines."""
    width, height, words = picture
    shape = {None: {"skew": True}, "lines": {"lines": True}}.get(block, {"block": block})
    configuration = small_machine(cards, width, height, words=words, maximum_units=max(units, 2),
                                  **shape)
    return configuration, interlace_for(
        width, height, words=words, units=units, square_bits=configuration.square_bits,
        share_bits=configuration.share_bits, skew=configuration.skew,
        diagonal=configuration.merges_directly, lines=configuration.lines)


@pytest.mark.parametrize("picture", PICTURES, ids=str)
@pytest.mark.parametrize(("cards", "block", "units"), SQUARES + LINES + SKEWED + DIAGONAL)
def test_pixels_in_squares_skewed_and_diagonal(cards, block, units, picture):
    """Address and scan, pixel by pixel: each lies in the word that is fetched before it is shown,
    and no unit reads the scan more often than ``scan_reads`` says."""
    configuration, interlace = squares(cards, block, units, picture)
    where, scan = (PixelAddress(configuration=configuration),
                   ScanAddress(configuration=configuration))

    def pixels(ctx):
        ctx.set(where.total, units)
        places = set()
        for y in range(interlace.height):
            for x in range(interlace.width):
                ctx.set(where.x, x)
                ctx.set(where.y, y)
                place = ctx.get(where.unit), ctx.get(where.address)
                assert place == (interlace.unit(x, y), interlace.address(x, y))
                places.add(place)
        assert len(places) == interlace.width * interlace.height
        assert ctx.get(where.last_word) + 1 == interlace.words
        assert max(address for _, address in places) < interlace.words <= configuration.words

    def lines(ctx):
        ctx.set(scan.total, units)
        for scan_y in range(configuration.height):
            ctx.set(scan.y, scan_y)
            held, reads = {}, [0] * units
            for scan_x in range(configuration.width):
                ctx.set(scan.x, scan_x)
                place = scan_x >> interlace.x_shift, scan_y >> interlace.y_shift
                for unit in range(units):
                    ctx.set(scan.id, unit)
                    if ctx.get(scan.fetch):
                        held[unit] = ctx.get(scan.address)
                        reads[unit] += 1
                    assert ctx.get(scan.selected) == (unit == interlace.unit(*place))
                assert held[interlace.unit(*place)] == interlace.address(*place)
            assert max(reads) <= interlace.scan_reads

    evaluate(where, pixels)
    evaluate(scan, lines)


@pytest.mark.parametrize(("cards", "block", "units"), SQUARES + LINES)
def test_a_share_is_a_lattice_of_squares(cards, block, units):
    configuration, interlace = squares(cards, block, units, (33, 17, 33 * 17))
    block = configuration.block
    dut = LatticeBlock(configuration=configuration)
    share = 1 << configuration.share_bits

    def steps(ctx):
        ctx.set(dut.total, units)
        seen = 0
        for first in range(0, units, share):
            ctx.set(dut.first, first)
            ctx.set(dut.end, first + share)
            assert ctx.get(dut.after) == first + share
            owned = ctx.get(dut.lattice)
            for y in range(interlace.height):
                for x in range(interlace.width):
                    inside = (x // block & owned.x_mask == owned.x_offset
                              and y // block & owned.y_mask == owned.y_offset)
                    assert inside == (first <= interlace.unit(x, y) < first + share)
                    seen += inside
        assert seen == interlace.width * interlace.height

    evaluate(dut, steps)


def lattice(x_offset, y_offset, across, down, shifted=False, size=16):
    return {(x, y) for number, y in enumerate(range(y_offset, size, down))
            for x in range((x_offset + shifted * number * across // 2) % across, size, across)}


@pytest.mark.parametrize(("skew", "bits"), [(False, (2, 2)), (True, (3, 1))])
def test_lattice_blocks_tile_every_domain(skew, bits):
    configuration = replace(machine(16, 16, 256), skew=skew)
    dut = LatticeBlock(configuration=configuration)
    assert (len(dut.lattice.x_offset), len(dut.lattice.y_offset)) == bits

    def steps(ctx):
        for units in UNITS:
            ctx.set(dut.total, units)
            interlace = interlace_for(16, 16, words=256, units=units, skew=skew)
            pixels = {unit: set() for unit in range(units)}
            for y in range(16):
                for x in range(16):
                    pixels[interlace.unit(x, y)].add((x, y))
            for first in range(units):
                for end in range(first + 1, units + 1):
                    check_domain(ctx, pixels, first, end)

    def check_domain(ctx, pixels, first, end):
        ctx.set(dut.end, end)
        blocks = []
        while first < end:
            ctx.set(dut.first, first)
            after = ctx.get(dut.after)
            size = after - first
            assert first < after <= end
            assert size & (size - 1) == 0 and first % size == 0
            # The largest such block: twice as many would not be aligned, or go beyond the end.
            assert first % (2 * size) or first + 2 * size > end
            owned = ctx.get(dut.lattice)
            # Of a larger block the offset has bits that the mask leaves out.
            found = lattice(owned.x_offset & owned.x_mask, owned.y_offset & owned.y_mask,
                            owned.x_mask + 1, owned.y_mask + 1, skew and owned.shifted)
            assert found == set.union(*(pixels[unit] for unit in range(first, after)))
            blocks.append(size)
            first = after
        assert len(blocks) <= 7

    evaluate(dut, steps)


def test_equal_shares_are_one_lattice():
    dut = LatticeBlock(configuration=machine(16, 16, 256))

    def steps(ctx):
        for units in UNITS:
            ctx.set(dut.total, units)
            for share in (count for count in UNITS if count <= units):
                for first in range(0, units, share):
                    ctx.set(dut.first, first)
                    ctx.set(dut.end, first + share)
                    assert ctx.get(dut.after) == first + share

    evaluate(dut, steps)


def test_diagonally_the_whole_picture_is_one_block():
    """Of all units, however many there are."""
    dut = LatticeBlock(configuration=small_machine("PPDM", 16, 16, maximum_units=16))

    def steps(ctx):
        for units in UNITS:
            for line in (dut.total, dut.end):
                ctx.set(line, units)
            assert ctx.get(dut.after) == units
            assert ctx.get(dut.lattice.as_value()) == 0

    evaluate(dut, steps)


@pytest.mark.parametrize("units", [4, 16, 64])
def test_diagonally_nothing_is_multiplied(units):
    """Where rows are a power of two of words: a multiplier would take half the clock rate."""
    configuration = MachineConfiguration(cards=f"PD{'M' * units}", width=64, height=64)
    assert count_cells(ScanAddress(configuration=configuration)).multipliers == 0
