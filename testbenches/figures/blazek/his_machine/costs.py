"""What things cost on the iPSC/2, in seconds.

What the thesis prints is taken as it is printed, but for its unit: "4 milliseconds per byte" would
be three hours for one frame buffer, and 12 seconds for a packet of 100 polygons.  Microseconds make
sense: a message of 100 bytes takes 400, and just above that 275 + 404 = 679, as an iPSC/2 does.
What it does not print is estimated for a 386 of 16 MHz, some 4 million instructions a second, with
a Weitek coprocessor, some half a million floating-point operations a second from C.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from ..scenes.sphere_work import Work

MICROSECOND = 1e-6


@dataclass(frozen=True)
class Costs:
    """Seconds unless said otherwise.  ``REASONS`` has one for each."""

    byte: float = 4 * MICROSECOND
    message: float = 275 * MICROSECOND
    short_message: int = 100
    object_bytes: int = 100
    polygon_bytes: int = 30
    pixel_bytes: int = 10
    pasted_pixel_bytes: int = 3
    parse: float = 2000 * MICROSECOND
    tessellate: float = 150 * MICROSECOND
    discard: float = 10 * MICROSECOND
    polygon: float = 250 * MICROSECOND
    line: float = 50 * MICROSECOND
    pixel: float = 10 * MICROSECOND
    merge_pixel: float = 5 * MICROSECOND

    def message_time(self, count: Any) -> Any:
        """Of a message of so many bytes, or of an array of them."""
        start = np.where(np.asarray(count) > self.short_message, self.message, 0.0)
        return start + self.byte * np.asarray(count)

    @property
    def object_message(self) -> float:
        return float(self.message_time(self.object_bytes))

    def drawing(self, work: Work) -> Any:
        """Of polygons that are there."""
        return self.polygon * work.polygons + self.line * work.lines + self.pixel * work.pixels


COSTS = Costs()

REASONS = {
    "byte": "chapter IV, printed as milliseconds",
    "message": "chapter IV, printed as milliseconds: before the first byte of a longer message",
    "short_message": "chapter IV: bytes up to which a message costs by the byte alone",
    "object_bytes": "chapter V: object description packets, “only 100 bytes each”",
    "polygon_bytes": "chapter V: a packet of 100 polygons is three kilobytes",
    "pixel_bytes": "chapter II: an image of 512 × 512, RGB and Z, of 2,621,440 bytes",
    "pasted_pixel_bytes": "chapter II: RGB without Z, 786,432 bytes; what is pasted needs no Z",
    "parse": "a line of the scene file: some 100 characters, a few numbers",
    "tessellate": "a vertex moved out to the sphere, a root and three divisions, then three turned "
                  "and scaled: some 80 operations; chapter V says that it takes longer than "
                  "to send a polygon, which is 123",
    "discard": "a box compared with a part of the screen, some 40 instructions",
    "polygon": "its normal and shade, three slopes of x and of z: some 100 operations and six "
               "divisions",
    "line": "two edges moved on, sorted, one division for z: some 150 instructions",
    "pixel": "z compared, and where nearer z and three colours stored, in C: some 40 instructions",
    "merge_pixel": "algorithm 4 for one pixel: z compared, four values stored: some 20 "
                   "instructions",
}

assert set(REASONS) == {field.name for field in fields(Costs)}
