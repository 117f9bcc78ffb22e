"""What a processing element is told, where it makes triangles of objects and passes these on."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.commands import RESPONSE_FIELDS, RESPONSE_VALUE_BITS, ResponseKind
from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import BroadcastLines
from ..backplane.region_lines import RegionLines
from ..backplane.words import ObjectOperation, Operation, response_value
from ..objects.object_setup import ObjectSetup
from .object_forwarder import ObjectForwarder
from .object_reach import ObjectReach
from .reach import object_bits, reaching_object_layout

__all__ = ["ElementGate"]


class ElementGate(wiring.Component):
    """Between the broadcast and a processing element's queue.

    ::

        broadcast ──┬── meshes, vertices ─────────────────────────────┐
                    │                                                 ▼
                    ├── its objects ─▶ ObjectReach ─▶ ObjectForwarder ─▶ ObjectSetup ─▶ own
                    │                                  ▲ │   │ ▲                         ▲
                    │                    from, to left │ ▼   ▼ │ from, to right          │
                    └── operations, prepared triangles ──────────────────────────────────┘

    An object for another element neither is seen nor holds anybody up.  Meshes change when nothing
    is held anywhere, since all elements take them in the same clock.  Vertices come before objects
    that have not gone to set-up yet; as pixels have their order it does not matter.

    Latency: none for an operation or a prepared triangle; ``latency`` clocks from an object to its
    first triangle.  Throughput: that of ``TriangleSetup``.

    Members
    -------
    total: In(id_bits)
        Number of memory units in the cage.
    regions: In(RegionLines), element: In(element_bits)
        The table, and the number that it has in that.
    broadcast: In(BroadcastLines)
        The controller's; ``done`` is low while an object or a triangle is held here.
    own: Out(BroadcastLines)
        Those of the processing element.
    from_left, from_right: In(stream of reaching_object_layout)
    to_left, to_right: Out(stream of reaching_object_layout)
        The neighbours' objects.
    full: Out(1)
        A mesh found no room since all were cleared.
    made, dropped, forwarded: Out(RESPONSE_VALUE_BITS)
        The values of ``MADE``, ``DROPPED`` and ``FORWARDED``, since the frame's start.

    Blazek 1991, chapter V, node initiated with object forwarding.
    """

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        bits = object_bits(configuration)
        passed = stream.Signature(reaching_object_layout(configuration, bits))
        self._setup = ObjectSetup(configuration=configuration)
        self._reach = ObjectReach(configuration=configuration)
        self._forwarder = ObjectForwarder(configuration=configuration, object_bits=bits)
        super().__init__({
            "total": In(configuration.id_bits),
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            "broadcast": In(BroadcastLines(configuration)),
            "own": Out(BroadcastLines(configuration)),
            "from_left": In(passed), "from_right": In(passed),
            "to_left": Out(passed), "to_right": Out(passed),
            "full": Out(1),
            **dict.fromkeys(("made", "dropped", "forwarded"), Out(RESPONSE_VALUE_BITS)),
        })

    @property
    def latency(self) -> int:
        """Clocks from an object to its first triangle, in the element that has it from the host."""
        return self._reach.latency + self._forwarder.latency + self._setup.latency

    @property
    def storages(self):
        """The RAMs that outlast a frame."""
        return [*self._setup.storages, self._reach.storage]

    def elaborate(self, platform):
        m = Module()
        m.submodules.reach = reach = self._reach
        m.submodules.forwarder = forwarder = self._forwarder
        m.submodules.setup = setup = self._setup
        wiring.connect(m, wiring.flipped(self.regions), forwarder.regions)
        start = Signal(name="frame_starts")
        m.d.comb += [
            forwarder.element.eq(self.element),
            setup.total.eq(self.total),
            self.full.eq(setup.full),
            # Nothing is held anywhere then.
            start.eq(self.broadcast.strobe
                     & (self.broadcast.packet.operation == Operation.FRAME_START)),
            setup.start.eq(start),
        ]
        wiring.connect(m, reach.reaching, forwarder.host)
        for name in ("from_left", "from_right", "to_left", "to_right"):
            wiring.connect(m, wiring.flipped(getattr(self, name)), getattr(forwarder, name))
        self._listen(m, reach, forwarder, setup)
        self._count(m, forwarder, setup, start)
        return m

    def _listen(self, m, reach, forwarder, setup):
        """Every word of the broadcast to whom it is for."""
        broadcast, own, packet = self.broadcast, self.own, self.broadcast.packet
        word = packet.body.make
        making, object_, vertices, mine, chosen, passing, inside = (Signal(name=name) for name in (
            "making", "is_object", "is_vertices", "is_mine", "chosen", "passing", "inside"))
        m.d.comb += [
            making.eq(packet.operation == Operation.MAKE),
            object_.eq(word.operation == ObjectOperation.OBJECT),
            vertices.eq(word.operation == ObjectOperation.TRIANGLE),
            mine.eq(word.body.object.element == self.element),
            inside.eq(reach.busy | forwarder.busy | setup.busy),
            # Offered by the controller, whether or not the others are ready: objects wait meanwhile
            # for vertices, and those that change meshes for all objects.
            chosen.eq(making & ~object_ & (vertices | ~inside)),
        ]

        reach_in, drawn, words = reach.objects, forwarder.drawn, setup.words
        m.d.comb += [
            reach_in.valid.eq(broadcast.strobe & making & object_ & mine),
            reach_in.payload.eq(word.body.object),
            reach.clear.eq(broadcast.strobe & making
                           & (word.operation == ObjectOperation.CLEAR)),
            reach.store.eq(broadcast.strobe & making & (word.operation == ObjectOperation.MESH)),
            reach.box.eq(word.body.mesh),
            words.valid.eq(Mux(chosen, broadcast.strobe, drawn.valid)),
            drawn.ready.eq(words.ready & ~chosen),
        ]
        with m.If(chosen):
            m.d.comb += words.payload.eq(word)
        with m.Else():
            m.d.comb += [words.payload.operation.eq(ObjectOperation.OBJECT),
                         Value.cast(words.payload.body.object).eq(drawn.payload.object)]

        # A prepared triangle, or an operation, goes past.
        triangle = setup.triangles
        m.d.comb += [
            passing.eq(broadcast.strobe & ~making),
            own.strobe.eq(passing | (triangle.valid & own.ready)),
            triangle.ready.eq(own.ready & ~passing),
            own.packet.eq(packet),
            broadcast.ready.eq(Mux(making, Mux(object_, ~mine | reach_in.ready,
                                               chosen & words.ready), own.ready)),
            broadcast.done.eq(own.done & ~inside),
        ]
        with m.If(~passing):
            m.d.comb += [own.packet.operation.eq(Operation.DRAW),
                         own.packet.body.draw.eq(triangle.payload)]

    def _count(self, m, forwarder, setup, start):
        """Objects that are passed on, either way, and triangles as set-up counts them."""
        layout = RESPONSE_FIELDS[ResponseKind.FORWARDED]
        counts = {}
        for way in layout:
            out = getattr(forwarder, f"to_{way}")
            counts[way] = count = Signal(layout[way], name=f"forwarded_{way}")
            m.d.sync += count.eq(Mux(start, 0, count + (out.valid & out.ready)))
        m.d.comb += [self.made.eq(setup.made), self.dropped.eq(setup.dropped),
                     self.forwarded.eq(response_value(ResponseKind.FORWARDED, **counts))]
