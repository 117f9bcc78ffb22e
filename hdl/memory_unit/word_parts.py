"""The parts of a memory word: the one list from which ports, RAMs, tags and sweep follow."""

from dataclasses import dataclass
from typing import Literal

from amaranth.hdl import *
from amaranth.lib import data

from ...golden.specification.ranges import COLOR_BITS

__all__ = ["PARTS", "Part", "part_layout", "value_bits"]


@dataclass(frozen=True)
class Part:
    """One part of a word (figure 6): a value, and the tag of the frame that wrote it.

    ``name``    of the part, and of its RAM where each part has one
    ``kind``    what the value is; a write brings one value of each kind (``MemoryAccess``)
    ``reader``  who reads it besides the sweep, as in ``MemoryAccess``
    ``picture`` which of the two pictures it belongs to: it is written while that is the back one;
                None is for parts that every write writes
    """

    name: str
    kind: Literal["depth", "color"]
    reader: Literal["read", "scan"]
    picture: int | None = None


#: From the lowest bits of a word up.  Whatever counts or names parts derives it from here; a new
#: part is a line here, its width in ``value_bits``, its tag in ``MemoryUnit``, and whoever uses it.
PARTS = (
    Part("depth", "depth", "read"),
    Part("color_0", "color", "scan", picture=0),
    Part("color_1", "color", "scan", picture=1),
)


def value_bits(*, depth_bits: int) -> dict[str, int]:
    """Kind of value → its bits, in the order in which ``PARTS`` first has them."""
    return {"depth": depth_bits, "color": COLOR_BITS}


def part_layout(bits: int, tag_bits: int) -> data.StructLayout:
    """A part of a word whose value has ``bits`` bits."""
    return data.StructLayout({"tag": tag_bits, "value": bits})
