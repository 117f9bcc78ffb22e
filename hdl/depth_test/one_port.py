"""The Z-buffer comparison of one-port memories: a lane, or two that share the bus (figure 3)."""

from amaranth.hdl import *
from amaranth.lib import fifo, wiring

from ...golden.specification.queues import FRAGMENTS_WAITING
from .one_port_lane import OnePortLane
from .signature import DepthTestSignature

__all__ = ["OnePortDepthTest"]


class OnePortDepthTest(wiring.Component):
    """A fragment strictly nearer than what is stored replaces it; those of a pixel in order.

    A unit has one port, and a visible fragment two accesses.  So units with an even
    and with an odd number have a ``OnePortLane`` each, and fragments that wait for it:
    while one lane writes, the other reads.  The two never have a pixel in common.
    In each clock the memory bus carries a write of a lane that has one (of both in turn)
    and a read of the other lane; where nothing is written, the lane with more fragments
    waiting reads.  A lane keeps still while the scan has the port of one of its units.

    Where no processing element has more than one unit there is one lane, whose fragments
    wait, too: so its port has work while rows without fragments go by.

    Latency: ``latency`` clocks from a fragment's read to its write; ``waiting`` from a
    fragment to its read, where nothing was under way.  Throughput: a fragment a clock
    while the ports of even and odd units have as many accesses; on one unit two clocks for
    a visible one.

    Parameters
    ----------
    id_bits, address_bits, depth_bits: int
        As of ``DepthTestSignature``.
    lanes: int
        1 or 2.

    Members: those of ``DepthTestSignature``.  Raises ``ValueError`` for a number out of range.
    """

    latency = OnePortLane.latency
    waiting = 2

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int, lanes: int):
        if lanes not in (1, 2):
            raise ValueError(f"lanes must be 1 or 2, not {lanes!r}")
        self.id_bits = id_bits
        self.address_bits = address_bits
        self.depth_bits = depth_bits
        self.lanes = lanes
        super().__init__(DepthTestSignature(id_bits=id_bits, address_bits=address_bits,
                                            depth_bits=depth_bits))

    def elaborate(self, platform):
        m = Module()
        lanes = [OnePortLane(id_bits=self.id_bits, address_bits=self.address_bits,
                             depth_bits=self.depth_bits) for _ in range(self.lanes)]
        for number, lane in enumerate(lanes):
            m.submodules[f"lane_{number}"] = lane
        levels = self._queues(m, lanes)
        if self.lanes == 1:
            wiring.connect(m, lanes[0].memory, wiring.flipped(self.memory))
        else:
            self._share(m, lanes, levels)
        m.d.comb += [
            self.busy.eq(Cat(lane.busy for lane in lanes).any() | Cat(*levels).any()),
            self.forwarded.eq(Cat(lane.forwarded for lane in lanes).any()),
        ]
        return m

    def _queues(self, m, lanes):
        """From the fragments to the lanes.  Returns how many wait before each."""
        fragment, levels = self.fragments.payload, []
        for number, lane in enumerate(lanes):
            m.submodules[f"queue_{number}"] = queue = fifo.SyncFIFOBuffered(
                width=fragment.shape().size, depth=FRAGMENTS_WAITING)
            mine = fragment.unit[0] == number if self.lanes == 2 else C(1)
            m.d.comb += [
                queue.w_data.eq(fragment),
                queue.w_en.eq(self.fragments.valid & mine),
                lane.fragments.valid.eq(queue.r_rdy),
                lane.fragments.payload.eq(queue.r_data),
                queue.r_en.eq(lane.fragments.ready),
            ]
            with m.If(mine):
                m.d.comb += self.fragments.ready.eq(queue.w_rdy)
            levels.append(queue.level)
        return levels

    def _share(self, m, lanes, levels):
        """Which lane has the memory bus to write, and which to read."""
        bus, even, odd = self.memory, *(lane.memory for lane in lanes)
        turn = Signal()  # the lane that writes if both can
        writes = Signal(2)
        reads = Signal(2)
        writer = Signal()
        reader = Signal()
        rather = Signal()
        m.d.comb += [
            writes.eq(Cat(even.write.valid, odd.write.valid) & ~bus.scanned),
            reads.eq(Cat(even.read.valid, odd.read.valid) & ~bus.scanned),
            writer.eq(Mux(writes.all(), turn, writes[1])),
            rather.eq(Mux(writes.any(), ~writer, levels[1] > levels[0])),
            reader.eq(Mux(reads.all(), rather, reads[1])),
            bus.write.eq(Mux(writer, odd.write, even.write)),
            bus.write.valid.eq(writes.any()),
            bus.read.eq(Mux(reader, odd.read, even.read)),
            bus.read.valid.eq(reads.any()),
        ]
        with m.If(writes.any()):
            m.d.sync += turn.eq(~writer)
        for number, lane in enumerate((even, odd)):
            m.d.comb += [
                lane.read_data.eq(bus.read_data),
                lane.write_busy.eq(bus.write_busy | ~writes[number] | (writer != number)),
                lane.read_busy.eq(bus.read_busy | ~reads[number] | (reader != number)),
            ]
