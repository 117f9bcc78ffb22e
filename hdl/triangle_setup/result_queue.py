"""Results that belong together but come one after the other."""

from amaranth.hdl import *
from amaranth.lib import data, fifo, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["ResultQueue"]


class ResultQueue(wiring.Component):
    """Gathers results into words of three, which wait until they are taken.

    There is no ready: whoever starts what gives the results must have no more than ``depth``
    words on their way.  A pipeline that never waits ends in such a queue.

    Latency: ``latency`` clocks from the third result to the word.  Throughput: a result a clock.

    Parameters
    ----------
    result_bits: int, positive
    depth: int, at least 2
        Words it holds.

    Members
    -------
    write: In(1)
    result: In(result_bits)
        The next of three.
    words: Out(stream of words)
        Arrays of three results, the first in the lowest bits.
    """

    latency = 2

    def __init__(self, *, result_bits: int, depth: int):
        for name, value, least in (("result_bits", result_bits, 1), ("depth", depth, 2)):
            if value < least:
                raise ValueError(f"{name} must be at least {least}, not {value}")
        self.result_bits = result_bits
        self.depth = depth
        self._word = data.ArrayLayout(result_bits, 3)
        super().__init__({
            "write": In(1),
            "result": In(result_bits),
            "words": Out(stream.Signature(self._word)),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.queue = queue = fifo.SyncFIFOBuffered(width=self._word.size,
                                                           depth=self.depth)
        first = Signal.like(self.result)
        second = Signal.like(self.result)
        count = Signal(range(3))
        m.d.comb += [
            queue.w_en.eq(self.write & (count == 2)),
            queue.w_data.eq(Cat(first, second, self.result)),
            self.words.valid.eq(queue.r_rdy),
            self.words.payload.eq(queue.r_data),
            queue.r_en.eq(self.words.ready),
        ]
        with m.If(self.write):
            m.d.sync += [first.eq(second), second.eq(self.result),
                         count.eq(Mux(count == 2, 0, count + 1))]
        return m
