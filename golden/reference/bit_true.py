"""The datapath's picture, bit for bit, at a given number of fraction bits.

Coverage is exact at any precision.  Depth and colour are what ``triangle_setup``
computes and a machine carries: start and increments rounded at 2**-F, summed
modulo a power of two, floored, read as signed, saturated; where errors are
small (``fixed_point.stays_in_range``) the last two change nothing.  With enough
fraction bits (``triangle_setup.scene_fraction_bits``) the picture equals ``exact``'s;
with fewer, depth and colour err by at most ``fixed_point.error_bound`` before the floor.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..specification import fixed_point
from ..specification.display_list import DisplayList, Shading, shading_for
from ..specification.picture import Picture
from ..specification.ranges import CHANNEL_BITS
from .coverage import FRAGMENT_LIMIT, ROW_LIMIT, Triangles, spans
from .depth_buffer import DepthBuffer
from .triangle_setup import Planes, PreparedTriangles, prepare

Int64 = NDArray[np.int64]

#: A carried word is summed in two limbs; the lower one has this many bits, so
#: that two products with a pixel count (below 2**13) and a start fit 63 bits.
_LOW_BITS = 48
_LOW_MASK = (1 << _LOW_BITS) - 1


def evaluate(
    planes: Planes, fraction_bits: int, triangle: Int64, right: Int64, down: Int64, high: int
) -> Int64:
    """What is stored: carried value, floored, read as signed, saturated to [0, high].

    ``triangle`` indexes ``planes``; ``right`` and ``down`` count pixels from the
    triangle's left column and top row, 0 … 2**13.  All int64 (n,), as is the result.
    """
    return _Limbs(planes, fraction_bits, high).at(triangle, right, down)


class _Limbs:
    """Planes cut into two int64 limbs, since a carried word may exceed 64 bits."""

    def __init__(self, planes: Planes, fraction_bits: int, high: int) -> None:
        self._low = [_limb(part & _LOW_MASK) for part in _parts(planes)]
        # At most 36 value and guard bits and 64 fraction bits: 52 bits are left.
        self._high = [_limb(part >> _LOW_BITS) for part in _parts(planes)]
        self._fraction_bits = fraction_bits
        self._value_bits = planes.word_bits - fraction_bits
        self._limit = high

    def at(self, triangle: Int64, right: Int64, down: Int64) -> Int64:
        def total(limbs: list[Int64]) -> Int64:
            start, step_x, step_y = (limb.take(triangle) for limb in limbs)
            return np.asarray(start + step_x * right + step_y * down)

        low = total(self._low)
        # Modulo 2**64, of which the word's upper bits are the lowest.
        high = total(self._high) + (low >> _LOW_BITS)
        low &= _LOW_MASK
        if self._fraction_bits <= _LOW_BITS:
            whole = (high << (_LOW_BITS - self._fraction_bits)) | (low >> self._fraction_bits)
        else:
            whole = high >> (self._fraction_bits - _LOW_BITS)
        return fixed_point.saturate(fixed_point.to_signed(whole, self._value_bits), 0, self._limit)


def _parts(planes: Planes) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    return planes.start, planes.step_x, planes.step_y


def _limb(part: NDArray[Any]) -> Int64:
    return part.astype(np.int64)


def draw(
    display_list: DisplayList,
    *,
    fraction_bits: int,
    shading: Shading | None = None,
    x_shift: int = 0,
    y_shift: int = 0,
) -> Picture:
    """The picture a machine with ``fraction_bits`` draws of ``display_list``.

    Depth saturates to 0 … 2**depth_bits - 2, so that a fragment always beats
    the background; the winner is the least (depth, primitive) of what is stored.
    ``shading`` as in ``exact.draw``.  Raises ``InputError`` for fraction bits or
    shifts out of range.
    """
    prepared = prepare(
        display_list,
        fraction_bits=fraction_bits,
        shading=shading_for(display_list, shading),
        x_shift=x_shift,
        y_shift=y_shift,
    )
    triangles = Triangles.of(display_list, prepared.grid)
    # Coverage and set-up each leave out triangles by a test of their own; both
    # keep the drawing order, so one's numbers are found among the other's.
    found = np.searchsorted(prepared.primitive, triangles.primitive)
    assert np.array_equal(prepared.primitive.take(found, mode="clip"), triangles.primitive)
    depth = _Limbs(prepared.depth, fraction_bits, display_list.depth_limit)
    buffer = DepthBuffer(prepared.grid)
    for rows in spans(triangles, ROW_LIMIT):
        for runs in rows.chunks(FRAGMENT_LIMIT):
            span, column = runs.expand()
            triangle = found.take(runs.triangle.take(span))
            right = (runs.first.take(span) + column) - prepared.left.take(triangle)
            down = runs.row.take(span) - prepared.top.take(triangle)
            buffer.add(runs, span, column, depth.at(triangle, right, down))
    return buffer.picture(
        display_list, triangles,
        lambda seen: _colors(prepared, found.take(seen.triangle), seen.x, seen.y))


def _colors(prepared: PreparedTriangles, triangle: Int64, x: Int64, y: Int64) -> NDArray[np.uint8]:
    """uint8 (n, 3): the colours of ``triangle`` at (x, y), as stored."""
    if prepared.color is None:
        assert prepared.flat_color is not None
        return prepared.flat_color.take(triangle, axis=0)
    right, down = x - prepared.left.take(triangle), y - prepared.top.take(triangle)
    channels = [
        evaluate(planes, prepared.fraction_bits, triangle, right, down, (1 << CHANNEL_BITS) - 1)
        for planes in prepared.color
    ]
    return np.stack(channels, axis=-1).astype(np.uint8)
