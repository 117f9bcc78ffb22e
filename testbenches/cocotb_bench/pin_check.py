"""The video pins against the timing of the configuration, clock by clock."""

from __future__ import annotations

from typing import NamedTuple

from ...golden.specification.configuration import MachineConfiguration
from .violation import ProtocolError


class Pins(NamedTuple):
    """Levels of the pins but ``pixel``; None is unknown.  ``color``: red in the low byte."""

    active: int | None
    horizontal_sync: int | None
    vertical_sync: int | None
    color: int | None


class PinCheck:
    """Call ``sample`` once per clock.

    Raises ``ProtocolError`` where ``pixel`` does not come every ``clocks_per_pixel`` clocks,
    another pin moves between two pixels, a colour leaves black during blanking, or a sync or
    ``active`` is not where the timing has it.  Where the scan is, it learns from the first
    vertical sync that begins under its eyes.
    """

    def __init__(self, configuration: MachineConfiguration) -> None:
        self._period = configuration.clocks_per_pixel
        self._timing = configuration.timing
        self._last_pixel: int | None = None
        self._held: Pins | None = None
        self._place: int | None = None

    def sample(self, cycle: int, pixel: int | None, pins: Pins) -> None:
        if pixel is None:
            raise ProtocolError(f"cycle {cycle}: pins: pixel is unknown")
        if not pixel:
            if self._held is not None and pins != self._held:
                raise ProtocolError(f"cycle {cycle}: pins: {pins} between two pixels, after "
                                        f"{self._held}")
            if self._last_pixel is not None and cycle - self._last_pixel >= self._period:
                raise ProtocolError(f"cycle {cycle}: pins: no pixel {self._period} clocks "
                                        "after the last")
            return
        if self._last_pixel is not None and cycle - self._last_pixel != self._period:
            raise ProtocolError(f"cycle {cycle}: pins: a pixel {cycle - self._last_pixel} "
                                    f"clocks after the last, not {self._period}")
        self._last_pixel = cycle
        self._check_pixel(cycle, pins)
        self._held = pins

    def _check_pixel(self, cycle: int, pins: Pins) -> None:
        if None in pins[:3]:
            raise ProtocolError(f"cycle {cycle}: pins: active or a sync is unknown")
        if not pins.active and pins.color != 0:
            raise ProtocolError(f"cycle {cycle}: pins: not black during blanking")
        timing = self._timing
        if self._place is not None:
            self._place = (self._place + 1) % timing.pixels
        elif self._held is not None and self._vertical(pins) and not self._vertical(self._held):
            self._place = 0
        if self._place is None:
            return
        line, column = divmod(self._place, timing.horizontal_total)
        x = column - timing.horizontal_sync - timing.horizontal_back
        y = line - timing.vertical_sync - timing.vertical_back
        for name, got, expected in (
            ("vertical sync", self._vertical(pins), line < timing.vertical_sync),
            ("horizontal sync", pins.horizontal_sync == timing.horizontal_sync_positive,
             column < timing.horizontal_sync),
            ("active", bool(pins.active),
             0 <= x < timing.horizontal_active and 0 <= y < timing.vertical_active),
        ):
            if got != expected:
                raise ProtocolError(
                    f"cycle {cycle}: pins: {name} is {'on' if got else 'off'} in line {line}, "
                    f"column {column} of the scan, counted from the syncs")

    def _vertical(self, pins: Pins) -> bool:
        return pins.vertical_sync == self._timing.vertical_sync_positive
