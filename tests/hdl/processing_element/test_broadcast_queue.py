"""What a processing element keeps of a broadcast: what it owns pixels of, in order."""

import random
from dataclasses import replace

import pytest
from hdl_bench.bench import Agent, Drive, Watch, simulate
from hdl_bench.pictures import prepare, prepared_values, random_triangles, small_machine
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.processing_element.broadcast_queue import BroadcastQueue

#: Offset and mask in x, then in y, of the owned pixels.
#: The last one's rows are shifted in turn: a column of either kind counts.
LATTICES = {"everything": (0, 0, 0, 0), "every other row": (0, 0, 1, 1),
            "one of eight": (1, 1, 2, 3), "one of sixteen": (2, 3, 3, 3),
            "one of sixteen, skewed": (6, 7, 1, 1)}


class Announcer(Agent):
    """Strobes ``packets`` while the queue is ready, as the controller does."""

    def __init__(self, dut, packets, pause):
        self.dut = dut
        self.packets = packets
        self.pause = pause
        self.wait = pause()
        self.strobes = []
        self.clock = 0

    @property
    def finished(self):
        return len(self.strobes) == len(self.packets)

    def drive(self, ctx):
        offer = not self.finished and not self.wait and ctx.get(self.dut.ready)
        ctx.set(self.dut.strobe, offer)
        if offer:
            ctx.set(self.dut.packet, self.packets[len(self.strobes)])
            self.strobes.append(self.clock)
            self.wait = self.pause()
        elif self.wait:
            self.wait -= 1
        self.clock += 1


class Follower(Sink):
    """Takes no more than ``leader`` has: interpolants are used after their outlines."""

    def __init__(self, leader, *rest):
        self._leader = leader
        super().__init__(*rest)

    def drive(self, ctx):
        if len(self.items) == len(self._leader.items):
            self._wait = max(1, self._wait)
        super().drive(ctx)


def run(kind, seed, *, whole=1, pause=(no_pause,) * 4, depth=16, others=0.2):
    skew = "skewed" in kind
    configuration = replace(small_machine("PM" + 15 * "M", 16, 16), fifo_depth=depth, skew=skew)
    x_offset, x_mask, y_offset, y_mask = LATTICES[kind]
    display_list = random_triangles(f"{kind} {seed}", 60, width=16, height=16)
    triangles = prepared_values(configuration, prepare(configuration, display_list))
    packets, kept, operations = [], [], []
    waiting = []  # of each packet: it has to be taken
    source = random.Random(f"frame starts {seed}")
    for triangle in triangles:
        if source.random() < others:
            operation = source.choice([Operation.FRAME_START, Operation.READ_DEPTH])
            packets.append({"operation": operation})
            waiting.append(True)
            operations.append((operation, len(kept)))
        packets.append({"operation": Operation.DRAW, "body": {"draw": triangle}})
        rows = [y for y in range(triangle["top"], 16 + 2 * (y_mask + 1))
                if (y - y_offset) & y_mask == 0]
        columns = any((x - x_offset) & (x_mask >> skew) == 0
                      for x in range(triangle["left"], triangle["right"]))
        waiting.append(not whole or (columns and rows[0] < triangle["bottom"]))
        if waiting[-1]:
            kept.append((triangle, rows))
    dut = BroadcastQueue(configuration=configuration)
    announcer = Announcer(dut, packets, pause[0])
    triangles_sink = Sink(dut.triangles, len(kept), pause[1])
    planes_sink = Follower(triangles_sink, dut.planes, len(kept), pause[2])
    operations_sink = Sink(dut.operations, len(operations), pause[3])
    before = []  # triangles and planes that had been taken as each operation was

    def lines(ctx, clock):
        ctx.set(dut.lattice, {"x_offset": x_offset, "x_mask": x_mask, "y_offset": y_offset,
                              "y_mask": y_mask, **({"shifted": 1} if skew else {})})
        ctx.set(dut.whole, whole)

    def watch(ctx, clock):
        taken = len(triangles_sink.items), len(planes_sink.items)
        if ctx.get(dut.operations.valid) and ctx.get(dut.operations.ready):
            before.append(taken)
        if ctx.get(dut.empty):
            assert not ctx.get(dut.triangles.valid) and not ctx.get(dut.planes.valid)
            announced = sum(strobe < clock for strobe in announcer.strobes)
            assert sum(waiting[:announced]) == len(planes_sink.items) + len(operations_sink.items)

    # The watch looks before the sinks take.
    simulate(dut, Drive(lines), Watch(watch), announcer, triangles_sink, planes_sink,
             operations_sink, after=4)
    assert [Operation(item) for item in operations_sink.items] == [
        operation for operation, _ in operations]
    assert before == [(count, count) for _, count in operations]
    for item, (triangle, rows) in zip(triangles_sink.items, kept, strict=True):
        assert all(item[name] == triangle[name] for name in ("top", "bottom", "left", "right"))
        assert item.lower.step == triangle["lower"]["step"]
        if whole:
            assert (item.first_row, item.second_row) == tuple(rows[:2])
            assert item.one_row == (rows[1] >= triangle["bottom"])
    for item, (triangle, _) in zip(planes_sink.items, kept, strict=True):
        plane = triangle["planes"]
        # Words are taken modulo their field.
        assert item.depth.step_y == plane["depth"]["step_y"] % (1 << configuration.depth_plane_bits)
        assert item.blue == plane["blue"]
    return dut, announcer, triangles_sink, operations_sink, len(kept), len(triangles)


@pytest.mark.parametrize("kind", LATTICES)
@pytest.mark.parametrize("seed", range(2))
def test_what_misses_the_lattice_is_passed_over(kind, seed):
    *_, kept, sent = run(kind, seed, pause=tuple(
        pauses(f"{part} {seed}") for part in ("in", "out", "planes", "operations")))
    assert kept == sent if kind == "everything" else kept < sent


def test_a_domain_of_several_blocks_keeps_everything():
    *_, kept, sent = run("one of sixteen", 0, whole=0)
    assert kept == sent


@pytest.mark.parametrize("depth", [2, 3, 4])
@pytest.mark.parametrize("seed", range(2))
def test_short_queues_lose_nothing(depth, seed):
    """Words come as soon as there is room, and leave slowly or at once."""
    for leave in (no_pause, pauses(f"leave {seed}")):
        run("everything", seed, pause=(no_pause, leave, leave, leave), depth=depth)


def test_latency_and_throughput():
    dut, announcer, sink, *_ = run("everything", "speed", others=0)
    assert announcer.strobes == list(range(len(announcer.packets)))
    assert dut.latency == 3
    assert sink.clocks == [clock + dut.latency for clock in announcer.strobes]


def test_latency_of_an_operation():
    dut, announcer, _, sink, *_ = run("everything", "operations", others=1,
                                      pause=(lambda: 9, no_pause, no_pause, no_pause))
    assert dut.operation_latency == 2
    assert sink.clocks == [clock + dut.operation_latency for clock in announcer.strobes[::2]]
