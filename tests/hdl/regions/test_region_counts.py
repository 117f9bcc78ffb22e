"""Counts of random visits, against sums."""

import random

import pytest
from hdl_bench.bench import Agent, Service, simulate
from hdl_bench.regions import region_machine
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.regions.region_counts import RegionCounts


class Rows(Agent):
    """Rows of random visits, often of the slot before; ``counts`` by either balance, of the last
    frame, before which everything is cleared."""

    def __init__(self, dut, seed, visits, pause):
        configuration = dut.configuration
        pick = random.Random(f"visits {seed}")
        self.counts = {kind: [0] * configuration.slots for kind in ("triangles", "clocks")}
        self.dut, self.pause, self.wait, self.clock = dut, pause, 0, 0
        self.rows = []
        slot = 0
        for visit in range(visits):
            if visit == visits // 2:
                self.counts = {kind: [0] * configuration.slots for kind in self.counts}
                self.rows.append(None)
            # The last slot, of those that count in the end, has nothing.
            slots = configuration.slots - (visit >= visits // 2 and configuration.slots > 1)
            slot = pick.choice((slot % slots, pick.randrange(slots)))
            height = pick.choice((1, 1, 2, 1 << configuration.dealt_regions.y_bits))
            wide = pick.choice((1, 1 << configuration.dealt_regions.x_bits))
            pixels = [pick.randrange(wide + 1) for _ in range(height)]
            self.rows += [{"valid": 1, "pixels": each, "slot": slot, "ends": row == height - 1}
                          for row, each in enumerate(pixels)]
            self.counts["triangles"][slot] += 1
            self.counts["clocks"][slot] += max(height, sum(pixels))
        self.left = list(self.rows)
        self.settle = RegionCounts.latency

    @property
    def finished(self):
        return not self.left and self.settle == 0

    def drive(self, ctx):
        idle = {"valid": 0, "pixels": 1, "slot": 0, "ends": 1}
        ctx.set(self.dut.clear, 0)
        if self.wait or not self.left:
            self.wait = max(0, self.wait - 1)
            self.settle -= not self.left and self.settle > 0
            ctx.set(self.dut.row, idle)
        elif self.left[0] is None:
            # A frame starts when all that was drawn before is counted.
            ctx.set(self.dut.row, idle)
            if self.settle:
                self.settle -= 1
            else:
                ctx.set(self.dut.clear, 1)
                self.left.pop(0)
                self.settle = RegionCounts.latency
        else:
            ctx.set(self.dut.row, self.left.pop(0))
            self.wait = self.pause()


class Report(Service):
    """Starts when all rows have been counted."""

    def __init__(self, rows, dut, rounds, pause):
        self._rows = rows
        super().__init__(dut, rounds, pause)

    def drive(self, ctx):
        if self._rows.finished:
            super().drive(ctx)
        else:
            ctx.set(self._dut.start, 0)


def run(balance, seed, *, machine="squares", slots=0, visits=300, pause=(no_pause,) * 3):
    configuration = region_machine(machine, balance=balance, slots=slots)
    dut = RegionCounts(configuration=configuration)
    rows = Rows(dut, seed, visits, pause[0])
    report = Report(rows, dut, 2, pause[1])
    sink = Sink(dut.counts, 2 * configuration.slots, pause[2], zero=True)
    simulate(dut, rows, report, sink, after=4)
    assert sink.items == 2 * rows.counts[balance]
    return configuration, report, sink


@pytest.mark.parametrize("balance", ["triangles", "clocks"])
@pytest.mark.parametrize(("machine", "slots"), [("squares", 0), ("squares", 64), ("wide", 25),
                                                ("few", 2), ("few", 3), ("one each", 1)])
def test_each_slot_has_its_sum(balance, machine, slots):
    run(balance, f"{machine} {slots}", machine=machine, slots=slots,
        pause=[pauses(f"{end} {slots}") for end in range(3)])


@pytest.mark.parametrize("balance", ["triangles", "clocks"])
def test_a_row_a_clock_and_a_report_every_other_clock(balance):
    configuration, report, sink = run(balance, "speed")
    slots = configuration.slots
    begins = report.started[0]
    assert sink.clocks[:slots] == [begins + 3 + 2 * slot for slot in range(slots)]
    assert report.clocks == [2 * slots + 1] * 2
