"""What every depth test has towards the pipeline before it and the memory units after it."""

from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ..backplane.connectors import MemoryBus
from ..rasteriser.interpolator import fragment_layout

__all__ = ["DepthTestSignature"]


class DepthTestSignature(wiring.Signature):
    """Fragments in; reads and writes of memory units out.  Parameters: those of ``MemoryBus``.

    Members
    -------
    fragments: In(stream of fragment_layout)
    memory: Out(MemoryBus)
        The address of writes is 0 from the second clock without ``busy`` on, while no fragment
        comes: the survey, which drives none, writes there (``MemoryBusSelector``).
    busy: Out(1)
        It holds a fragment.
    forwarded: Out(1)
        In this clock a depth that was on its way to the memory took the place of its answer.
    """

    def __init__(self, *, id_bits: int, address_bits: int, depth_bits: int):
        bits = {"id_bits": id_bits, "address_bits": address_bits, "depth_bits": depth_bits}
        memory = MemoryBus(**bits)
        super().__init__({
            "fragments": In(stream.Signature(fragment_layout(**bits))),
            "memory": Out(memory),
            "busy": Out(1),
            "forwarded": Out(1),
        })
