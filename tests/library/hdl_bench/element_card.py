"""A processing element card in a slot: what it is told, software memory units to its right."""

from amaranth.hdl import Value

from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.processing_element.processing_element import ProcessingElement

from .bench import Agent, Drive, Watch, simulate
from .memory import MemoryBusModel
from .streams import Sink, Source

SURVEY = {"operation": Operation.SURVEY}
FRAME_START = {"operation": Operation.FRAME_START}
READ_DEPTH = {"operation": Operation.READ_DEPTH}
READ_COUNTERS = {"operation": Operation.READ_COUNTERS}
READ_REGIONS = {"operation": Operation.READ_REGIONS}


def draw(values):
    return {"operation": Operation.DRAW, "body": {"draw": values}}


class Announcer(Agent):
    """Strobes packets while the card is ready; waits for its done where there is ``None``.

    As the controller does, it looks at done some clocks after a strobe only, and starts a frame
    in ``memory`` when all is done.  ``frames`` counts these; none starts but if ``may_start()``.
    """

    def __init__(self, dut, memory, packets, pause=lambda: 0):
        self.dut = dut
        self.memory = memory
        self.packets = list(packets)
        self.pause = pause
        self.wait = 0
        self.settle = 0
        self.clock = 0
        self.frames = 0
        self.strobes = []
        self.dones = []

    @property
    def finished(self):
        return not self.packets

    def may_start(self):
        return True

    def drive(self, ctx):
        lines = self.dut.broadcast
        ctx.set(lines.strobe, 0)
        if not self.packets or self.settle or self.wait:
            self.wait = max(0, self.wait - 1)
            return
        starts = self.packets[0] == FRAME_START
        if self.packets[0] is not None and ctx.get(lines.ready) and not (
                starts and not self.may_start()):
            if starts:
                assert ctx.get(lines.done)
                self.memory.start_frame()
                self.frames += 1
            ctx.set(lines.packet, self.packets.pop(0))
            ctx.set(lines.strobe, 1)
            self.strobes.append(self.clock)
            self.wait = self.pause()
            if self.packets and self.packets[0] is None:
                self.settle = BroadcastLines.settle_clocks + 1

    def sample(self, ctx):
        if self.strobes and self.strobes[-1] == self.clock - 1:
            assert not ctx.get(self.dut.broadcast.done), "done right after a strobe"
        waiting = self.packets and self.packets[0] is None and self.settle == 0
        if waiting and ctx.get(self.dut.broadcast.done):
            self.packets.pop(0)
            self.dones.append(self.clock)
        self.settle = max(0, self.settle - 1)
        self.clock += 1


class Bench:
    """One card in a slot: number of units to the left, its domain, and what it is told.

    ``deal``  makes an agent of the card and of what tells it, for its other lines.
    """

    def __init__(self, configuration, first, end, packets, *, responses=0, seed=0, scan=0.0,
                 pause=lambda: 0, right=(), deal=lambda dut, announcer: Agent()):
        self.dut = dut = ProcessingElement(configuration=configuration)
        self.memory = MemoryBusModel(dut.right.lines, first=first, end=end,
                                     words=configuration.words, seed=seed, scan=scan,
                                     depth_bits=configuration.depth_bits,
                                     ports=configuration.memory_ports)
        self.announcer = Announcer(dut, self.memory, packets, pause)
        self.sink = Sink(dut.left.response, responses + len(right), pause)
        self.source = Source(dut.right.response, right, pause)

        def lines(ctx, clock):
            ctx.set(dut.left.id, first)
            ctx.set(dut.total, configuration.units)
            # What comes from the left is not for it.
            ctx.set(Value.cast(dut.left.lines.write), -1)
            ctx.set(Value.cast(dut.left.lines.read), -1)

        def watch(ctx, clock):
            assert ctx.get(dut.right.id) == first
            assert ctx.get(dut.left.lines.read_data) == 0
            assert not ctx.get(dut.left.lines.read_busy) | ctx.get(dut.left.lines.write_busy)

        self.clocks = simulate(dut, Drive(lines), deal(dut, self.announcer), self.announcer,
                               self.memory, self.source, self.sink, Watch(watch), after=4)

    @property
    def responses(self):
        return [(ResponseKind(item.kind), item.value) for item in self.sink.items]
