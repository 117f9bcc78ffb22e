"""Fragments that wait for their memory unit."""

from amaranth.hdl import *
from amaranth.lib import data, memory, stream, wiring
from amaranth.lib.wiring import In, Out

__all__ = ["FragmentQueue"]


class FragmentQueue(wiring.Component):
    """First come, first given; and who gives need not look at what is given.

    In a clock in which one waits, it may be granted: then it waits no more, and from the next clock
    on it is ``given``, until it is taken.  Meanwhile another one may come in its place, and another
    one be granted in the clock in which it is taken.

    Latency: a clock until a fragment waits, and one until it is given.  Throughput: a fragment a
    clock.

    Parameters
    ----------
    depth: int, positive
        Fragments that can wait.
    shape: data.StructLayout
        Of a fragment.

    Members
    -------
    fragments: In(stream of fragments)
    waiting: Out(1)
        There is one to be granted.
    grant: In(1)
        Grant it; only while one is waiting, and none is given that is not taken in this clock.
    given: Out(shape)
        The one that was granted last.
    taken: In(1)
        It is taken in this clock.

    Raises ``ValueError`` when ``depth`` is not positive.
    """

    latency = 2

    def __init__(self, *, depth: int, shape: data.StructLayout):
        if depth < 1:
            raise ValueError(f"depth must be positive, not {depth!r}")
        self.depth = depth
        super().__init__({
            "fragments": In(stream.Signature(shape)),
            "waiting": Out(1),
            "grant": In(1),
            "given": Out(shape),
            "taken": In(1),
        })

    def elaborate(self, platform):
        m = Module()
        fragments = self.fragments
        # One place more than can wait, for the one that is given; a power of two, so that places
        # wrap by themselves.  RAM of look-up tables has sixteen words at least.
        places = 1 << self.depth.bit_length()
        m.submodules.storage = storage = memory.Memory(shape=fragments.payload.shape(),
                                                       depth=places, init=[])
        write, read = storage.write_port(), storage.read_port(domain="comb")
        count = Signal(range(self.depth + 1))
        comes = Signal()
        m.d.comb += [
            fragments.ready.eq(count != self.depth),
            comes.eq(fragments.valid & fragments.ready),
            self.waiting.eq(count != 0),
            write.en.eq(comes),
            write.data.eq(fragments.payload),
            self.given.eq(read.data),
        ]
        m.d.sync += [
            count.eq(count + comes - self.grant),
            write.addr.eq(write.addr + comes),
            read.addr.eq(read.addr + self.taken),
        ]
        return m
