"""The overlap factor, by hand."""

import numpy as np
import pytest

from cardcage.testbenches.figures.ellsworth import overlap
from cardcage.testbenches.figures.ellsworth.overlap import (
    OverlapJob,
    by_regions,
    by_shape,
    expected_overlap,
    overlap_jobs,
)


@pytest.fixture
def few(tmp_path, monkeypatch):
    monkeypatch.setenv("CARDCAGE_CACHE", str(tmp_path))
    monkeypatch.setattr(overlap, "COUNT", 2000)


def test_molnar():
    assert expected_overlap((8, 8), (8, 8)) == 4
    assert expected_overlap((0, 5), (40, 20)) == 1.25


def test_measured_is_as_expected_of_small_triangles(few):
    found = OverlapJob((128, 96), 4).run()
    assert [each.regions for each in found] == [16, 64, 256]
    for each in found:
        assert each.measured == pytest.approx(each.expected_of_centres, rel=0.03)
        assert each.measured < each.expected
        assert each.box == pytest.approx((2.0, 2.0), rel=0.1)
    assert OverlapJob((128, 96), 4).run() == found  # as they were kept


def test_large_triangles_visit_fewer_than_their_boxes_meet(few):
    each = OverlapJob((128, 96), 64).run()[-1]
    assert each.measured < 0.6 * each.expected_of_centres


def test_shapes_are_of_one_size_of_triangles(few):
    found = [each for job in overlap_jobs((128, 96)) for each in job.run()]
    assert list(by_regions(found)) == [4, 8, 16, 32, 64]
    assert all(each.nearly_square for several in by_regions(found).values() for each in several)
    shapes = by_shape(found)
    assert {each.side for each in shapes} == {16} and {each.regions for each in shapes} == {256}
    assert np.all([each.columns <= 128 and each.rows <= 96 for each in shapes])
    assert min(shapes, key=lambda each: each.measured).columns == 16
    assert [job.side for job in overlap_jobs((40, 30))] == [4, 8, 16]
