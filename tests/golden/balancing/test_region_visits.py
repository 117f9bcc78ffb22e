"""Visits of regions against a brute force in rational numbers, row by row and pixel by pixel."""

from collections import Counter
from fractions import Fraction
from math import ceil

import numpy as np
import pytest
from region_bench.lists import listed, random_list

from cardcage.golden.balancing.region_counts import counts_of, region_counts, utilisation
from cardcage.golden.balancing.region_grid import RegionGrid
from cardcage.golden.balancing.region_visits import region_visits
from cardcage.golden.hard_cases.rational import covered
from cardcage.golden.reference.coverage import Triangles, extents, spans
from cardcage.golden.specification.regions import Regions
from cardcage.golden.specification.sampling_grid import Grid

HALF = Fraction(1, 2)


class Rational:
    """The rows of one triangle, by the rules, in fractions."""

    def __init__(self, corners, width, height, unit):
        self.corners = [(Fraction(x, unit), Fraction(y, unit)) for x, y in corners]
        across, down = zip(*self.corners, strict=True)

        def held(value, limit):
            return min(max(ceil(value - HALF), 0), limit)

        self.width = width
        self.left, self.right = held(min(across), width), held(max(across), width)
        self.top, self.bottom = held(min(down), height), held(max(down), height)
        self.middle = ceil(sorted(down)[1] - HALF)

    @property
    def drawn(self):
        (ax, ay), (bx, by), (cx, cy) = self.corners
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        return area != 0 and self.left < self.right and self.top < self.bottom

    def extent(self, row):
        """Where the line through the row's centres enters and leaves the triangle."""
        y, places = row + HALF, []
        for begin in range(3):
            (ax, ay), (bx, by) = self.corners[begin], self.corners[(begin + 1) % 3]
            if ay != by and min(ay, by) <= y <= max(ay, by):
                places.append(ax + (bx - ax) * (y - ay) / (by - ay))
        return tuple(min(max(ceil(place - HALF), 0), self.width)
                     for place in (min(places), max(places)))


def expected_visits(display_list, grid, probes_only):
    """{(primitive, region): (first row, rows, fragments)}, in the order of the visits."""
    unit = 1 << display_list.sub_bits
    sampling = Grid.of(display_list)
    found = {}
    for primitive, corners in enumerate(display_list.position.tolist()):
        triangle = Rational(corners, display_list.width, display_list.height, unit)
        if not triangle.drawn:
            continue
        fragments = Counter()
        for (x, y), _ in covered(corners, sampling):
            fragments[sum(grid.x[1:] <= x), sum(grid.y[1:] <= y)] += 1
        box_columns = [i for i in range(grid.columns)
                       if grid.x[i] < triangle.right and triangle.left < grid.x[i + 1]]
        bands = [j for j in range(grid.rows)
                 if grid.y[j] < triangle.bottom and triangle.top < grid.y[j + 1]]
        for j in bands:
            rows = range(max(triangle.top, grid.y[j]), min(triangle.bottom, grid.y[j + 1]))
            columns = box_columns
            if len(box_columns) > 2 or len(bands) > 2:
                probed = ([row for row in rows
                           if row in (rows[0], rows[-1], triangle.middle - 1, triangle.middle)]
                          if probes_only else rows)
                edges = [triangle.extent(row) for row in probed]
                first, beyond = min(edges)[0], max(edge[1] for edge in edges)
                columns = [i for i in range(grid.columns)
                           if max(first, grid.x[i]) < min(beyond, grid.x[i + 1])]
            for i in columns:
                found[primitive, j * grid.columns + i] = (
                    rows[0], len(rows), fragments.pop((i, j), 0))
        assert not fragments, "a covered pixel in a region that is not visited"
    return found


GRIDS = {
    "powers": (RegionGrid.of(Regions(columns=5, rows=9, x_bits=4, y_bits=3)), 70, 66),
    "one": (RegionGrid.of(Regions(columns=1, rows=1, x_bits=7, y_bits=7)), 70, 66),
    "strips": (RegionGrid.of(Regions(columns=1, rows=18, x_bits=7, y_bits=2)), 70, 66),
    "pixels": (RegionGrid.of_size(24, 20, 1, 1), 24, 20),
    "any": (RegionGrid.of_size(70, 66, 9, 13), 70, 66),
    "columns": (RegionGrid.of_size(70, 66, 3, 66), 70, 66),
}


@pytest.mark.parametrize("probes_only", [False, True], ids=["every row", "probed rows"])
@pytest.mark.parametrize("name", GRIDS)
def test_visits_are_those_of_a_brute_force(name, probes_only):
    grid, width, height = GRIDS[name]
    seed = 1994 + list(GRIDS).index(name)
    print(f"seed {seed}")
    random = np.random.default_rng(seed)
    large = 0
    for sub_bits in (1, 4, 8):
        display_list = random_list(random, 60, width, height, sub_bits)
        expected = expected_visits(display_list, grid, probes_only)
        triangles = Triangles.of(display_list, Grid.of(display_list))
        for row_limit in (1, 50, 1 << 15):
            chunks = list(region_visits(triangles, grid, row_limit))
            got = {}
            for visits in chunks:
                rows = visits.extents
                assert np.array_equal(rows.triangle[visits.first], visits.triangle)
                got |= {(int(triangles.primitive[triangle]), int(region)): tuple(map(int, rest))
                        for triangle, region, *rest in zip(
                            visits.triangle, visits.region, rows.row[visits.first], visits.rows,
                            visits.fragments, strict=True)}
            assert got == expected
            assert list(got) == list(expected), "visits are in another order"
            parts = [(chunk.extents.begin, chunk.extents.end) for chunk in chunks]
            assert [begin for begin, _ in parts] == [0, *(end for _, end in parts[:-1])]
            assert parts[-1][1] == len(triangles)
        counts = region_counts(display_list, grid)
        triangle_counts, clocks = np.zeros((2, grid.count), int)
        for (_, region), (_, rows, fragments) in expected.items():
            triangle_counts[region] += 1
            clocks[region] += max(rows, fragments)
        assert np.array_equal(counts.triangles, triangle_counts)
        assert np.array_equal(counts.clocks, clocks)
        assert counts.drawn == len(triangles)
        large += sum(fragments == 0 for *_, fragments in expected.values())
    assert large, "no visit finds nothing"


def test_extents_are_the_spans_and_the_empty_rows():
    display_list = random_list(np.random.default_rng(7), 300, 70, 66, 8)
    triangles = Triangles.of(display_list, Grid.of(display_list))
    rows = list(extents(triangles, 100))
    found = [(int(t), int(y), int(first), int(beyond)) for chunk in rows for t, y, first, beyond in
             zip(chunk.triangle, chunk.row, chunk.first, chunk.beyond, strict=True)]
    assert len(found) == int((triangles.bottom - triangles.top).sum())
    assert all(0 <= first <= beyond <= 70 for *_, first, beyond in found)
    assert sum(first == beyond for *_, first, beyond in found) > 20
    assert [(t, y, first, beyond - first) for t, y, first, beyond in found if first < beyond] == [
        tuple(map(int, span)) for chunk in spans(triangles) for span in
        zip(chunk.triangle, chunk.row, chunk.first, chunk.length, strict=True)]


def test_a_sliver_visits_only_the_regions_along_it():
    """Of 32 regions its box meets all; along the diagonal there are 8, and their neighbours where
    it leaves one in the middle of a band."""
    sliver = listed([[0, 0], [512, 512], [504, 512]], 64, 64, 3)
    grid = RegionGrid.of(Regions(columns=4, rows=8, x_bits=4, y_bits=3))
    counts = region_counts(sliver, grid)
    assert np.flatnonzero(counts.triangles).tolist() == [0, 4, 9, 13, 18, 22, 27, 31]
    assert counts.clocks[counts.triangles > 0].tolist() == [8] * 8
    assert counts.overlap_factor == 8.0


def test_utilisation_is_the_mean_load_over_the_greatest():
    counts = np.array([5, 1, 0, 2])
    assert utilisation(counts, np.array([0, 1, 0, 1]), 2) == 8 / (2 * 5)
    assert utilisation(counts, np.array([0, 1, 2, 1]), 3) == 8 / (3 * 5)
    assert utilisation(counts * 0, np.array([0, 1, 0, 1]), 2) == 1.0


def test_overlap_factor_is_molnars_for_boxes_of_one_size():
    """Right triangles whose corners lie anywhere: their boxes are of 12 × 8 pixels."""
    random = np.random.default_rng(1991)
    at = random.integers(0, [(640 - 12) << 4, (512 - 8) << 4], (4000, 1, 2))
    display_list = listed(at + np.array([[0, 0], [12 << 4, 0], [0, 8 << 4]]), 640, 512, 4)
    counts = counts_of(Triangles.of(display_list, Grid.of(display_list)),
                       RegionGrid.of_size(640, 512, 40, 32))
    # A box of 12 pixels, at one of 628 places, has 11 boundaries between pixels, and lies in two
    # columns of regions where one of these is one of their 15.
    expected = (1 + 15 * 11 / 628) * (1 + 15 * 7 / 504)
    assert counts.overlap_factor == pytest.approx(expected, rel=0.02)
