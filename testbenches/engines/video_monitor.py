"""Puts pictures together from what leaves the video pins."""

from __future__ import annotations

import numpy as np

from ...golden.specification.commands import CHANNELS, unpack
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import CHANNEL_BITS
from .engine import Scan


class VideoMonitor:
    """Follows sync and active like a screen: it knows the size of the picture, nothing else.

    Call ``sample`` once per pixel time (``pins.pixel`` high).  A scan counts
    from one vertical sync to the next; the first, seen only in part, is dropped.
    Raises ``AssertionError`` when a line or a scan has the wrong number of
    pixels or a colour leaks into the blanking.
    """

    def __init__(self, configuration: MachineConfiguration) -> None:
        self._timing = configuration.timing
        self._pixels: list[int] = []
        self._line_pixels = 0
        self._synchronised = False
        self._in_sync = False
        self._first_cycle = 0
        self.scans: list[Scan] = []

    def sample(self, cycle: int, active: int, vertical_sync: int, color: int) -> None:
        """``color``: red in the low byte, then green, then blue."""
        in_sync = vertical_sync == self._timing.vertical_sync_positive
        if in_sync and not self._in_sync:
            self._finish()
        self._in_sync = in_sync
        if active:
            if not self._pixels:
                self._first_cycle = cycle
            self._pixels.append(color)
            self._line_pixels += 1
            return
        if self._line_pixels:
            assert self._line_pixels == self._timing.horizontal_active, (
                f"cycle {cycle}: a line of {self._line_pixels} pixels")
            self._line_pixels = 0
        assert color == 0, f"cycle {cycle}: colour {color:06x} during blanking"

    def restart(self) -> None:
        """The machine was reset: its scans begin anew, and what was seen of one is dropped."""
        self._pixels = []
        self._line_pixels = 0
        self._synchronised = self._in_sync = False

    def _finish(self) -> None:
        timing = self._timing
        if self._synchronised:
            assert len(self._pixels) == timing.horizontal_active * timing.vertical_active, (
                f"a scan of {len(self._pixels)} pixels")
            packed = np.array(self._pixels, np.uint32).reshape(timing.vertical_active,
                                                               timing.horizontal_active)
            channels = unpack(dict.fromkeys(CHANNELS, CHANNEL_BITS), packed)
            picture = np.stack(list(channels.values()), axis=-1).astype(np.uint8)
            self.scans.append(Scan(self._first_cycle, picture))
        self._synchronised = True
        self._pixels = []
