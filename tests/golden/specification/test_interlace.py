"""Pixel ↔ (unit, address): a bijection, laid out as the 1979 paper draws it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cardcage.golden.specification.interlace import Interlace, interlace_for

SIZES = st.integers(1, 80)


@st.composite
def interlaces(draw):
    """Pixel by pixel, skewed or not, diagonally, in lines, or in squares of every side."""
    if draw(st.booleans()):
        unit_bits = draw(st.integers(0, 6))
        return Interlace(unit_bits, draw(SIZES), draw(SIZES), lines=True,
                         share_bits=draw(st.integers(0, unit_bits)))
    if draw(st.booleans()):
        return Interlace(draw(st.integers(0, 6)), draw(SIZES), draw(SIZES), diagonal=True)
    unit_bits, square_bits = draw(st.integers(0, 6)), draw(st.integers(0, 5))
    share_bits = draw(st.integers(0, min(unit_bits, 2 * square_bits)))
    return Interlace(unit_bits, draw(SIZES), draw(SIZES), square_bits=square_bits,
                     share_bits=share_bits, skew=not square_bits and draw(st.booleans()))


INTERLACES = interlaces()


@settings(deadline=None)
@given(INTERLACES)
def test_a_bijection(interlace):
    y, x = np.mgrid[: interlace.height, : interlace.width]
    unit, address = interlace.unit(x, y), interlace.address(x, y)
    assert 0 <= unit.min() <= unit.max() < interlace.units
    assert 0 <= address.min() <= address.max() < interlace.words
    assert len(np.unique(unit * interlace.words + address)) == x.size
    back_x, back_y = interlace.pixel(unit, address)
    assert (back_x == x).all()
    assert (back_y == y).all()


@settings(deadline=None)
@given(INTERLACES)
def test_every_other_word_is_padding_off_the_picture(interlace):
    unit, address = np.divmod(np.arange(interlace.units * interlace.words), interlace.words)
    x, y = interlace.pixel(unit, address)
    inside = (x < interlace.width) & (y < interlace.height)
    assert inside.sum() == interlace.width * interlace.height
    assert len(set(zip(x.tolist(), y.tolist(), strict=True))) == x.size


@given(INTERLACES, st.integers(0, 50), st.integers(0, 50))
def test_numbers_and_arrays_agree(interlace, x, y):
    assert interlace.unit(x, y) == interlace.unit(np.array([x]), np.array([y]))[0]
    assert interlace.address(x, y) == interlace.address(np.array([x]), np.array([y]))[0]


def test_eight_units_are_two_apart_in_x_and_four_in_y():
    """Figure 13's distances: the next pixel of the same unit."""
    interlace = Interlace(3, 16, 16)
    for y in range(8):
        for x in range(8):
            unit = interlace.unit(x, y)
            assert [dx for dx in range(1, 9) if interlace.unit(x + dx, y) == unit] == [2, 4, 6, 8]
            assert [dy for dy in range(1, 9) if interlace.unit(x, y + dy) == unit] == [4, 8]


@pytest.mark.parametrize(("unit_bits", "numbers"), [
    (0, [[0]]),
    (1, [[0], [1]]),
    (2, [[0, 2], [1, 3]]),
    (3, [[0, 4], [2, 6], [1, 5], [3, 7]]),
    (4, [[0, 8, 2, 10], [4, 12, 6, 14], [1, 9, 3, 11], [5, 13, 7, 15]]),
])
def test_the_tile_of_numbers(unit_bits, numbers):
    """The most significant bit is the least of x, then that of y, and so on."""
    interlace = Interlace(unit_bits, 8, 8)
    rows, columns = len(numbers), len(numbers[0])
    for y in range(8):
        for x in range(8):
            assert interlace.unit(x, y) == numbers[y % rows][x % columns]
            assert interlace.address(x, y) == y // rows * (8 // columns) + x // columns


@pytest.mark.parametrize(("unit_bits", "numbers"), [
    (0, [[0]]),
    (1, [[0, 1], [1, 0]]),
    (2, [[0, 2, 1, 3], [1, 3, 0, 2]]),
    (3, [[0, 4, 1, 5], [2, 6, 3, 7], [1, 5, 0, 4], [3, 7, 2, 6]]),
])
def test_the_skewed_tile_of_numbers(unit_bits, numbers):
    """The last bit, that of y, is added to the lowest bit of x that is in no number."""
    skewed, plain = Interlace(unit_bits, 8, 8, skew=True), Interlace(unit_bits, 8, 8)
    rows, columns = len(numbers), len(numbers[0])
    for y in range(8):
        for x in range(8):
            assert skewed.unit(x, y) == numbers[y % rows][x % columns]
            assert skewed.unit(x, y) >> 1 == plain.unit(x, y) >> 1
            assert skewed.address(x, y) == plain.address(x, y)


@given(st.integers(1, 6), st.data())
def test_a_skewed_unit_is_a_lattice_with_every_other_row_shifted(unit_bits, data):
    interlace = Interlace(unit_bits, 32, 32, skew=True)
    unit = data.draw(st.integers(0, interlace.units - 1))
    assert interlace.shifted(0) and not interlace.shifted(1)
    across, down = (1 << bits for bits in interlace.stride_bits(0))
    assert across * down == interlace.units
    y, x = np.mgrid[:32, :32]
    inside = interlace.unit(x, y) == unit
    first_x, first_y = x[y == y[inside].min()][inside[y == y[inside].min()]][0], y[inside].min()
    shift = ((y - first_y) // down % 2) * (across // 2)
    assert (inside == (((x - first_x - shift) % across == 0) & (y % down == first_y))).all()


@given(st.integers(0, 6), st.booleans(), st.data())
def test_aligned_blocks_are_lattices(unit_bits, skew, data):
    interlace = Interlace(unit_bits, 32, 32, skew=skew)
    unit_block_bits = data.draw(st.integers(int(skew and unit_bits > 0), unit_bits))
    block = data.draw(st.integers(0, (1 << unit_bits - unit_block_bits) - 1))
    across, down = (1 << bits for bits in interlace.stride_bits(unit_block_bits))
    assert across * down << unit_block_bits == interlace.units
    y, x = np.mgrid[:32, :32]
    inside = interlace.unit(x, y) >> unit_block_bits == block
    first_x, first_y = x[inside].min(), y[inside].min()
    assert first_x < across
    assert first_y < down
    assert (inside == ((x % across == first_x) & (y % down == first_y))).all()


@pytest.mark.parametrize(("unit_bits", "square_bits", "share_bits", "order"), [
    (2, 1, 0, "x1 y1"),
    (2, 1, 1, "y1 x0"),
    (3, 1, 2, "y1 x0 y0"),
    (5, 3, 1, "x3 y3 x4 y4 x0"),
    (5, 2, 2, "x2 y2 y3 x0 y0"),
    (4, 5, 3, "y5 x0 y0 x1"),
])
def test_bits_in_squares(unit_bits, square_bits, share_bits, order):
    """Those of the processing element above the square's, those of its units from the lowest."""
    interlace = Interlace(unit_bits, 64, 64, square_bits=square_bits, share_bits=share_bits)
    assert " ".join(f"{axis}{bit}" for axis, bit in interlace.bit_order) == order


@settings(deadline=None)
@given(INTERLACES.filter(lambda interlace: not interlace.diagonal))
def test_a_share_is_a_lattice_of_squares(interlace):
    side = 1 << interlace.square_bits
    across, down = (1 << bits for bits in interlace.stride_bits(interlace.share_bits))
    assert across * down << interlace.share_bits == interlace.units
    y, x = np.mgrid[: interlace.height, : interlace.width]
    element = interlace.unit(x, y) >> interlace.share_bits
    shift = interlace.shifted(interlace.share_bits) * (y // side // down % 2 * (across // 2))
    column, row = (x // side + shift) % across, y // side % down
    # One processing element for each place in the lattice.
    pairs = {(int(e), int(c), int(r)) for e, c, r in zip(element.flat, column.flat, row.flat,
                                                       strict=True)}
    assert len(pairs) == len(np.unique(element)) == len(np.unique(row * across + column))


def test_two_units_of_a_processing_element_alternate_along_its_rows():
    interlace = Interlace(5, 64, 64, square_bits=3, share_bits=1)
    assert [interlace.unit(x, 5) for x in range(17)] == [0, 1] * 4 + [16, 17] * 4 + [4]


@settings(deadline=None)
@given(INTERLACES)
def test_scan_reads(interlace):
    """A unit reads each of its pixels of a line once; ``scan_reads`` of them at worst."""
    y, x = np.mgrid[: interlace.height, : interlace.width]
    unit = interlace.unit(x, y)
    assert max(np.bincount(line).max() for line in unit) == interlace.scan_reads
    group = 1 << interlace.group_bits
    for line in unit:
        for start in range(0, interlace.width, group):
            part = line[start:start + group]
            assert len(set(part.tolist())) == len(part)
    if interlace.skew_bit is not None:
        return
    # Larger groups would hold two pixels of one unit.
    first = unit[0, : 2 * group]
    assert len(first) < 2 * group or len(set(first.tolist())) < len(first)


@pytest.mark.parametrize(("square_bits", "share_bits", "pitch"), [
    (0, 0, 128), (1, 1, 64), (3, 1, 64), (5, 1, 64), (1, 2, 64), (5, 3, 32)])
def test_scan_reads_of_sixteen_processing_elements(square_bits, share_bits, pitch):
    interlace = Interlace(4 + max(1, share_bits), 512, 512, square_bits=square_bits,
                          share_bits=share_bits)
    assert interlace.scan_reads == interlace.pitch == pitch


def test_skewed_units_read_half_as_often_in_a_line():
    plain, skewed = (Interlace(5, 512, 512, skew=skew) for skew in (False, True))
    assert (plain.scan_reads, skewed.scan_reads) == (128, 64)
    assert plain.words == skewed.words


@pytest.mark.parametrize(("unit_bits", "rows"), [
    (1, [[0, 1, 0, 1], [1, 0, 1, 0]]),
    (2, [[0, 1, 2, 3], [3, 0, 1, 2], [2, 3, 0, 1], [1, 2, 3, 0]]),
    (3, [[0, 1, 2, 3], [5, 6, 7, 0], [2, 3, 4, 5]]),
    (4, [[0, 1, 2, 3], [11, 12, 13, 14], [6, 7, 8, 9]]),
])
def test_the_diagonal_tile_of_numbers(unit_bits, rows):
    interlace = Interlace(unit_bits, 16, 16, diagonal=True)
    assert [[interlace.unit(x, y) for x in range(4)] for y in range(len(rows))] == rows


@pytest.mark.parametrize(("unit_bits", "share_bits", "rows"), [
    (1, 0, [[0, 0, 0], [1, 1, 1], [0, 0, 0]]),
    (2, 1, [[0, 1, 0], [2, 3, 2], [0, 1, 0]]),
    (2, 0, [[0, 0, 0], [1, 1, 1], [2, 2, 2], [3, 3, 3], [0, 0, 0]]),
    (4, 2, [[0, 1, 2, 3, 0], [4, 5, 6, 7, 4], [8, 9, 10, 11, 8], [12, 13, 14, 15, 12], [0]]),
])
def test_element_i_of_n_has_the_lines_i_and_n_more_each(unit_bits, share_bits, rows):
    interlace = Interlace(unit_bits, 16, 16, lines=True, share_bits=share_bits)
    assert [[interlace.unit(x, y) for x in range(len(row))] for y, row in enumerate(rows)] == rows


@pytest.mark.parametrize("fields", [{"skew": True}, {"square_bits": 1}, {"diagonal": True}])
def test_lines_are_nothing_else(fields):
    with pytest.raises(ValueError, match="lines want neither squares nor skew nor diagonal"):
        Interlace(2, 16, 16, lines=True, **fields)


@pytest.mark.parametrize("fields", [{"skew": True}, {"square_bits": 1}])
def test_a_diagonal_is_nothing_else(fields):
    with pytest.raises(ValueError, match="diagonal wants neither skew nor squares"):
        Interlace(2, 16, 16, diagonal=True, **fields)


def test_squares_are_not_skewed():
    with pytest.raises(ValueError, match="square_bits 0"):
        Interlace(3, 8, 8, square_bits=1, skew=True)


@pytest.mark.parametrize(("unit_bits", "square_bits", "share_bits"), [
    (3, 0, 1), (3, 1, 3), (2, 2, 3), (2, 2, -1)])
def test_squares_hold_the_units_of_a_share(unit_bits, square_bits, share_bits):
    with pytest.raises(ValueError, match="share_bits"):
        Interlace(unit_bits, 8, 8, square_bits=square_bits, share_bits=share_bits)


@pytest.mark.parametrize(("units", "words", "size", "shifts"), [
    (16, 16384, (512, 512), (0, 0)),
    (8, 16384, (512, 256), (0, 1)),
    (4, 16384, (256, 256), (1, 1)),
    (2, 16384, (256, 128), (1, 2)),
    (1, 16384, (128, 128), (2, 2)),
])
def test_fewer_units_give_a_coarser_picture(units, words, size, shifts):
    """512x512 in sixteen units; boards pulled out, y halves first."""
    interlace = interlace_for(512, 512, words=words, units=units)
    assert (interlace.width, interlace.height) == size
    assert (interlace.x_shift, interlace.y_shift) == shifts
    assert interlace.words == words


@given(st.integers(1, 70), st.integers(1, 70), st.integers(1, 300), st.integers(0, 4))
def test_as_little_coarser_as_the_words_demand(width, height, words, unit_bits):
    interlace = interlace_for(width, height, words=words, units=1 << unit_bits)
    assert interlace.words <= words
    assert interlace.units == 1 << unit_bits
    shifts = interlace.x_shift, interlace.y_shift
    assert shifts[1] - shifts[0] in (0, 1)
    assert interlace.width == -(-width // 2 ** shifts[0])
    assert interlace.height == -(-height // 2 ** shifts[1])
    # The step before would not have fitted.
    if shifts != (0, 0):
        x_shift, y_shift = (shifts[0], shifts[1] - 1) if shifts[1] > shifts[0] else (
            shifts[0] - 1, shifts[1])
        finer = Interlace(unit_bits, -(-width // 2**x_shift), -(-height // 2**y_shift))
        assert finer.words > words


@pytest.mark.parametrize("units", [0, -1, 3, 6, 12])
def test_units_must_be_a_power_of_two(units):
    with pytest.raises(ValueError, match="power of two"):
        interlace_for(8, 8, words=64, units=units)


@pytest.mark.parametrize("words", [0, -5])
def test_words_must_be_positive(words):
    with pytest.raises(ValueError, match="words"):
        interlace_for(8, 8, words=words, units=1)
