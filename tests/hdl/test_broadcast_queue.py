"""What a processing element keeps of a broadcast: what it owns pixels of, in order."""

import random
from dataclasses import replace

import pytest
from hdl_bench.bench import Agent, Drive, simulate
from hdl_bench.pictures import prepare, prepared_values, random_triangles, small_machine
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.broadcast_queue import BroadcastQueue
from cardcage.hdl.layouts import Operation

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


def run(kind, seed, *, whole=1, pause=(no_pause, no_pause, no_pause), depth=16):
    skew = "skewed" in kind
    configuration = replace(small_machine("PM" + 15 * "M", 16, 16), fifo_depth=depth, skew=skew)
    x_offset, x_mask, y_offset, y_mask = LATTICES[kind]
    display_list = random_triangles(f"{kind} {seed}", 60, width=16, height=16)
    triangles = prepared_values(configuration, prepare(configuration, display_list))
    packets, kept = [], []
    source = random.Random(f"frame starts {seed}")
    for triangle in triangles:
        if source.random() < 0.2:
            packets.append({"operation": Operation.FRAME_START})
            kept.append((Operation.FRAME_START, None))
        packets.append({"operation": Operation.DRAW, "body": {"draw": triangle}})
        rows = [y for y in range(triangle["top"], 16) if (y - y_offset) & y_mask == 0]
        columns = any((x - x_offset) & (x_mask >> skew) == 0
                      for x in range(triangle["left"], triangle["right"]))
        if not whole or (columns and rows and rows[0] < triangle["bottom"]):
            kept.append((Operation.DRAW, (triangle, rows[0] if rows else None)))
    dut = BroadcastQueue(configuration=configuration)
    announcer = Announcer(dut, packets, pause[0])
    planes = [triangle["planes"] for operation, (triangle, _) in
              ((operation, body) for operation, body in kept if operation == Operation.DRAW)]
    operations_sink = Sink(dut.operations, len(kept), pause[1])
    planes_sink = Sink(dut.planes, len(planes), pause[2])

    def lines(ctx, clock):
        ctx.set(dut.lattice, {"x_offset": x_offset, "x_mask": x_mask, "y_offset": y_offset,
                              "y_mask": y_mask, **({"shifted": 1} if skew else {})})
        ctx.set(dut.whole, whole)

    simulate(dut, Drive(lines), announcer, operations_sink, planes_sink, after=4)
    for item, (operation, body) in zip(operations_sink.items, kept, strict=True):
        assert item.operation == operation
        if operation == Operation.FRAME_START:
            continue
        triangle, first_row = body
        drawn = item.triangle
        assert all(drawn[name] == triangle[name] for name in ("top", "bottom", "left", "right"))
        assert drawn.lower.step == triangle["lower"]["step"]
        if whole:
            assert drawn.first_row == first_row
    for item, plane in zip(planes_sink.items, planes, strict=True):
        assert item.depth.step_y == plane["depth"]["step_y"] and item.blue == plane["blue"]
    return dut, announcer, operations_sink, kept, packets


@pytest.mark.parametrize("kind", LATTICES)
@pytest.mark.parametrize("seed", range(2))
def test_what_misses_the_lattice_is_passed_over(kind, seed):
    _, _, _, kept, packets = run(kind, seed, pause=tuple(pauses(f"{part} {seed}")
                                                         for part in ("in", "out", "planes")))
    assert len(kept) == len(packets) if kind == "everything" else len(kept) < len(packets)


def test_a_domain_of_several_blocks_keeps_everything():
    _, _, _, kept, packets = run("one of sixteen", 0, whole=0)
    assert len(kept) == len(packets)


@pytest.mark.parametrize("depth", [2, 3, 4])
@pytest.mark.parametrize("seed", range(2))
def test_short_queues_lose_nothing(depth, seed):
    """Words come as soon as there is room, and leave slowly or at once."""
    for leave in (no_pause, pauses(f"leave {seed}")):
        run("everything", seed, pause=(no_pause, leave, leave), depth=depth)


def test_latency_and_throughput():
    dut, announcer, sink, _, packets = run("everything", "speed")
    assert announcer.strobes == list(range(len(packets)))
    assert dut.latency == 3
    assert sink.clocks == [clock + dut.latency for clock in announcer.strobes]
