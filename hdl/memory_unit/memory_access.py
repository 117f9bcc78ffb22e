"""What a memory unit keeps of a pixel, and how it asks its RAM for it."""

from amaranth.hdl import *
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import (
    MAXIMUM_ORDER_BITS,
    MAXIMUM_TAG_BITS,
    MINIMUM_TAG_BITS,
)
from ...golden.specification.ranges import MAXIMUM_WORDS
from .word_parts import PARTS, Part, part_layout, value_bits

__all__ = ["MAXIMUM_DEPTH_BITS", "MemoryAccess", "part_address", "part_answer", "part_asked",
           "part_chosen", "part_written"]

MAXIMUM_DEPTH_BITS = 32 + MAXIMUM_ORDER_BITS


class MemoryAccess(wiring.Signature):
    """Four users of one RAM, in order of precedence; ``Out`` is towards the RAM.

    A word has ``parts``: those of ``PARTS`` (figure 6) are depth, and two colours; of the members
    below these are ``depth_in``, ``color_in``, ``depth`` and ``color``.  ``PICTURE_PARTS`` are two
    pixels, ``pixel_in`` and ``pixel``, in their place; then the scan reads the pixels that are not
    ``back``, and a read those that are.  Each access takes
    place in the clock in which it is asked for and its busy signal is low; what it
    reads is there in the next clock, and in that one only.  What a read sees of a
    write of the same word in the same clock is unknown, and so is what a scan reads
    of the very colour that is written.  So are all contents after power-on.

    Members
    -------
    scan: Out(1)
        Read the colours for the screen.
    scan_address: Out(address_bits)
        Word whose colours are read.
    write: Out(1)
        Write the depth and the colour ``back``.
    back: Out(1)
        The colour that is drawn into.
    write_address: Out(address_bits)
        Word that is written.
    depth_in: Out(part_layout), color_in: Out(part_layout)
        What is written.
    write_busy: In(1)
        The port is the scan's.
    read: Out(1)
        Read the depth.
    read_address: Out(address_bits)
        Word whose depth is read.
    read_busy: In(1)
        The port is the scan's, or taken by a write.
    sweep: Out(1)
        Read all parts, for their tags.
    erase: Out(len(parts))
        Write tag 0 to these parts, a bit each.  Not together with ``sweep``.
    sweep_address: Out(address_bits)
        Word that is swept.
    sweep_busy: In(1)
        Somebody else asks.
    depth: In(part_layout)
        The depth of the word last read.
    color: In(part_layout) [2]
        Both colours of the word last read.

    Raises ``ValueError`` for a number out of range.
    """

    def __init__(self, *, words: int, depth_bits: int, tag_bits: int,
                 parts: tuple[Part, ...] = PARTS):
        for name, value, low, high in (("words", words, 1, MAXIMUM_WORDS),
                                       ("depth_bits", depth_bits, 1, MAXIMUM_DEPTH_BITS),
                                       ("tag_bits", tag_bits, MINIMUM_TAG_BITS, MAXIMUM_TAG_BITS)):
            if not low <= value <= high:
                raise ValueError(f"{name} must be {low} to {high}, not {value!r}")
        address = range(max(2, words))
        layouts = {kind: part_layout(bits, tag_bits)
                   for kind, bits in value_bits(parts, depth_bits=depth_bits).items()}
        of_pictures = {part.kind for part in parts if part.picture is not None}
        super().__init__({
            "scan": Out(1),
            "scan_address": Out(address),
            "write": Out(1),
            "back": Out(1),
            "write_address": Out(address),
            **{f"{kind}_in": Out(layout) for kind, layout in layouts.items()},
            "write_busy": In(1),
            "read": Out(1),
            "read_address": Out(address),
            "read_busy": In(1),
            "sweep": Out(1),
            "erase": Out(len(parts)),
            "sweep_address": Out(address),
            "sweep_busy": In(1),
            **{kind: In(layout).array(2) if kind in of_pictures else In(layout)
               for kind, layout in layouts.items()},
        })


def part_written(access: wiring.PureInterface, part: Part) -> data.View:
    """What a write brings for ``part``."""
    return getattr(access, f"{part.kind}_in")


def part_chosen(access: wiring.PureInterface, part: Part) -> Value:
    """A write writes ``part``."""
    return C(1) if part.picture is None else access.back if part.picture else ~access.back


def part_asked(access: wiring.PureInterface, part: Part) -> Value:
    """Its reader asks for ``part``."""
    if part.reader == "either":
        return Mux(part_chosen(access, part), access.read, access.scan)
    return getattr(access, part.reader)


def part_address(access: wiring.PureInterface, part: Part) -> Value:
    """Where its reader asks."""
    if part.reader == "either":
        return Mux(part_chosen(access, part), access.read_address, access.scan_address)
    return getattr(access, f"{part.reader}_address")


def part_answer(access: wiring.PureInterface, part: Part) -> data.View:
    """What of ``part`` was read."""
    answer = getattr(access, part.kind)
    return answer if part.picture is None else answer[part.picture]
