"""The parts of a memory word: the one list from which ports, RAMs, tags and sweep follow."""

from dataclasses import dataclass
from typing import Literal

from amaranth.hdl import *
from amaranth.lib import data

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.ranges import COLOR_BITS

__all__ = ["FRAME_PARTS", "PARTS", "PICTURE_PARTS", "Part", "part_layout", "pixel_layout",
           "value_bits", "word_parts"]


@dataclass(frozen=True)
class Part:
    """One part of a word (figure 6): a value, and the tag of the frame that wrote it.

    ``name``    of the part, and of its RAM where each part has one
    ``kind``    what the value is; a write brings one value of each kind (``MemoryAccess``)
    ``reader``  who reads it besides the sweep, as in ``MemoryAccess``; ``either``: whoever has
                its picture, the scan the front one
    ``picture`` which of the two pictures it belongs to: it is written while that is the back one;
                None is for parts that every write writes
    """

    name: str
    kind: Literal["depth", "color", "pixel"]
    reader: Literal["read", "scan", "either"]
    picture: int | None = None


#: From the lowest bits of a word up.  Whatever counts or names parts derives it from here; a new
#: part is a line here, its width in ``value_bits``, its tag in ``MemoryUnit``, and whoever uses it.
PARTS = (
    Part("depth", "depth", "read"),
    Part("color_0", "color", "scan", picture=0),
    Part("color_1", "color", "scan", picture=1),
)


#: Where the picture that is scanned, or merged, still has its depths; one tag is for both.
PICTURE_PARTS = (
    Part("picture_0", "pixel", "either", picture=0),
    Part("picture_1", "pixel", "either", picture=1),
)


#: Where nodes send to frame units what these show.
FRAME_PARTS = tuple(part for part in PARTS if part.picture is not None)


def word_parts(configuration: MachineConfiguration) -> tuple[Part, ...]:
    """The parts of the words of a machine's memory units."""
    return PICTURE_PARTS if configuration.keeps_two_depths else PARTS


def pixel_layout(depth_bits: int) -> data.StructLayout:
    """What a picture has of a pixel, where depth and colour are one part."""
    return data.StructLayout({"depth": depth_bits, "color": COLOR_BITS})


def value_bits(parts: tuple[Part, ...], *, depth_bits: int) -> dict[str, int]:
    """Kind of value → its bits, in the order in which ``parts`` first has them."""
    bits = {"depth": depth_bits, "color": COLOR_BITS, "pixel": pixel_layout(depth_bits).size}
    return {part.kind: bits[part.kind] for part in parts}


def part_layout(bits: int, tag_bits: int) -> data.StructLayout:
    """A part of a word whose value has ``bits`` bits."""
    return data.StructLayout({"tag": tag_bits, "value": bits})
