"""The error bound, exhaustively: every triangle on tiny grids, at every precision up to exact.

Each triangle meets every combination of vertex values; a quarter of them is given as depths, the
others as red, green and blue, which the same set-up and stepping carry in words of their own.
"""

from itertools import combinations, permutations, product
from typing import NamedTuple

import numpy as np
import pytest
from suite.cases import chosen

from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import prepare, scene_fraction_bits
from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.display_list import DisplayList

ORDERS = np.array(list(permutations(range(3))))


class Case(NamedTuple):
    """Vertices on all points low … high of a grid of 2**-sub_bits pixel, both ways."""

    size: int
    sub_bits: int
    depth_bits: int
    low: int
    high: int
    rows: int  # of each triangle, with four combinations of values each

    def display_list(self):
        points = np.array(list(product(range(self.low, self.high + 1), repeat=2)), np.int32)
        triples = np.array(list(combinations(range(len(points)), 3)))
        # Each triple in one of the six orders, so that windings and first vertices differ.
        orders = ORDERS[np.arange(len(triples)) * 5 % 6]
        position = points[np.take_along_axis(triples, orders, axis=1)]
        greatest = 2**self.depth_bits - 2
        values = np.array(list(product(range(greatest + 1), repeat=3)))
        # All combinations where rows are many enough; else others for each triangle.
        use = np.arange(4 * self.rows) + np.arange(len(triples))[:, None] * (4 * self.rows + 1)
        depth, *color = np.split(values[use % len(values)], 4, axis=1)
        # Channels at the lower and the upper end of their range, and far apart.
        channels = [color[0], 255 - color[1], color[2] * (255 // greatest)]
        return DisplayList(
            self.size, self.size, position.repeat(self.rows, axis=0),
            depth.reshape(-1, 3),
            np.stack([channel.reshape(-1, 3) for channel in channels], axis=2).astype(np.uint8),
            sub_bits=self.sub_bits, depth_bits=self.depth_bits)


CASES = {
    # Every triangle, every value.
    "3x3, half pixels": Case(3, 1, 2, 0, 6, 7),
    "2x2, half pixels, three bits": Case(2, 1, 3, 0, 4, 86),
    # Every triangle, some values of each.
    "4x4, half pixels": Case(4, 1, 2, 0, 8, 1),
    "2x2, quarter pixels": Case(2, 2, 3, 0, 8, 1),
    "2x2, beyond the screen": Case(2, 1, 2, -3, 5, 1),
}
NAMES = chosen(CASES, "4x4, half pixels", "2x2, quarter pixels", "2x2, beyond the screen")


class Truth:
    """Every fragment of a list, with the numerators of its planes by barycentric weights."""

    def __init__(self, display_list):
        self.fragments = fragments = exact.fragments(display_list)
        self.triangle = fragments.primitive
        corners = display_list.position[self.triangle].astype(np.int64)
        unit = 1 << display_list.sub_bits
        x, y = (axis.astype(np.int64) * unit + unit // 2 for axis in (fragments.x, fragments.y))
        weights = []
        for vertex in range(3):
            (ax, ay), (bx, by) = (corners[:, (vertex + turn) % 3].T for turn in (1, 2))
            weights.append((bx - ax) * (y - ay) - (x - ax) * (by - ay))
        weights = np.stack(weights, axis=1)
        area = weights.sum(axis=1)
        assert (weights * np.sign(area)[:, None] >= 0).all()
        self.area = abs(area)
        self.weights = weights * np.sign(area)[:, None]

    def numerator(self, values):
        """The plane through ``values`` (triangles, 3) at each fragment, times the doubled area."""
        return (self.weights * values[self.triangle]).sum(axis=1)


def interpolants(display_list, prepared):
    """Planes, vertex values and greatest stored value, of depth and the channels."""
    yield prepared.depth, display_list.depth, display_list.depth_limit
    for channel, planes in enumerate(prepared.color):
        yield planes, display_list.color[:, :, channel].astype(np.int64), 255


@pytest.mark.parametrize("name", NAMES)
def test_every_triangle_of_a_tiny_grid(name):
    case = CASES[name]
    display_list = case.display_list()
    truth = Truth(display_list)
    exact_bits = scene_fraction_bits(display_list)
    ends = [(values.min(axis=1)[truth.triangle], values.max(axis=1)[truth.triangle])
            for _, values, _ in interpolants(display_list, prepare(display_list, fraction_bits=0))]
    values = set(map(tuple, display_list.depth.tolist()))
    assert len(values) == (2**case.depth_bits - 1) ** 3
    worst_share, beyond, needed, outside, differing = 0.0, 0, 0, 0, []
    for fraction_bits in range(exact_bits + 2):
        prepared = prepare(display_list, fraction_bits=fraction_bits)
        index = np.searchsorted(prepared.primitive, truth.triangle)
        right = truth.fragments.x - prepared.left[index]
        down = truth.fragments.y - prepared.top[index]
        pixels = (1 + right + down).astype(np.int64)
        area = truth.area
        wrong = 0
        for (planes, vertex_values, high), (least, greatest) in zip(
                interpolants(display_list, prepared), ends, strict=True):
            start, step_x, step_y = (part.astype(np.int64)[index] for part in
                                     (planes.start, planes.step_x, planes.step_y))
            word = fixed_point.wrap(start + right * step_x + down * step_y, planes.word_bits)
            carried = fixed_point.to_signed(word, planes.word_bits)
            # Everything times 2 D 2**F.  Strict below: halves are rounded up, never down.
            numerator = truth.numerator(vertex_values)
            biased = 2 * (numerator + area // 2) + 1
            error = (2 * area * carried) - (biased << fraction_bits)
            assert (error > -pixels * area).all() and (error <= pixels * area).all()
            worst_share = max(worst_share, (abs(error) / (pixels * area)).max())
            # Below a bound of 1/4 the half alone keeps it between the vertices: nothing is
            # saturated, and no sign is needed.  With one bit less some leave the whole range.
            whole = carried >> fraction_bits
            inside = 2 * pixels < 1 << fraction_bits
            assert ((whole >= least) & (whole <= greatest))[inside].all()
            a_bit_less = ~inside & (pixels < 1 << fraction_bits)
            outside += int(np.count_nonzero(((whole < 0) | (whole > high))[a_bit_less]))
            # Against the value and a half alone the bias counts, where D is even and 2**F a
            # multiple of its powers of two; elsewhere no start is rounded that far.
            unbiased = error + ((biased - 2 * numerator - area) << fraction_bits)
            counts = (area % 2 == 0) & (area % (2 << fraction_bits) != 0)
            assert (abs(unbiased) <= pixels * area + np.where(counts, 1 << fraction_bits, 0)).all()
            beyond += int(np.count_nonzero(abs(unbiased) > pixels * area))

            rounded = (numerator + area // 2) // area
            stored = bit_true.evaluate(planes, fraction_bits, index, right, down, high)
            off = abs(stored - rounded)
            assert (off <= -(-pixels >> fraction_bits + 1)).all()
            assert not off[area * pixels < 1 << fraction_bits].any()
            assert stored.min() >= 0 and stored.max() <= high
            wrong += int(np.count_nonzero(off))
            a_bit_less = off[(area * pixels) >> fraction_bits == 1]
            needed += int(np.count_nonzero(a_bit_less))
            if vertex_values is display_list.depth:
                assert np.array_equal(rounded, truth.fragments.depth)
        differing.append(wrong)
    print(f"{name}: {display_list.triangles} triangles, {len(truth.area)} fragments, four values "
          f"each; F = 0 … {exact_bits + 1}: {differing} wrong; worst error {worst_share:.4f} of "
          f"the bound; {beyond} beyond it by the bias; {needed} wrong "
          f"with one bit less than enough for them; {outside} out of range with one bit less than "
          "keeps them in it")
    assert worst_share == 1 and beyond > 0 and needed > 0 and outside > 0
    assert differing[exact_bits:] == [0, 0] and differing[0] > 0
    assert sorted(differing, reverse=True) == differing
    assert len(truth.area) > 10_000
