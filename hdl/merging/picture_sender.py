"""The part of a memory unit that sends what was drawn into it, for a merge."""

from amaranth.hdl import *
from amaranth.lib import fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.ranges import COLOR_BITS
from .drawn_map import DrawnMap
from .picture_maps import PictureMaps
from .send_lines import sent_pixel_layout

__all__ = ["PictureSender"]

#: Pixels that can wait: one is read and one put in while one goes.
WAITING = 3


class PictureSender(wiring.Component):
    """Notes which words are written, and reads these when its node sends them.

    Words that are not of the frame which is drawn were marked by a frame that nobody ended, or by
    a survey; they are read, but not sent.  After a listing nothing is marked.

    A word is read only when there is room for it: what a RAM reads is there for one clock.

    Latency: ``latency`` clocks from ``start`` to the first pixel, if it lies among the first words
    of the map's summary.  Throughput: a pixel a clock; a listing takes as long as ``DrawnMap`` says
    and three clocks for the last one to come out.

    Parameters
    ----------
    words: int, positive
        Of the memory unit.
    depth_bits: int, positive
        Of what is kept of a pixel to compare it by.
    two_pictures: bool
        One is drawn into while the other one is sent (``PictureMaps``).

    Members
    -------
    write: In(1), write_address: In(range(words))
        A word is written; not while there is ``more``, where there is one picture.
    settled: Out(1)
        All writes of earlier clocks are marked, and nothing is listed.
    start: In(1)
        List; only while ``settled``, and not together with a write.
    more: Out(1)
        From the clock after ``start`` on: pixels may follow the one that is offered.
    reads: Out(stream of addresses)
        A word is read in the clock in which its address is taken, ...
    current: In(1), depth: In(depth_bits), color: In(COLOR_BITS)
        ... and this is it in the next clock: whether it is of this frame, and what it holds.
    pixels: Out(stream of sent_pixel_layout)
        In ascending order of their addresses.
    front: In(1)
        Which picture is sent, the other one is written; only where there are two.
    hidden: In(1), hidden_address: In(range(words))
        A word of the front one need not be sent; not while there is ``more``; only where there
        are two.

    Raises ``ValueError`` for a number out of range.
    """

    latency = DrawnMap.latency + 3

    def __init__(self, *, words: int, depth_bits: int, two_pictures: bool = False):
        if depth_bits < 1:
            raise ValueError(f"depth_bits must be positive, not {depth_bits!r}")
        self.map = PictureMaps(words=words) if two_pictures else DrawnMap(words=words)
        self.two_pictures = two_pictures
        self.depth_bits = depth_bits
        address = range(max(2, words))
        pixel = sent_pixel_layout(address_bits=Shape.cast(address).width, depth_bits=depth_bits)
        self._waiting = fifo.SyncFIFO(width=pixel.size, depth=WAITING)
        super().__init__({
            "write": In(1),
            "write_address": In(address),
            "settled": Out(1),
            "start": In(1),
            "more": Out(1),
            "reads": Out(stream.Signature(address)),
            "current": In(1),
            "depth": In(depth_bits),
            "color": In(COLOR_BITS),
            "pixels": Out(stream.Signature(pixel)),
            **({"front": In(1), "hidden": In(1), "hidden_address": In(address)}
               if two_pictures else {}),
        })

    @property
    def words(self) -> int:
        return self.map.words

    def answers(self, lines: wiring.PureInterface, number: Value) -> list:
        """Assignments to all of ``lines`` (``SendLines``) but ``settled``, of the memory unit of
        that number, which has this: its pixels, when it is the one that is named."""
        selected = lines.unit == number
        sends = selected & self.pixels.valid
        return [
            self.start.eq(lines.start),
            lines.valid.eq(sends),
            Value.cast(lines.pixel).eq(Mux(sends, Value.cast(self.pixels.payload), 0)),
            self.pixels.ready.eq(selected & lines.ready),
            lines.more.eq(selected & self.more),
        ]

    def elaborate(self, platform):
        m = Module()
        m.submodules.map = drawn = self.map
        m.submodules.waiting = waiting = self._waiting
        # Whether the RAM is free is known late, and the map's stages are many.
        m.submodules.listed = listed = fifo.SyncFIFO(width=len(self.write_address), depth=2)
        answering = Signal()  # the word that was read is there in this clock only
        address = Signal.like(self.write_address)
        room = Signal()
        m.d.comb += [
            # A survey writes before the map is cleared; its words are not of a frame anyway.
            drawn.change.eq(self.write & drawn.ready),
            drawn.address.eq(self.write_address),
            drawn.drawn.eq(1),
            drawn.start.eq(self.start),
            self.settled.eq(drawn.settled),

            # Once there is room there is until a word is read.
            room.eq(waiting.level + answering < WAITING),
            self.reads.valid.eq(listed.r_rdy & room),
            self.reads.payload.eq(listed.r_data),
            listed.r_en.eq(self.reads.ready & room),
            listed.w_data.eq(drawn.addresses.payload),
            listed.w_en.eq(drawn.addresses.valid),
            drawn.addresses.ready.eq(listed.w_rdy),

            waiting.w_en.eq(answering & self.current),
            waiting.w_data.eq(Cat(address, self.depth, self.color)),
            self.pixels.valid.eq(waiting.r_rdy),
            Value.cast(self.pixels.payload).eq(waiting.r_data),
            waiting.r_en.eq(self.pixels.ready),
            self.more.eq(drawn.listing | listed.r_rdy | answering | (waiting.level > 1)),
        ]
        if self.two_pictures:
            m.d.comb += [getattr(drawn, name).eq(getattr(self, name))
                         for name in ("front", "hidden", "hidden_address")]
        m.d.sync += [
            answering.eq(self.reads.valid & self.reads.ready),
            address.eq(self.reads.payload),
        ]
        return m
