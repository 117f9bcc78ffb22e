"""A cage in software around the controller: processing elements, memory units, scans."""

import random
from collections import deque
from itertools import pairwise

from amaranth.hdl import Value

from cardcage.golden.specification.commands import ResponseKind, response_value
from cardcage.hdl.backplane.connectors import BroadcastLines
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.controller.central_broadcast_controller import CentralBroadcastController

from .bench import Agent, Drive, simulate
from .streams import Sink, Source, no_pause, pauses

DEPTHS = [11, 22, 33]
COUNTS = [(ResponseKind.FRAGMENTS, 5), (ResponseKind.BUSY, 6)]


class Cage(Agent):
    """All processing elements as one: takes packets while ready, works on each for a while,
    then sends its answers.  A strobe shows in done as late as the controller has to bear with."""

    LATE = BroadcastLines.settle_clocks

    def __init__(self, dut, *, domains, seed=None, work=0):
        self.dut = dut
        self.domains = domains
        self.pick = random.Random(f"cage {seed}")
        self.stalls = seed is not None
        self.work = work
        self.queue = deque()
        self.left = 0
        self.answers = deque()
        self.offered = None
        self.late = 0
        self.packets = []  # (clock, operation, word)
        self.idle = []
        self.clock = 0

    @property
    def finished(self):
        return not (self.queue or self.answers or self.left)

    def drive(self, ctx):
        lines, response = self.dut.broadcast, self.dut.right.response
        self.ready = len(self.queue) < 3 and not (self.stalls and self.pick.random() < 0.4)
        ctx.set(lines.ready, self.ready)
        self.idle.append(self.finished)
        ctx.set(lines.done, self.finished or self.late > 0)
        if self.offered is None and self.answers and not (
                self.stalls and self.pick.random() < 0.3):
            self.offered = self.answers[0]
            ctx.set(response.payload, dict(zip(("kind", "value"), self.offered, strict=True)))
        ctx.set(response.valid, self.offered is not None)

    def sample(self, ctx):
        lines, response = self.dut.broadcast, self.dut.right.response
        if self.offered is not None and ctx.get(response.ready):
            self.answers.popleft()
            self.offered = None
        self.late = max(0, self.late - 1)
        if self.left:
            self.left -= 1
            if self.left == 0:
                self.answers += self.answer(self.queue.popleft())
        elif self.queue and not self.answers:
            self.left = 1 + (self.pick.randrange(self.work) if self.work else 0)
        if ctx.get(lines.strobe):
            assert self.ready, f"clock {self.clock}: a strobe while not all are ready"
            packet = ctx.get(lines.packet)
            self.packets.append((self.clock, packet.operation, ctx.get(Value.cast(lines.packet))))
            self.queue.append(packet.operation)
            self.late = self.LATE
        self.clock += 1

    def answer(self, operation):
        if operation == Operation.SURVEY:
            return [(ResponseKind.DOMAIN, response_value(
                ResponseKind.DOMAIN, first=first, units=count)) for first, count in self.domains]
        if operation == Operation.READ_DEPTH:
            return [(ResponseKind.DEPTH, depth) for depth in DEPTHS]
        return COUNTS * len(self.domains) if operation == Operation.READ_COUNTERS else []


class Units(Agent):
    """All memory units as one: passes that take ``words`` clocks, and what the lines show."""

    def __init__(self, dut, words):
        self.dut = dut
        self.lines = dut.pictures
        self.words = words
        self.left = 0
        self.clock = 0
        self.initialised = []
        self.passes = []
        self.ended = []
        self.tags = []  # depth, colours, in every clock
        self.backgrounds = []

    @property
    def finished(self):
        return self.left == 0

    def drive(self, ctx):
        ctx.set(self.lines.swept, self.left == 0)

    def sample(self, ctx):
        if self.left:
            self.left -= 1
            if self.left == 0:
                self.ended.append(self.clock)
        for line, log in ((self.lines.initialise, self.initialised),
                          (self.lines.sweep, self.passes)):
            if ctx.get(line):
                assert self.left == 0
                log.append(self.clock)
                self.left = self.words
        self.tags.append(tuple(ctx.get(tag) for tag in (self.lines.depth_tag,
                                                        *self.lines.color_tag)))
        self.backgrounds.append(ctx.get(self.dut.background))
        self.clock += 1


class Scans(Agent):
    """Pulses ``scan_start`` every ``period`` clocks, and looks at ``front`` around them."""

    def __init__(self, dut, period):
        self.dut = dut
        self.period = period
        self.clock = 0
        self.starts, self.fronts = [], []

    def drive(self, ctx):
        start = self.clock % self.period == self.period - 1
        ctx.set(self.dut.scan_start, start)
        if start:
            self.starts.append(self.clock)

    def sample(self, ctx):
        self.fronts.append(ctx.get(self.dut.pictures.front))
        self.clock += 1

    @property
    def swaps(self):
        """Clocks at whose end the front changed."""
        return [clock for clock, (a, b) in enumerate(pairwise(self.fronts)) if a != b]


class Run:
    def __init__(self, configuration, words, responses, *, total=None, domains=((0, 1),),
                 seed=None, work=0, period=50, depth=20):
        self.dut = dut = CentralBroadcastController(configuration=configuration)
        total = configuration.units if total is None else total
        pause = (lambda end: no_pause) if seed is None else (lambda end: pauses(f"{end} {seed}"))
        self.source = Source(dut.commands, words, pause("in"))
        self.sink = Sink(dut.responses, responses, pause("out"))
        self.cage = Cage(dut, domains=domains, seed=seed, work=work)
        self.scans = Scans(dut, period)
        self.units = Units(dut, depth)

        def lines(ctx, clock):
            ctx.set(dut.total, total)
            assert ctx.get(dut.right.id) == 0

        simulate(dut, Drive(lines), self.source, self.sink, self.cage, self.scans, self.units,
                 after=10)

    @property
    def responses(self):
        return [(ResponseKind(item.kind), item.value) for item in self.sink.items]

    def clock_of(self, kind, count=0):
        clocks = [clock for clock, (found, _) in zip(self.sink.clocks, self.responses, strict=True)
                  if found == kind]
        return clocks[count]

    def fields(self, number, variant=None):
        """Operation of a packet, and its body's bits."""
        _, operation, word = self.cage.packets[number]
        layout = Value.cast(self.dut.broadcast.packet)
        assert len(layout) >= word.bit_length()
        body = self.dut.broadcast.packet.shape()["body"]
        return operation, word >> body.offset & (1 << body.width) - 1


def boot_responses(configuration, domains, total=None):
    owned = sum(count for _, count in domains)
    total = configuration.units if total is None else total
    interlace = configuration.interlace
    reports = [*((ResponseKind.DOMAIN, {"first": first, "units": count})
                 for first, count in domains),
               (ResponseKind.UNITS, {"owned": owned, "total": total}),
               (ResponseKind.PICTURE, {"width": interlace.width, "height": interlace.height})]
    return [(kind, response_value(kind, **fields)) for kind, fields in reports]
