"""The controller of nodes on a bus, with a cage in software: one frame is drawn while another is
merged and a third is shown."""

import random

import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.cage import COUNTS, DEPTHS, Cage, Scans, Units
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import (
    Fault,
    Opcode,
    ResponseKind,
    response_value,
)
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.controller.central_broadcast_controller import CentralBroadcastController

NODES, FRAMES = 3, 2
#: Responses: DOMAIN and NODE of each, UNITS, NODES, FRAME_UNITS, PICTURE, BOOTED.
BOOT = NODES * 2 + 5


class NodeCage(Cage):
    """Its elements are those of nodes of one unit each."""

    def answer(self, operation):
        if operation == Operation.SURVEY:
            return [answer for node in range(NODES) for answer in (
                (ResponseKind.DOMAIN, response_value(ResponseKind.DOMAIN, first=0, units=1)),
                (ResponseKind.NODE, response_value(ResponseKind.NODE, units=1, node=node)))]
        return super().answer(operation)


class Merge(Agent):
    """Nodes that end one after the other, each after a while; looks at the lines meanwhile.

    ``merges``: of each (clock of the start, clock of the last end, tag that was handed over).
    """

    finished = True

    def __init__(self, dut, pause):
        self.dut, self.pause = dut, pause
        self.clock = self.left = self.wait = 0
        self.merges, self.backgrounds = [], []
        self.tags = None

    def drive(self, ctx):
        self.ends = self.left and self.wait == 0
        ctx.set(self.dut.snoop.ended, self.ends)

    def sample(self, ctx):
        dut, nodes, frame = self.dut, self.dut.pictures, self.dut.frame_pictures
        front, shown = ctx.get(nodes.front), ctx.get(frame.front)
        tags = (ctx.get(nodes.color_tag[front]), ctx.get(frame.color_tag[1 - shown]))
        if self.ends:
            self.left -= 1
            self.wait = self.pause()
            if not self.left:
                self.merges[-1][1] = self.clock
        elif self.wait:
            self.wait -= 1
        if ctx.get(dut.snoop.start):
            assert not self.left
            self.left, self.wait = NODES, 1 + self.pause()
            self.tags = tags
            self.merges.append([self.clock, None, tags[0]])
        if self.left:  # what is merged keeps its place and its tag in the nodes and the frame units
            assert self.tags == tags and tags[0] == tags[1]
            assert ctx.get(nodes.depth_tag) == ctx.get(nodes.color_tag[1 - front]) or (
                ctx.get(nodes.depth_tag) == tags[0])
        assert ctx.get(nodes.initialise) == ctx.get(frame.initialise)
        assert ctx.get(nodes.sweep) == ctx.get(frame.sweep)
        self.backgrounds.append(ctx.get(dut.background))
        self.clock += 1


class Shown(Scans):
    """What is shown is the frame units' colour."""

    def sample(self, ctx):
        self.fronts.append(ctx.get(self.dut.frame_pictures.front))
        self.clock += 1


class Run:
    def __init__(self, words, responses, *, seed=None, work=0, period=50, frame_units=FRAMES,
                 merging=no_pause, **changes):
        configuration = small_machine(f"{NODES}x(PMS)" + "F" * FRAMES, tag_bits=3, **changes)
        self.dut = dut = CentralBroadcastController(configuration=configuration)
        pause = (lambda end: no_pause) if seed is None else (lambda end: pauses(f"{end} {seed}"))
        self.source = Source(dut.commands, words, pause("in"))
        self.sink = Sink(dut.responses, responses, pause("out"))
        self.cage = NodeCage(dut, domains=[(0, 1)] * NODES, seed=seed, work=work)
        self.scans = Shown(dut, period)
        self.merge = Merge(dut, merging)
        units, frames = Units(dut, 20), Units(dut, 30)
        frames.lines = dut.frame_pictures

        def lines(ctx, clock):
            ctx.set(dut.total, 1)
            ctx.set(dut.nodes, NODES)
            ctx.set(dut.frame_units, frame_units)

        simulate(dut, Drive(lines), self.source, self.sink, self.cage, self.scans, units, frames,
                 self.merge, after=10, limit=60_000)

    @property
    def responses(self):
        return [(ResponseKind(item.kind), item.value) for item in self.sink.items]

    def of(self, kind):
        """(clock, value) of each response of that kind."""
        return [(clock, value) for clock, (found, value) in zip(
            self.sink.clocks, self.responses, strict=True) if found == kind]


END, READ_DEPTH, READ_COUNTERS = (commands.command(opcode) for opcode in (
    Opcode.FRAME_END, Opcode.READ_DEPTH, Opcode.READ_COUNTERS))
DRAW = commands.command(Opcode.PREPARED_TRIANGLE)


def background(number):
    return (number + 1, 7, 9)


def sequence(pick, frames):
    return [word for number in range(frames) for word in [
        commands.frame_start(background(number)), *[DRAW] * pick.choice((0, 2, 9)), END]]


def test_boot():
    run = Run([], BOOT)
    kinds = [kind for kind, _ in run.responses]
    assert kinds == [*[ResponseKind.DOMAIN, ResponseKind.NODE] * NODES, ResponseKind.UNITS,
                     ResponseKind.NODES, ResponseKind.FRAME_UNITS, ResponseKind.PICTURE,
                     ResponseKind.BOOTED]
    assert run.of(ResponseKind.FRAME_UNITS)[0][1] == FRAMES
    # Both kinds of units are black by then.
    assert run.of(ResponseKind.BOOTED)[0][1] > 30


@pytest.mark.parametrize("frame_units", [0, 3])
def test_a_number_of_frame_units_that_cannot_be_is_refused(frame_units):
    run = Run([END, READ_DEPTH], BOOT + 1, frame_units=frame_units)
    fault = (ResponseKind.ERROR, Fault.UNITS_UNSUPPORTED)
    assert run.responses[NODES * 2 + 3:] == [fault] * 3


@pytest.mark.parametrize("seed", [None, 0, 1, 2, 3])
def test_frames_that_overlap(seed):
    """Every frame is drawn, merged and shown in its turn, with its own background; what belongs to
    one is answered in order, whatever is answered to later commands in between."""
    pick = random.Random(f"overlap {seed}")
    frames = 14
    words = [*sequence(pick, frames), 15]
    merging = no_pause if seed is None else pauses(f"merging {seed}")
    run = Run(words, BOOT + 3 * frames + 1, seed=seed, work=0 if seed is None else 30, period=40,
              merging=lambda: merging() * pick.choice((1, 1, 9)))
    starts = [clock for clock, word in zip(run.source.taken, words, strict=True)
              if word & 15 == Opcode.FRAME_START]
    drawn, merged, shown = (run.of(kind) for kind in (
        ResponseKind.FRAME_DRAWN, ResponseKind.MERGED, ResponseKind.FRAME_SHOWN))
    assert len(drawn) == len(merged) == len(shown) == len(run.merge.merges) == frames
    assert len(run.scans.swaps) == frames
    for number in range(frames):
        begin, end, _ = run.merge.merges[number]
        assert drawn[number][0] < begin < end < merged[number][0] < shown[number][0]
        assert merged[number][1] == end - starts[number]
        swap = run.scans.swaps[number]
        assert swap == min(clock for clock in run.scans.starts if clock > merged[number][0])
        assert shown[number][1] == sum(starts[number] <= clock < swap
                                       for clock in run.scans.starts)
        color = sum(value << 8 * place for place, value in enumerate(background(number)))
        assert run.merge.backgrounds[swap + 1] == color != run.merge.backgrounds[swap]
    for number in range(2, frames):  # there is memory for two
        assert starts[number] > run.merge.merges[number - 2][0]
    if seed is None:
        assert any(starts[number + 1] < merged[number][0] for number in range(frames - 1))
    assert run.of(ResponseKind.ERROR)[0][1] == Fault.UNKNOWN_COMMAND


def test_latency():
    """With nothing to wait for: a clock from the report that all is drawn to the hand-over, one to
    the merge; and the next frame begins then."""
    words = sequence(random.Random(1), 2)
    run = Run(words, BOOT + 6)
    drawn, merged = run.of(ResponseKind.FRAME_DRAWN)[0][0], run.of(ResponseKind.MERGED)[0][0]
    begin, end, _ = run.merge.merges[0]
    assert begin == drawn + 2
    assert merged == end + 2
    start = next(clock for clock, word in zip(run.source.taken, words, strict=True)
                 if word & 15 == Opcode.FRAME_START and clock > drawn)
    assert start == drawn + 2


@pytest.mark.parametrize("seed", [None, 5])
def test_read_backs_wait_until_all_is_shown(seed):
    words = [*sequence(random.Random(2), 2), READ_DEPTH, READ_COUNTERS,
             commands.frame_start((1, 2, 3)), DRAW, READ_DEPTH, END, READ_DEPTH]
    run = Run(words, BOOT + 3 * 3 + 3 * len(DEPTHS) + NODES * len(COUNTS), seed=seed)
    kinds = [kind for kind, _ in run.responses[BOOT:]]
    counts = [kind for kind, _ in COUNTS] * NODES
    frame = [ResponseKind.FRAME_DRAWN, ResponseKind.MERGED, ResponseKind.FRAME_SHOWN]
    depths = [ResponseKind.DEPTH] * len(DEPTHS)
    assert kinds[-len(depths) * 3 - len(counts) - 4:] == [
        ResponseKind.FRAME_SHOWN, *depths, *counts, *depths, *frame, *depths]
