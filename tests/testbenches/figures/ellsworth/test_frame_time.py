"""The performance model on numbers that are chosen."""

import pytest

from cardcage.testbenches.figures.ellsworth.dealing.model_dealing import ModelDealing
from cardcage.testbenches.figures.ellsworth.dealing.models import FigureModel
from cardcage.testbenches.figures.ellsworth.frame_time import (
    RATIOS,
    Costs,
    best_ratio,
    frame_time,
    mean_times,
    relative_times,
)

PROCESSORS = (2, 4)


def dealing(utilisation, overlap=lambda regions: 1.0):
    """100 triangles of 10 clocks; ``utilisation`` of a ratio."""
    regions = [each * ratio for each in PROCESSORS for ratio in RATIOS]
    return ModelDealing(FigureModel("any", "any", 1, 1.0), (9, 9), {
        "given": [120], "drawn": [100],
        "visits": {str(each): [100 * overlap(each)] for each in regions},
        "clocks": {str(each): [1000] for each in regions},
        "utilisation": {str(each): {str(ratio): {"triangles, last frame": [utilisation(ratio)]}
                                    for ratio in RATIOS} for each in PROCESSORS}})


def test_parts_of_a_frame():
    even = dealing(lambda ratio: 1.0)
    assert frame_time(even, 4, 8, Costs(1, 0, 0, 0)) == (120 + 1000) / 4
    assert frame_time(even, 4, 8, Costs(0, 3, 0, 0)) == (300 + 1000) / 4
    assert frame_time(even, 4, 8, Costs(0, 0, 3, 0)) == (300 + 1000) / 4
    assert frame_time(even, 4, 8, Costs(0, 0, 0, 5)) == 250 + 40
    half = dealing(lambda ratio: 0.5)
    assert frame_time(half, 2, 8, Costs(1, 1, 3, 0)) == (120 + 100 + 2 * 1300) / 2


def test_relative_to_the_mean():
    found = relative_times(dealing(lambda ratio: ratio / 12), Costs(0, 0, 0, 0))
    for times in found.values():
        assert sum(times) == pytest.approx(len(RATIOS))
        assert times[0] / times[-1] == pytest.approx(6)
    assert mean_times(dealing(lambda ratio: 0.5), Costs(0, 0, 0, 0)) == [1.0] * len(RATIOS)


def test_the_best_ratio():
    better = dealing(lambda ratio: ratio / 12, lambda regions: 1 + regions / 24)
    assert best_ratio(better, Costs(0, 0, 0, 0)) == 12
    assert best_ratio(better, Costs(0, 0, 0, 1000)) == 2
    assert best_ratio(better, Costs(0, 10_000, 0, 0)) == 2
