"""Cures on counts that are chosen so that one knows what comes."""

import numpy as np
import pytest

from cardcage.testbenches.figures.ellsworth.dealing.cures import CURES, Seen
from cardcage.testbenches.figures.ellsworth.dealing.frame_loads import BoxLoads

SHAPE = (3, 4)
BY_NAME = {cure.name: cure for cure in CURES}


def ints(values):
    return np.array(values, np.int64)


def seen(last, before=None, third=None, boxes=(1, 1), pixels=(1, 1)):
    last = ints(last)
    before = last if before is None else ints(before)
    third = before if third is None else ints(third)
    return Seen((last, before, third), last // 2, tuple(
        BoxLoads(np.full(12, count, np.int64), np.broadcast_to(ints(pixel), 12))
        for count, pixel in zip(boxes, pixels, strict=True)), SHAPE)


def counts(name, *arguments, **keywords):
    return BY_NAME[name].counts(seen(*arguments, **keywords)).tolist()


RISING = [10 * place for place in range(12)]
LEVEL = [50] * 12
SPIKE = [0] * 5 + [1600] + [0] * 6


@pytest.mark.parametrize("cure", CURES, ids=BY_NAME)
def test_whole_counts_from_nothing_too(cure):
    for told in (seen([0] * 12, pixels=(0, 0)), seen([0] * 12, LEVEL, RISING), seen(RISING, LEVEL)):
        found = cure.counts(told)
        assert found.dtype == np.int64 and found.shape == (12,) and found.min() >= 0


def test_extrapolation_stops_at_nothing():
    assert counts("extrapolated", [5, 9] + [0] * 10, [9, 5] + [0] * 10) == [1, 13] + [0] * 10
    assert counts("extrapolated", [1] * 12, [9] * 12) == [0] * 12
    assert counts("half extrapolated", [6] * 12, [2] * 12) == [8] * 12
    assert counts("extrapolated where it grows", [5, 9] + [0] * 10, [9, 5] + [0] * 10) == [
        5, 13] + [0] * 10


def test_blurring_keeps_the_sum_within_the_screen():
    blurred = np.reshape(counts("blurred", SPIKE), SHAPE)
    assert blurred.sum() == 1600
    assert blurred[:, :3].tolist() == [[100, 200, 100], [200, 400, 200], [100, 200, 100]]
    assert counts("blurred", LEVEL) == LEVEL
    assert counts("blurred a little", SPIKE)[5] == 1225  # 7/8 of 7/8


def test_growth_goes_on_as_it_did():
    third = ints(RISING)
    growth = ints([8, -4, 16, 0] * 3) * 4
    for factor, wanted in ((0.5, 0.5), (-0.25, -0.25), (9, 1.5), (-9, -0.5)):
        before = third + growth + 1000
        last = before + (factor * growth).astype(np.int64)
        found = BY_NAME["growth learnt"].counts(seen(last, before, third + 1000))
        assert found.tolist() == np.maximum(
            np.rint(last + wanted * (last - before)), 0).astype(int).tolist(), factor


def test_blur_is_learnt():
    """Where counts do nothing but spread, so does the estimate."""
    def spread(values):
        return np.rint(seen(values).blurred(np.array(values, float), 1 / 4)).astype(np.int64)

    third = ints(SPIKE) * 1000
    before = spread(third)
    last = spread(before)
    learnt = BY_NAME["growth and blur learnt"].counts(seen(last, before, third))
    plain = BY_NAME["last frame's clocks"].counts(seen(last, before, third))
    assert np.abs(learnt - spread(last)).sum() < np.abs(plain - spread(last)).sum() / 2


def test_boxes():
    assert counts("coming boxes", LEVEL, boxes=(7, 3)) == [7] * 12
    assert counts("coming boxes' pixels", LEVEL, pixels=(7, 3)) == [7] * 12
    assert counts("coming boxes at last frame's cost", RISING, pixels=(6, 2)) == [
        3 * each for each in RISING]
    # A region without a box in the last frame costs what all did.
    last = [2] + [1] * 10 + [0]
    pixels = ([4] * 12, [4] + [4] * 10 + [0])
    assert counts("coming boxes at last frame's cost", [40 * each for each in last],
                  pixels=pixels)[-2:] == [40, round(4 * 480 / 44)]
