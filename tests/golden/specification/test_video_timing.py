"""Raster timings."""

import pytest

from cardcage.golden.specification.video_timing import (
    STANDARD_TIMINGS,
    VideoTiming,
    compact_timing,
    video_timing,
)


@pytest.mark.parametrize(("size", "clock", "frequency", "totals"), [
    # Pixel clock in Hz, field rate in Hz, totals: VESA DMT.
    ((640, 480), 25_175_000, 59.94, (800, 525)),
    ((800, 600), 40_000_000, 60.317, (1056, 628)),
    ((1024, 768), 65_000_000, 60.004, (1344, 806)),
    ((1280, 720), 74_250_000, 60.0, (1650, 750)),
])
def test_standard_timings(size, clock, frequency, totals):
    timing = STANDARD_TIMINGS[size]
    assert (timing.horizontal_active, timing.vertical_active) == size
    assert (timing.horizontal_total, timing.vertical_total) == totals
    assert clock / timing.pixels == pytest.approx(frequency, abs=0.005)


def test_totals():
    timing = VideoTiming(7, 1, 2, 3, 5, 2, 3, 4)
    assert (timing.horizontal_total, timing.vertical_total, timing.pixels) == (13, 14, 13 * 14)


def test_standard_where_there_is_one_compact_elsewhere():
    assert video_timing(640, 480) is STANDARD_TIMINGS[640, 480]
    assert video_timing(64, 48) == compact_timing(64, 48)
    compact = compact_timing(64, 48)
    assert (compact.horizontal_active, compact.vertical_active) == (64, 48)
    assert (compact.horizontal_total, compact.vertical_total) == (68, 51)


@pytest.mark.parametrize("field", [
    "horizontal_active", "horizontal_front", "horizontal_sync", "horizontal_back",
    "vertical_active", "vertical_front", "vertical_sync", "vertical_back"])
def test_every_figure_is_at_least_one(field):
    figures = dict.fromkeys(VideoTiming.__dataclass_fields__, 1)
    with pytest.raises(ValueError, match=field):
        VideoTiming(**figures | {field: 0})
