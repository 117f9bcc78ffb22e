"""Operations in their order, each when the datapath is empty."""

import random

import pytest
from amaranth.hdl import Fragment
from hdl_bench.bench import Agent, Watch, rejects, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.processing_element.control import ProcessingElementControl

SERVICES = {"survey": "surveying", "read_back": "reading"}
FIRST, END, FRAGMENTS, BUSY = 1, 4, 0x89ABCDEF, 0x01234567
DEPTHS = [17, 0, 255, 128, 3]
#: For merge cards only.
UNKNOWN = 7
#: A triangle is none: it does not pass through here.
OPERATIONS = [Operation.SURVEY, Operation.FRAME_START, Operation.READ_DEPTH,
              Operation.READ_COUNTERS]


class Datapath(Agent):
    """Draws for ``hold()`` clocks, from the beginning and anew behind each operation.

    So operations come while it draws, and it draws when none is there.
    """

    def __init__(self, dut, source, hold):
        self.dut = dut
        self.source = source
        self.hold = hold
        self.left = hold()
        self.seen = 0
        self.drawing = []

    @property
    def finished(self):
        return self.left == 0

    def drive(self, ctx):
        if len(self.source.taken) > self.seen:
            self.seen = len(self.source.taken)
            self.left = self.hold()
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
        ctx.set(self.dut.depths.payload, self.unsent[0] if sending else 0)

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


RESPONSES = {
    Operation.SURVEY: [(ResponseKind.DOMAIN, FIRST << 16 | END - FIRST)],
    Operation.READ_DEPTH: [(ResponseKind.DEPTH, depth) for depth in DEPTHS],
    Operation.READ_COUNTERS: [(ResponseKind.FRAGMENTS, FRAGMENTS), (ResponseKind.BUSY, BUSY)],
}
STARTS = {Operation.SURVEY: "survey", Operation.READ_DEPTH: "read_back"}


def run(kinds, *, pause=(no_pause,) * 2, hold=lambda: 0, time=lambda: 2):
    dut = ProcessingElementControl(id_bits=3, depth_bits=8)
    answers = [answer for kind in kinds for answer in RESPONSES.get(kind, ())]
    # As numbers: also one that has no name.
    source = Source(dut.operations, [getattr(kind, "value", kind) for kind in kinds], pause[0])
    responses = Sink(dut.responses, len(answers), pause[1], zero=True)
    datapath, parts = Datapath(dut, source, hold), Parts(dut, time)
    frame_starts = []

    def watch(ctx, clock):
        for name, value in (("first", FIRST), ("end", END), ("fragments", FRAGMENTS),
                            ("busy_cycles", BUSY)):
            ctx.set(getattr(dut, name), value)
        drawing = datapath.drawing[clock]
        waiting = ctx.get(dut.operations.valid)
        assert ctx.get(dut.idle) == (not drawing and not waiting)
        assert waiting or not parts.running
        if drawing:
            assert not ctx.get(dut.operations.ready)
        if ctx.get(dut.frame_start):
            frame_starts.append(clock)

    # The watch looks before the parts move on.
    simulate(dut, Watch(watch), source, responses, datapath, parts, after=8)
    assert [(item.kind, item.value) for item in responses.items] == answers
    assert [name for _, name in parts.log] == [STARTS[kind] for kind in kinds if kind in STARTS]
    for clock, _ in parts.log:
        assert not datapath.drawing[clock]
    assert frame_starts == [clock for clock, kind in zip(source.taken, kinds, strict=True)
                            if kind == Operation.FRAME_START]
    return source, responses, datapath, parts


def empty_after(datapath):
    """The first clock after the drawing."""
    return 1 + max(clock for clock, drawing in enumerate(datapath.drawing) if drawing)


@pytest.mark.parametrize("seed", range(6))
def test_random_operations(seed):
    pick = random.Random(f"operations {seed}")
    kinds = [pick.choice([*OPERATIONS, UNKNOWN]) for _ in range(40)]
    _, _, datapath, parts = run(kinds, pause=[pauses(f"{end} {seed}") for end in range(2)],
                                hold=lambda: pick.randrange(9), time=lambda: pick.randrange(6))
    assert len(parts.log) > 8 and sum(datapath.drawing) > 50


@pytest.mark.parametrize("kind", STARTS)
@pytest.mark.parametrize("hold", [0, 5])
def test_services_begin_when_the_datapath_is_empty(kind, hold):
    *_, datapath, parts = run([kind], hold=iter((hold, 0)).__next__)
    # Started in the first clock without a triangle; the lines are the service's from the next on.
    assert parts.log == [(empty_after(datapath) if hold else 0, STARTS[kind])]


def test_a_frame_start_takes_a_clock():
    source, *_ = run([Operation.FRAME_START] * 10)
    assert source.taken == list(range(10))


@pytest.mark.parametrize("hold", [1, 5])
def test_a_frame_starts_when_the_datapath_is_empty(hold):
    source, _, datapath, _ = run([Operation.FRAME_START], hold=iter((hold, 0)).__next__)
    assert source.taken == [empty_after(datapath)]


def test_counters_follow_when_the_datapath_is_empty():
    source, responses, datapath, _ = run([Operation.READ_COUNTERS], hold=iter((5, 0)).__next__)
    empty = empty_after(datapath)
    assert responses.clocks == [empty + 1, empty + 2]
    assert source.taken == [empty + 2]


@pytest.mark.parametrize("kind", [0, 6, 7])
def test_operations_of_a_newer_controller_are_passed_over(kind):
    source, *_ = run([kind, Operation.SURVEY, kind, kind])
    assert source.taken[0] == 0
    assert source.taken[1:] == [source.taken[1] + clock for clock in range(3)]


@pytest.mark.parametrize("name", ["id_bits", "depth_bits"])
def test_bad_sizes(name):
    rejects(ProcessingElementControl, name, **{"id_bits": 3, "depth_bits": 8} | {name: 0})
    control = ProcessingElementControl(**{"id_bits": 3, "depth_bits": 8} | {name: 1})
    Fragment.get(control, None)
    assert getattr(control, name) == 1
