"""``docs/command-words.md`` says of each interlace which pixel a word is."""

from math import ceil

import numpy as np
import pytest
from command_words_tables import NOTHING, TABLES, table

from cardcage.golden.specification.interlace import Interlace


@pytest.mark.parametrize("skewed", [False, True])
def test_unit_numbers(skewed):
    (rows,) = [rows for header, rows in TABLES.items()
               if header[0] == "units" and ("skewed" in header[1]) == skewed]
    assert len(rows) == 5
    for row in rows:
        interlace = Interlace(int(row["units"]).bit_length() - 1, 8, 8, skew=skewed)
        order = [f"{axis}{bit}" for axis, bit in interlace.bit_order]
        if interlace.skew_bit is not None:
            order[-1] += f"^x{interlace.skew_bit}"
        (documented,) = [row[name] for name in row if name != "units"]
        assert documented.replace(NOTHING, "").split() == order


def test_diagonal_units():
    for row in table("units behind D"):
        units = int(row["units behind D"])
        interlace = Interlace(units.bit_length() - 1, 21, 13, diagonal=True)
        step = int(row["step"])
        assert interlace.diagonal_step == step == (5 * units // 8) | 1
        y, x = np.mgrid[:13, :21]
        pitch = ceil(21 / units)
        assert (interlace.pitch, interlace.words) == (pitch, 13 * pitch)
        unit, address = (x + step * y) % units, pitch * y + x // units
        np.testing.assert_array_equal(interlace.unit(x, y), unit)
        np.testing.assert_array_equal(interlace.address(x, y), address)
        np.testing.assert_array_equal(
            (address % pitch * units + (unit - step * y) % units, address // pitch), (x, y))
    tile = [[int(unit) for unit in list(row.values())[1:]] for row in table("y", "unit of x = 0")]
    np.testing.assert_array_equal(Interlace(2, 16, 16, diagonal=True).tile, tile)


def test_unit_numbers_in_lines():
    (rows,) = [rows for header, rows in TABLES.items() if "lines in turn, each" in header]
    assert len(rows) == 4
    for row in rows:
        units, share, documented = row.values()
        interlace = Interlace(int(units).bit_length() - 1, 64, 64, lines=True,
                              share_bits=int(share).bit_length() - 1)
        assert documented.split() == [f"{axis}{bit}" for axis, bit in interlace.bit_order]


def test_unit_numbers_in_squares():
    (rows,) = [rows for header, rows in TABLES.items() if header[:2] == ("total units", "side")]
    assert len(rows) == 4
    for row in rows:
        units, side, share = (int(row[name]).bit_length() - 1
                              for name in ("total units", "side", "each"))
        interlace = Interlace(units, 64, 64, square_bits=side, share_bits=share)
        *_, documented = row.values()
        assert documented.split() == [f"{axis}{bit}" for axis, bit in interlace.bit_order]
