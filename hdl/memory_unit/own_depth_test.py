"""What a memory unit has besides, where fragments come to it directly."""

from amaranth.hdl import *
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.fragment_lines import FragmentLines
from ..depth_test.one_port import OnePortDepthTest
from ..depth_test.two_ports import TwoPortDepthTest

__all__ = ["OwnDepthTest"]


class OwnDepthTest:
    """Tests the fragments that are for this unit, and writes those that are nearer.

    They come from any processing element in any order, but those of one in its own; so what is
    compared is depth and, below it, the order (``MachineConfiguration.rank_bits``).  The depth test
    is that of a processing element, with one unit.  The memory bus still reaches the unit, for the
    survey and the read-back, which come when no fragments do.

    This is no component, but adds its signals to the module of the ``MemoryUnit``: the last ones,
    since it takes the RAM from others.

    Latency and throughput: those of ``TwoPortDepthTest``, of ``OnePortDepthTest`` of one lane.

    Members
    -------
    direct: In(FragmentLines)
    """

    storages: tuple[memory.Memory, ...] = ()

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        bits = {"address_bits": configuration.address_bits,
                "depth_bits": configuration.rank_bits}
        self._lines = FragmentLines(**bits)
        # Of its unit it need not know the number.
        self.depth_test = (OnePortDepthTest(id_bits=1, **bits, lanes=1)
                           if configuration.memory_ports == 1
                           else TwoPortDepthTest(id_bits=1, **bits))

    @property
    def members(self) -> dict[str, wiring.Member]:
        """What the unit has to be told, and tells."""
        return {"direct": In(self._lines)}

    def add_to(self, m: Module, unit: wiring.PureInterface, current: Value, depth: Value):
        """Put it into ``m``, the module of ``unit``; ``depth``: what was just read, ``current``:
        it is of this frame."""
        m.submodules.depth_test = test = self.depth_test
        access, lines = unit.memory.access, unit.direct
        read, write, fragment = test.memory.read, test.memory.write, test.fragments.payload
        m.d.comb += [
            test.fragments.valid.eq(lines.fragments.valid),
            *(fragment[name].eq(lines.fragments.payload[name])
              for name in ("address", "depth", "color")),
            lines.fragments.ready.eq(test.fragments.ready),
            lines.busy.eq(test.busy),
            lines.followed.eq(test.forwarded),
            test.memory.read_data.eq(Mux(current, depth, self.configuration.rank_background)),
            test.memory.read_busy.eq(access.read_busy),
            test.memory.write_busy.eq(access.write_busy),
        ]
        with m.If(read.valid):
            m.d.comb += [access.read.eq(1), access.read_address.eq(read.address)]
        with m.If(write.valid):
            m.d.comb += [
                access.write.eq(1),
                access.write_address.eq(write.address),
                access.depth_in.value.eq(write.depth),
                access.color_in.value.eq(write.color),
            ]
