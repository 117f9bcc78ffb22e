"""Operations in their order: triangles flow on, everything else waits for an empty datapath."""

import random

import pytest
from amaranth.hdl import Value
from hdl_bench.bench import Agent, Watch, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.commands import ResponseKind
from cardcage.hdl.layouts import Operation
from cardcage.hdl.processing_element_control import ProcessingElementControl

CONFIGURATION = small_machine("PMMMM")
SERVICES = {"survey": "surveying", "read_back": "reading"}
FIRST, END, FRAGMENTS, BUSY = 1, 4, 0x89ABCDEF, 0x01234567
DEPTHS = [17, 0, 255, 128, 3]
UNKNOWN = 7


class Datapath(Agent):
    """Takes triangles, and holds each for a while after."""

    def __init__(self, dut, triangles, hold):
        self.dut = dut
        self.triangles = triangles  # the sink behind the port
        self.hold = hold
        self.left = 0
        self.seen = 0
        self.drawing = []

    @property
    def finished(self):
        return self.left == 0

    def drive(self, ctx):
        if len(self.triangles.items) > self.seen:
            self.seen = len(self.triangles.items)
            self.left = max(self.left, self.hold())
        ctx.set(self.dut.drawing, self.left > 0)
        self.drawing.append(self.left > 0)
        self.left = max(0, self.left - 1)


class Parts(Agent):
    """The two services: each takes its time; the reader sends depths meanwhile."""

    def __init__(self, dut, time):
        self.dut = dut
        self.time = time
        self.running = None
        self.left = 0
        self.unsent = []
        self.log = []  # (clock, service) of every start
        self.clock = 0

    def drive(self, ctx):
        for name in SERVICES:
            done = self.running == name and self.left == 0 and not self.unsent
            ctx.set(getattr(self.dut, f"{name}_done"), done)
        sending = self.running == "read_back" and bool(self.unsent) and self.left == 0
        ctx.set(self.dut.depths.valid, sending)
        if sending:
            ctx.set(self.dut.depths.payload, self.unsent[0])

    def sample(self, ctx):
        dut = self.dut
        shown = [name for name, port in SERVICES.items() if ctx.get(getattr(dut, port))]
        assert shown == ([self.running] if self.running else [])
        started = [name for name in SERVICES if ctx.get(getattr(dut, f"{name}_start"))]
        if self.running is not None:
            assert not started
            if self.left:
                self.left -= 1
            elif self.unsent:
                if ctx.get(dut.depths.ready):
                    self.unsent.pop(0)
            else:
                self.running = None
        elif started:
            (self.running,) = started
            self.log.append((self.clock, self.running))
            self.left = self.time()
            self.unsent = list(DEPTHS) if self.running == "read_back" else []
        self.clock += 1


def operation(kind, marker=0):
    return {"operation": kind, "triangle": {"top": marker % 8, "left": marker // 8 % 8}}


def word(dut, kind, marker=0):
    """The packet as an integer, whatever the operation: also one that has no name."""
    layout = dut.operations.payload.shape()
    number = layout.const(operation(Operation.DRAW, marker)).as_bits()
    field = layout["operation"]
    mask = (1 << 3) - 1 << field.offset
    return number & ~mask | getattr(kind, "value", kind) << field.offset


RESPONSES = {
    Operation.SURVEY: [(ResponseKind.DOMAIN, FIRST << 16 | END - FIRST)],
    Operation.READ_DEPTH: [(ResponseKind.DEPTH, depth) for depth in DEPTHS],
    Operation.READ_COUNTERS: [(ResponseKind.FRAGMENTS, FRAGMENTS), (ResponseKind.BUSY, BUSY)],
}
STARTS = {Operation.SURVEY: "survey", Operation.READ_DEPTH: "read_back"}


def run(kinds, *, pause=(no_pause,) * 3, hold=lambda: 3, time=lambda: 2):
    dut = ProcessingElementControl(configuration=CONFIGURATION)
    words = [word(dut, kind, marker) for marker, kind in enumerate(kinds)]
    draws = [number for number, kind in zip(words, kinds, strict=True) if kind == Operation.DRAW]
    answers = [answer for kind in kinds for answer in RESPONSES.get(kind, ())]
    source = Source(dut.operations, words, pause[0])
    triangles = Sink(dut.triangles, len(draws), pause[1])
    responses = Sink(dut.responses, len(answers), pause[2])
    datapath, parts = Datapath(dut, triangles, hold), Parts(dut, time)
    frame_starts = []

    def watch(ctx, clock):
        for name, value in (("first", FIRST), ("end", END), ("fragments", FRAGMENTS),
                            ("busy_cycles", BUSY)):
            ctx.set(getattr(dut, name), value)
        drawing = datapath.drawing[clock]
        waiting = ctx.get(dut.operations.valid)
        if parts.running is None and not drawing and not waiting:
            assert ctx.get(dut.idle)
        if drawing or waiting or parts.running:
            assert not ctx.get(dut.idle)
        assert ctx.get(dut.working) == bool(drawing or ctx.get(dut.triangles.valid))
        if ctx.get(dut.frame_start):
            assert not drawing
            frame_starts.append(clock)

    # The watch looks before the parts move on.
    simulate(dut, Watch(watch), source, triangles, responses, datapath, parts, after=8)
    assert [(item.kind, item.value) for item in responses.items] == answers
    layout = dut.operations.payload.shape()
    body = layout["triangle"].offset
    size = len(Value.cast(dut.triangles.payload))
    assert [item.as_bits() for item in triangles.items] == [
        number >> body & (1 << size) - 1 for number in draws]
    assert [name for _, name in parts.log] == [STARTS[kind] for kind in kinds if kind in STARTS]
    for clock, _ in parts.log:
        assert not datapath.drawing[clock]
    assert frame_starts == [clock for clock, kind in zip(source.taken, kinds, strict=True)
                            if kind == Operation.FRAME_START]
    return source, triangles, responses, datapath, parts


@pytest.mark.parametrize("seed", range(6))
def test_random_operations(seed):
    pick = random.Random(f"operations {seed}")
    kinds = [pick.choice([*Operation, Operation.DRAW, Operation.DRAW, Operation.DRAW, UNKNOWN])
             for _ in range(40)]
    run(kinds, pause=[pauses(f"{end} {seed}") for end in range(3)],
        hold=lambda: pick.randrange(1, 9), time=lambda: pick.randrange(6))


def test_triangles_pass_in_the_same_clock():
    source, triangles, *_ = run([Operation.DRAW] * 10)
    assert source.taken == triangles.clocks == list(range(10))


@pytest.mark.parametrize("kind", STARTS)
def test_others_begin_when_the_datapath_is_empty(kind):
    *_, datapath, parts = run([Operation.DRAW, kind], hold=lambda: 5)
    empty = 1 + max(clock for clock, drawing in enumerate(datapath.drawing) if drawing)
    # Started in the first clock without a triangle; the lines are the service's from the next on.
    assert parts.log == [(empty, STARTS[kind])]


def test_a_frame_start_takes_a_clock():
    source, *_ = run([Operation.FRAME_START, Operation.DRAW])
    assert source.taken == [0, 1]


def test_counters_follow_when_the_datapath_is_empty():
    _, _, responses, datapath, _ = run([Operation.DRAW, Operation.READ_COUNTERS], hold=lambda: 5)
    empty = 1 + max(clock for clock, drawing in enumerate(datapath.drawing) if drawing)
    assert responses.clocks == [empty + 1, empty + 2]


@pytest.mark.parametrize("kind", [0, 6, 7])
def test_operations_of_a_newer_controller_are_passed_over(kind):
    source, *_ = run([kind, Operation.SURVEY, kind, kind])
    assert source.taken[0] == 0
    assert len(source.taken) == 4
