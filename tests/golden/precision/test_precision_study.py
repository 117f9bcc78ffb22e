"""Precision by precision: no bound exceeded, nothing wrong at exact."""

from dataclasses import replace

import numpy as np
import pytest

from cardcage.golden.precision.precision_study import (
    DEPTH_BITS,
    SUB_BITS,
    PrecisionStudy,
    formats,
    picture_error,
)
from cardcage.golden.precision.unquantised import (
    UnquantisedScene,
    unquantised_scene,
)
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import in_finer_words, prepare
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.picture import Picture


def study_of(scene, **size):
    listed = make_display_list(scene, **size).display_list
    return PrecisionStudy(listed, unquantised_scene(scene, listed))


@pytest.mark.parametrize("scene", [
    "teapot", "sphereflake", "hard:sliver-fan", "hard:crossing-3-lsb", "hard:full-screen"])
def test_the_sweep(scene):
    study = study_of(scene)
    points = [study.at_fraction_bits(bits) for bits in study.sweep()]
    assert points[0].fraction_bits == 0 and len(points) > 8
    assert points[-1].fraction_bits == study.exact_fraction_bits
    for point in points:
        error = point.error
        assert max(error.depth_maximum, error.color_maximum, error.depth_anywhere) <= point.bound
        assert point.within_bound
    last = points[-1].error
    assert (last.depth_maximum, last.depth_mean, last.wrong_pixels, last.color_maximum) == (0,) * 4
    assert last.pixels > 300
    # The bound is no luxury: without fraction bits a good part of it is used.
    coarsest = points[0].error
    assert coarsest.depth_maximum >= 2
    assert max(coarsest.depth_maximum, coarsest.color_maximum) >= points[0].bound / 4
    assert [point.bound for point in points] == sorted((point.bound for point in points),
                                                       reverse=True)
    if scene == "hard:crossing-3-lsb":
        wrong = [point.error.wrong_pixels for point in points]
        assert wrong == sorted(wrong, reverse=True) and wrong[0] > 100 and wrong[-1] == 0
        assert 0 < wrong[1] < wrong[0]


def test_within_bound_can_fail():
    study = study_of("hard:full-screen")
    point = study.at_fraction_bits(2)
    assert point.within_bound
    worse = replace(point, error=replace(point.error, depth_anywhere=point.bound + 1.0))
    assert not worse.within_bound
    assert not replace(point, error=replace(point.error, color_maximum=point.bound + 1.0)
                       ).within_bound
    done = study.at_fraction_bits(study.exact_fraction_bits)
    for field in ("wrong_pixels", "depth_maximum", "color_maximum"):
        assert not replace(done, error=replace(done.error, **{field: 1})).within_bound


def test_one_fraction_bit_less_than_exact_is_bounded_by_one():
    study = study_of("teapot:tessellation=3")
    assert study.bound(study.exact_fraction_bits - 1) == 1
    assert study.bound(study.exact_fraction_bits) == study.bound(64) == 0
    within_one = next(bits for bits in range(64) if study.bound(bits) <= 1)
    assert within_one in study.sweep()


def test_end_to_end_falls_with_finer_formats():
    study = study_of("sphereflake:depth=1")
    assert formats(8, 24) == sorted({*((bits, 24) for bits in SUB_BITS),
                                     *((8, bits) for bits in DEPTH_BITS)})
    by_sub = [study.at_format(bits, 24) for bits in SUB_BITS]
    wrong = [point.end_to_end.wrong_pixels for point in by_sub]
    mean = [point.end_to_end.depth_mean for point in by_sub]
    assert wrong == sorted(wrong, reverse=True) and mean == sorted(mean, reverse=True)
    assert wrong[0] > 10 * wrong[-1] and mean[0] > 10 * mean[-1]
    exact_bits = [point.exact_fraction_bits for point in by_sub]
    assert exact_bits == sorted(exact_bits) and exact_bits[-1] == study.exact_fraction_bits
    # As a share of the range, the error of a depth falls until that of the vertices is left.
    shares = [study.at_format(8, bits).end_to_end.depth_mean / 2**bits for bits in DEPTH_BITS]
    assert shares[0] > 8 * shares[1] > 8 * shares[2]
    assert shares[-1] == pytest.approx(shares[-2], rel=0.05)
    # The machine at exact is the format's own line.
    own = study.at_fraction_bits(study.exact_fraction_bits).end_to_end
    assert own == study.at_format(8, 24).end_to_end


def test_a_display_list_alone_is_half_an_lsb_off():
    listed = make_display_list("random:n=60,size=30,seed=8").display_list
    study = PrecisionStudy(listed, UnquantisedScene.of_display_list(listed))
    error = study.at_fraction_bits(study.exact_fraction_bits).end_to_end
    assert error.wrong_pixels == 0
    assert 0.4 < error.depth_maximum <= 0.5 + 1e-5 and 0.2 < error.depth_mean < 0.3


def test_float32_stands_beside():
    point = study_of("hard:full-screen").in_float32()
    assert point.error.wrong_pixels == 0 and 0 < point.error.depth_maximum < 10
    assert study_of("hard:other-diagonal").in_float32().error.wrong_pixels > 0


def test_picture_error_by_hand():
    def picture(winner, depth, red):
        color = np.zeros((1, 5, 3), np.uint8)
        color[0, :, 0] = red
        return Picture(color, np.array([depth], np.int64), np.array([winner], np.int32))

    got = picture([0, 1, 1, -1, -1], [10, 20, 33, 255, 255], [5, 5, 9, 0, 0])
    right = picture([0, 1, 2, 3, -1], [12, 20, 30, 40, 255], [4, 5, 0, 0, 0])
    error = picture_error(got, right.winner, right.depth, right.color)
    assert (error.pixels, error.wrong_pixels) == (4, 2)
    assert (error.depth_maximum, error.depth_mean, error.depth_anywhere) == (2, 1, 3)
    assert error.color_maximum == 1 and not error.none


def test_coarser_resolution_and_flat():
    listed = make_display_list("teapot:tessellation=3").display_list
    study = PrecisionStudy(listed, unquantised_scene("teapot:tessellation=3", listed),
                           shading="flat", x_shift=1, y_shift=1)
    assert study.exact.depth.shape == (32, 32)
    point = study.at_fraction_bits(study.exact_fraction_bits)
    assert point.error.none and point.end_to_end.wrong_pixels < 10
    # A first vertex' colour is rounded once.
    assert point.end_to_end.color_maximum <= 0.5 + 1e-9


def test_an_empty_list():
    empty = DisplayList(4, 4, np.zeros((0, 3, 2), np.int32), np.zeros((0, 3), np.int64),
                        np.zeros((0, 3, 3), np.uint8))
    study = PrecisionStudy(empty, UnquantisedScene.of_display_list(empty))
    assert study.sweep() == [0]
    point = study.at_fraction_bits(0)
    assert point.within_bound and point.error.pixels == 0
    assert study.in_float32().error.none and study.at_format(1, 8).end_to_end.none


@pytest.mark.parametrize("shading", ["flat", "gouraud"])
def test_finer_words_hold_the_same_planes(shading):
    """Every value at every covered pixel, as the machine evaluates it."""
    listed = make_display_list("random:n=50,size=30,seed=6").display_list
    coarse = prepare(listed, fraction_bits=5, shading=shading)
    fine = in_finer_words(coarse, 23)
    assert fine.fraction_bits == 23 and (fine.color is None) == (shading == "flat")
    fragments = exact.fragments(listed)
    triangle = np.searchsorted(coarse.primitive, fragments.primitive)
    right = fragments.x - coarse.left[triangle]
    down = fragments.y - coarse.top[triangle]
    planes = [(coarse.depth, fine.depth, listed.depth_limit)]
    if shading == "gouraud":
        planes += [(one, other, 255) for one, other in zip(coarse.color, fine.color, strict=True)]
    for one, other, high in planes:
        assert other.word_bits == one.word_bits + 18
        assert np.array_equal(bit_true.evaluate(one, 5, triangle, right, down, high),
                              bit_true.evaluate(other, 23, triangle, right, down, high))
    with pytest.raises(ValueError, match="23 fraction bits do not fit in 5"):
        in_finer_words(fine, 5)
