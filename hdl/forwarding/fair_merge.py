"""Several streams of objects into one, fairly."""

from functools import reduce
from operator import or_

from amaranth.hdl import *
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from ..direct.round_robin import RoundRobin

__all__ = ["FairMerge"]


class FairMerge(wiring.Component):
    """Takes an object a clock from one of several streams, in turn (``RoundRobin``).

    Latency: a clock.  Throughput: an object a clock.

    Parameters
    ----------
    shape: data.StructLayout
        Of an object.
    sources: int, positive

    Members
    -------
    sources: In(stream of objects) [sources]
    objects: Out(stream of objects)

    Raises ``ValueError`` when ``sources`` is not positive.
    """

    latency = 1

    def __init__(self, *, shape: data.StructLayout, sources: int):
        self._arbiter = RoundRobin(requesters=sources)
        super().__init__({
            "sources": In(stream.Signature(shape)).array(sources),
            "objects": Out(stream.Signature(shape)),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.arbiter = arbiter = self._arbiter
        objects, move = self.objects, Signal()
        m.d.comb += [
            move.eq(~objects.valid | objects.ready),
            arbiter.requests.eq(Cat(source.valid for source in self.sources)),
            arbiter.take.eq(move),
        ]
        for granted, source in zip(arbiter.grant, self.sources, strict=True):
            m.d.comb += source.ready.eq(move & granted)
        with m.If(move):
            m.d.sync += [
                objects.valid.eq(arbiter.grant.any()),
                Value.cast(objects.payload).eq(reduce(or_, (
                    Mux(granted, Value.cast(source.payload), 0)
                    for granted, source in zip(arbiter.grant, self.sources, strict=True)))),
            ]
        return m
