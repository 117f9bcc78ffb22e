"""Triangles on which the datapath errs as much as it can, and how much that is.

A triangle with one vertex in the first pixel and the others to either side of
the last covers the pixel farthest from the origin of its box.  Many such are
drawn at random, for the one whose two increments, scaled by 2**F, both lie next
to half a unit; moving it by less than a pixel changes neither, only the start,
which is brought next to half a unit as well.  All three errors add up there.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..reference import bit_true, exact
from ..reference.triangle_setup import Planes, prepare
from ..specification import fixed_point
from ..specification.display_list import DisplayList
from ..specification.ranges import CHANNEL_BITS, MAXIMUM_SIZE, check_whole

Int64 = NDArray[np.int64]
Float64 = NDArray[np.float64]

Interpolant = Literal["depth", "color"]
INTERPOLANTS: tuple[Interpolant, ...] = ("depth", "color")

#: Triangles tried.  The two increments miss half a unit by some 1 / sqrt(_TRIALS).
_TRIALS = 1 << 17

#: How far the second and third vertex lie from the last pixel, at most, in pixels.
_SPREAD = 32

#: Each side of the screen has at least so many pixels: room for the two vertices.
_SMALLEST = 8


@dataclass(frozen=True, eq=False)
class WorstCase:
    """A triangle, its covered pixel in the screen's lower right corner, and the error there.

    ``display_list``  the one triangle, the same values in depth or in all channels
    ``x`` ``y``       the pixel, also its distance from the origin of the triangle's box
    ``error``         carried value minus the value it stands for, see ``carried_error``
    ``bound``         what ``error`` may be, either way
    """

    display_list: DisplayList
    interpolant: Interpolant
    fraction_bits: int
    seed: int
    x: int
    y: int
    error: Fraction
    bound: Fraction

    @property
    def ratio(self) -> float:
        """Error over bound: 1 where the bound is reached."""
        return float(abs(self.error) / self.bound)


def biased_value(corners: list[list[int]], values: list[int], x: int, y: int) -> Fraction:
    """What is carried at the point (x, y), in sub-pixel units, were nothing rounded.

    The plane through ``values`` at ``corners``, plus half for the last rounding,
    plus half the spacing 1/D of such values, where D, the doubled area, is even;
    where it is odd the half lies between two of them already.
    """
    (x0, y0), (x1, y1), (x2, y2) = corners
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    at_1 = (x - x0) * (y2 - y0) - (x2 - x0) * (y - y0)
    at_2 = (x1 - x0) * (y - y0) - (x - x0) * (y1 - y0)
    value = values[0] + Fraction((values[1] - values[0]) * at_1 + (values[2] - values[0]) * at_2,
                                 area)  # fmt: skip
    spacing = Fraction(1, abs(area))
    return value + Fraction(1, 2) + (spacing / 2 if area % 2 == 0 else 0)


def carried_error(display_list: DisplayList, interpolant: Interpolant, fraction_bits: int,
                  x: int, y: int) -> Fraction:
    """How far the carried value of triangle 0 at the covered pixel (x, y) is off, in LSB.

    Against ``biased_value``, before the last rounding; of a colour the red channel.
    """
    prepared = prepare(display_list, fraction_bits=fraction_bits)
    planes: Planes = prepared.depth
    values = display_list.depth[0].tolist()
    if interpolant == "color":
        assert prepared.color is not None, "all vertices have one colour"
        planes, values = prepared.color[0], display_list.color[0, :, 0].tolist()
    word = (planes.start[0] + (x - int(prepared.left[0])) * planes.step_x[0]
            + (y - int(prepared.top[0])) * planes.step_y[0])  # fmt: skip
    carried = Fraction(fixed_point.to_signed(int(word), planes.word_bits), 1 << fraction_bits)
    unit = 1 << display_list.sub_bits
    return carried - biased_value(display_list.position[0].tolist(), values,
                                  x * unit + unit // 2, y * unit + unit // 2)  # fmt: skip


def stored_errors(case: WorstCase) -> tuple[Int64, Int64]:
    """What is stored minus what should be, at every covered pixel, and the pixels' x + y.

    int64 (n,) each; of a colour the red channel.
    """
    right = exact.draw(case.display_list)
    got = bit_true.draw(case.display_list, fraction_bits=case.fraction_bits)
    assert np.array_equal(got.winner, right.winner)
    y, x = np.nonzero(right.winner == 0)
    if case.interpolant == "depth":
        return got.depth[y, x] - right.depth[y, x], x + y
    return got.color[y, x, 0].astype(np.int64) - right.color[y, x, 0], x + y


def _rounding(fraction: Float64) -> Float64:
    """floor(t + 1/2) - t for 0 <= t < 1: from -1/2 to 1/2."""
    return np.asarray(np.where(fraction >= 0.5, 1 - fraction, -fraction))


def _fraction(numerator: Int64, denominator: Int64 | int, fraction_bits: int) -> Float64:
    """The fraction of numerator / denominator * 2**F; denominators below 2**62."""
    rest = numerator % denominator
    for _ in range(fraction_bits):
        rest = rest * 2 % denominator
    return np.asarray(rest / denominator)


@dataclass(frozen=True)
class _Trials:
    """Triangles by their second and third vertex from the first and by their three values."""

    corners: Int64  # (2, 2, n): vertex, axis
    values: Int64  # (3, n)

    @property
    def double_area(self) -> Int64:
        (x1, y1), (x2, y2) = self.corners
        return np.asarray(x1 * y2 - x2 * y1)

    @property
    def slopes(self) -> Int64:
        """(2, n): the changes a sub-pixel unit to the right and down, times the doubled area."""
        (x1, y1), (x2, y2) = self.corners
        rise1, rise2 = self.values[1:] - self.values[0]
        return np.stack([rise1 * y2 - rise2 * y1, rise2 * x1 - rise1 * x2])


def _draw_trials(random: np.random.Generator, size: tuple[int, int], sub_bits: int,
                 limit: int) -> _Trials:
    # The last pixel's centre is less than the screen from the first vertex, by less than a
    # pixel.  The second vertex lies beyond it to the right and at least a pixel higher, the
    # third lower and left of it; both further out than in, so their edge passes beyond.
    screen = np.array(size)[:, None] << sub_bits
    most = np.minimum(screen // 2, _SPREAD << sub_bits)
    inwards = random.integers(1 << sub_bits, most // 2, (2, 2, _TRIALS))
    outwards = random.integers(most // 2, most, (2, 2, _TRIALS))
    out = np.eye(2, dtype=bool)[:, :, None]
    corners = screen + np.where(out, outwards, -inwards)
    return _Trials(corners, random.integers(0, limit, (3, _TRIALS), endpoint=True))


def _shift(slopes: Int64, double_area: int, unit: int, fraction_bits: int,
           sign: int) -> tuple[int, int]:
    """How far left of and above the first centre the first vertex is: (right, down) units."""
    offset = np.arange(unit)
    right, down = (_fraction(slope * offset, double_area, fraction_bits)
                   for slope in slopes)
    # What else the start holds is whole, but for the half and the bias, seen at large F.
    half = Fraction(2 * (double_area // 2) + 1, 2 * double_area) * (1 << fraction_bits) % 1
    start = (right[:, None] + down + float(half)) % 1
    first, second = np.unravel_index(np.argmax(sign * _rounding(start)), start.shape)
    return int(first), int(second)


def find_worst(
    *,
    width: int,
    height: int,
    interpolant: Interpolant,
    fraction_bits: int,
    seed: int,
    sub_bits: int = 8,
    depth_bits: int = 24,
) -> WorstCase:
    """The worst of a seeded search; some hundredths of a second.

    Errors are upwards for even seeds, downwards for odd ones.  ``InputError`` for numbers
    that no display list has, and for sides below 8 pixels.
    """
    fixed_point.check_fraction_bits(fraction_bits)
    check_whole("width", width, _SMALLEST, MAXIMUM_SIZE)
    check_whole("height", height, _SMALLEST, MAXIMUM_SIZE)
    check_whole("sub_bits", sub_bits, 1, 8)
    unit, sign = 1 << sub_bits, 1 - seed % 2 * 2
    limit = (1 << CHANNEL_BITS) - 1 if interpolant == "color" else (1 << depth_bits) - 2
    trials = _draw_trials(np.random.default_rng(seed), (width, height), sub_bits, limit)
    right, down = (
        sign * _rounding(_fraction(slope * unit, trials.double_area, fraction_bits))
        for slope in trials.slopes
    )
    best = int(np.argmax((width - 1) * right + (height - 1) * down))
    shift = _shift(trials.slopes[:, best], int(trials.double_area[best]), unit, fraction_bits, sign)
    first = unit // 2 - np.array(shift)
    position = np.stack([first, *(first + trials.corners[:, :, best])])
    values = trials.values[:, best]
    nothing = np.zeros_like(values)
    depth, color = (values, nothing) if interpolant == "depth" else (nothing, values)
    display_list = DisplayList(
        width=width,
        height=height,
        position=position[None].astype(np.int32),
        depth=depth[None],
        color=color[None, :, None].repeat(3, axis=2).astype(np.uint8),
        sub_bits=sub_bits,
        depth_bits=depth_bits,
    )
    x, y = width - 1, height - 1
    return WorstCase(
        display_list, interpolant, fraction_bits, seed, x, y,
        carried_error(display_list, interpolant, fraction_bits, x, y),
        fixed_point.error_bound(fraction_bits, x + y),
    )  # fmt: skip
