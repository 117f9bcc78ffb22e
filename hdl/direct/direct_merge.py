"""The merge card D: every fragment goes to the memory unit that has its pixel."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ..backplane.connectors import BroadcastLines, Connector, memory_bus_bits
from ..backplane.fragment_lines import FragmentLines
from ..backplane.response_link import ResponseLink
from ..backplane.words import Operation
from ..mapping.interlace import PixelAddress
from ..processing_element.control import ProcessingElementControl
from ..processing_element.depth_read_back import DepthReadBack
from ..processing_element.memory_bus_selector import MemoryBusSelector
from ..processing_element.survey import Survey
from ..rasteriser.interpolator import fragment_layout
from ..wires import wires
from .crossbar import Crossbar
from .unit_counters import UnitCounters

__all__ = ["DirectMerge"]


class DirectMerge(wiring.Component):
    """Hands on what the processing elements on its left draw to the memory units on its right,
    which test depths themselves.

    ::

        processing elements ══▶ Crossbar ══▶ memory units
                                                 ▲
        broadcast ─▶ control ─▶ Survey, DepthReadBack (memory bus)
                        └──▶ UnitCounters ─▶ response link ◀── from the right

    As to the survey and the read-back of depths it is the processing element of all units; with the
    counters it says of each unit how many fragments it took.  It does so when nothing is drawn:
    what it is told it does at once.

    Latency: ``latency`` clocks for a fragment for which nothing is in the way.  Throughput: a
    fragment a clock from each element and to each unit (``Crossbar``).

    Members
    -------
    left: In(Connector), right: Out(Connector)
        The neighbouring slots; the ID and the node lines pass, the memory bus begins here.
    total: In(id_bits)
        Number of memory units in the cage.
    broadcast: In(BroadcastLines)
    elements: In(stream of fragment_layout) [maximum_nodes]
        Of the processing elements, from left to right.
    units: Out(FragmentLines) [maximum_units]
        To the memory units, likewise.

    Denali, in Cox & Hanrahan 1993, section 4; Fuchs & Johnson, figure 17.
    """

    latency = Crossbar.latency

    def __init__(self, *, configuration: MachineConfiguration):
        self.configuration = configuration
        bits = memory_bus_bits(configuration)
        words = {name: bits[name] for name in ("address_bits", "depth_bits")}
        units = configuration.maximum_units
        self._crossbar = Crossbar(elements=configuration.maximum_nodes, units=units,
                                  queue=configuration.queue, **bits)
        self._control = ProcessingElementControl(id_bits=configuration.id_bits,
                                                 depth_bits=configuration.rank_bits,
                                                 order_bits=configuration.order_bits)
        self._counters = UnitCounters(units=units)
        self._survey = Survey(**bits)
        self._read_back = DepthReadBack(**bits)
        self._selector = MemoryBusSelector(**bits)
        super().__init__({
            "left": In(Connector(configuration)),
            "right": Out(Connector(configuration)),
            "total": In(configuration.id_bits),
            "broadcast": In(BroadcastLines(configuration)),
            "elements": In(stream.Signature(fragment_layout(**bits))
                           ).array(configuration.maximum_nodes),
            "units": Out(FragmentLines(**words)).array(units),
        })

    def elaborate(self, platform):
        m = Module()
        m.submodules.crossbar = self._crossbar
        m.submodules.control = self._control
        m.submodules.counters = self._counters
        m.submodules.survey = self._survey
        m.submodules.read_back = self._read_back
        m.submodules.selector = self._selector
        busy = self._connect_fragments(m, wires(m, "fragment_wires"))
        self._connect_services(m, wires(m, "service_wires"))
        self._connect_memory_bus(wires(m, "line_wires"))
        told = self._listen(m)
        self._connect_responses(m, told, busy)
        return m

    def _connect_fragments(self, m, part):
        """Through the crossbar, and what is counted.  Returns that some are under way."""
        crossbar, counters = self._crossbar, self._counters
        for own, inner in zip(self.elements, crossbar.elements, strict=True):
            wiring.connect(part, wiring.flipped(own), inner)
        for number, (own, inner) in enumerate(zip(self.units, crossbar.units, strict=True)):
            wiring.connect(part, inner, wiring.flipped(own.fragments))
            part.d.comb += [
                counters.taken[number].eq(own.fragments.valid & own.fragments.ready),
                counters.followed[number].eq(own.followed),
            ]
        # A clock late, as an element says that it draws: together they leave no clock out.
        busy = Signal()
        m.d.sync += busy.eq(crossbar.busy | Cat(own.busy for own in self.units).any())
        return busy

    def _connect_services(self, m, part):
        """Survey and read-back of all units."""
        m.submodules.picture = picture = PixelAddress(configuration=self.configuration)
        control, survey, read_back = self._control, self._survey, self._read_back
        first = self.left.id
        m.d.comb += [self.right.id.eq(first), self.right.node.eq(self.left.node)]
        part.d.comb += [
            picture.total.eq(self.total),
            survey.total.eq(self.total),
            read_back.last_word.eq(picture.last_word),
            *(each.first.eq(first) for each in (survey, read_back, control)),
            *(each.end.eq(survey.end) for each in (read_back, control, self._counters)),
            survey.start.eq(control.survey_start),
            control.survey_done.eq(survey.done),
            read_back.start.eq(control.read_back_start),
            control.read_back_done.eq(read_back.done),
            self._selector.surveying.eq(control.surveying),
            self._selector.reading.eq(control.reading),
        ]
        wiring.connect(part, read_back.depths, control.depths)

    def _connect_memory_bus(self, m):
        """No depth test here has it: its address is 0 while the survey writes."""
        selector = self._selector
        wiring.connect(m, self._survey.memory, selector.survey)
        wiring.connect(m, self._read_back.memory, selector.read_back)
        wiring.connect(m, selector.lines, wiring.flipped(self.right.lines))

    def _listen(self, m):
        """What is broadcast.  Returns that an operation is to be done, or is being done."""
        broadcast, counters, operations = self.broadcast, self._counters, self._control.operations
        operation = broadcast.packet.operation
        told = Signal()
        m.d.comb += [
            broadcast.ready.eq(1),
            operations.valid.eq(told),
            counters.clear.eq(broadcast.strobe & (operation == Operation.FRAME_START)),
            counters.start.eq(broadcast.strobe & (operation == Operation.READ_COUNTERS)),
        ]
        asks = (operation == Operation.SURVEY) | (operation == Operation.READ_DEPTH)
        with m.If(broadcast.strobe & asks):
            m.d.sync += [told.eq(1), operations.payload.eq(operation)]
        with m.Elif(operations.ready):
            m.d.sync += told.eq(0)
        return told

    def _connect_responses(self, m, told, busy):
        """The chain of responses; nothing from the right passes while this card has something to
        say."""
        m.submodules.link = link = ResponseLink()
        part = wires(m, "response_wires")
        control, counters, own = self._control.responses, self._counters.responses, link.own
        part.d.comb += [
            own.valid.eq(control.valid | counters.valid),
            Value.cast(own.payload).eq(Value.cast(control.payload) | Value.cast(counters.payload)),
            control.ready.eq(own.ready),
            counters.ready.eq(own.ready),
        ]
        wiring.connect(part, wiring.flipped(self.right.response), link.right)
        wiring.connect(part, link.left, wiring.flipped(self.left.response))
        speaks = told | self._counters.busy
        part.d.comb += [
            link.own_turn.eq(speaks),
            self.broadcast.done.eq(~speaks & ~busy & ~link.left.valid),
        ]
