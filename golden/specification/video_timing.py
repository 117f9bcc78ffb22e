"""Raster timing of the video scan generator, in pixels and lines."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class VideoTiming:
    """One scan: sync, back porch, active picture, front porch, in that order, on both axes.

    Horizontal figures are in pixels of the highest resolution, vertical ones in lines.
    ``*_sync_positive``: the level of the sync pin during the pulse.
    """

    horizontal_active: int
    horizontal_front: int
    horizontal_sync: int
    horizontal_back: int
    vertical_active: int
    vertical_front: int
    vertical_sync: int
    vertical_back: int
    horizontal_sync_positive: bool = False
    vertical_sync_positive: bool = False

    def __post_init__(self) -> None:
        for name in ("horizontal_active", "horizontal_front", "horizontal_sync", "horizontal_back",
                     "vertical_active", "vertical_front", "vertical_sync", "vertical_back"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name} must be at least 1, not {getattr(self, name)}")

    @property
    def horizontal_total(self) -> int:
        return (self.horizontal_active + self.horizontal_front + self.horizontal_sync
                + self.horizontal_back)

    @property
    def vertical_total(self) -> int:
        return (self.vertical_active + self.vertical_front + self.vertical_sync
                + self.vertical_back)

    @property
    def pixels(self) -> int:
        """Pixel times of one whole scan, blanking included."""
        return self.horizontal_total * self.vertical_total


#: Industry standard timings (VESA DMT), by active size.
STANDARD_TIMINGS = {
    (640, 480): VideoTiming(640, 16, 96, 48, 480, 10, 2, 33),  # 25.175 MHz, 60 Hz
    (800, 600): VideoTiming(800, 40, 128, 88, 600, 1, 4, 23, True, True),  # 40 MHz, 60 Hz
    (1024, 768): VideoTiming(1024, 24, 136, 160, 768, 3, 6, 29),  # 65 MHz, 60 Hz
    (1280, 720): VideoTiming(1280, 110, 40, 220, 720, 5, 5, 20, True, True),  # 74.25 MHz, 60 Hz
}


def compact_timing(width: int, height: int) -> VideoTiming:
    """The least blanking that still shows every edge: for simulation, and sizes of no standard."""
    return VideoTiming(width, 1, 2, 1, height, 1, 1, 1)


def video_timing(width: int, height: int) -> VideoTiming:
    """The standard timing of that size where there is one, else the compact one."""
    return STANDARD_TIMINGS.get((width, height)) or compact_timing(width, height)
