"""An object, to everybody who needs it."""

from functools import reduce
from operator import and_

from amaranth.hdl import *
from amaranth.lib import data, fifo, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["ObjectCopies"]


class ObjectCopies(wiring.Component):
    """Objects wait in a queue; the first one goes to each of several ways that it needs.

    It is offered to all of them at the same time and taken by each when that can; when it has gone
    every way, it leaves the queue.  So no way waits for another one, but for the objects behind the
    first one.

    Latency: a clock.  Throughput: an object a clock.

    Parameters
    ----------
    shape: data.StructLayout
        Of an object.
    depth: int, positive
        Objects that can wait.
    ways: tuple of str
        Their names.

    Members
    -------
    objects: In(stream of objects)
    first: Out(shape)
        The first one in the queue.
    needs: In(len(ways))
        Which ways it needs, by what it is; it may be none.
    One for each of the ways: Out(stream of objects)
    busy: Out(1)
        Something waits.

    Raises ``ValueError`` when ``depth`` is not positive, or there are no ways.
    """

    def __init__(self, *, shape: data.StructLayout, depth: int, ways: tuple[str, ...]):
        if depth < 1:
            raise ValueError(f"depth must be positive, not {depth!r}")
        if not ways:
            raise ValueError("ways must name one at least")
        self.shape = shape
        self.depth = depth
        self.ways = ways
        super().__init__({
            "objects": In(stream.Signature(shape)),
            "first": Out(shape),
            "needs": In(len(ways)),
            **{way: Out(stream.Signature(shape)) for way in ways},
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.queue = queue = fifo.SyncFIFO(width=self.shape.size, depth=self.depth)
        gone = Signal(len(self.ways))  # the ways that have taken the first one
        takes = Signal(len(self.ways))
        done = reduce(and_, ~self.needs | gone | takes)
        m.d.comb += [
            queue.w_data.eq(self.objects.payload),
            queue.w_en.eq(self.objects.valid),
            self.objects.ready.eq(queue.w_rdy),
            self.first.eq(queue.r_data),
            queue.r_en.eq(done),
            self.busy.eq(queue.r_rdy),
        ]
        for place, way in enumerate(self.ways):
            out = getattr(self, way)
            m.d.comb += [
                out.valid.eq(queue.r_rdy & self.needs[place] & ~gone[place]),
                out.payload.eq(self.first),
                takes[place].eq(out.valid & out.ready),
            ]
        m.d.sync += gone.eq(Mux(done, 0, gone | takes))
        return m
