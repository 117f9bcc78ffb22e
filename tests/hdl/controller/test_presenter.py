"""Pictures one after the other, against merging, scans and a host that take their time."""

import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.golden.specification.commands import ResponseKind
from cardcage.hdl.controller.presenter import Presenter

PERIOD = 17


class Merging(Agent):
    """Starts picture after picture, has each merged and shown after a pause, and scans meanwhile.

    ``pictures``: of each (clock of start, of merged, of swap, of shown, scans until its swap).
    """

    def __init__(self, dut, count, pause):
        self.dut, self.count, self.pause = dut, count, pause
        self.clock = self.scans = 0
        self.pictures = []
        self.going = None
        self.wait = pause()

    @property
    def finished(self):
        return len(self.pictures) == self.count and self.going is None

    def drive(self, ctx):
        dut = self.dut
        idle = self.going is None
        begin = idle and len(self.pictures) < self.count and self.wait == 0
        if begin:
            self.going = {"start": self.clock, "merged": self.clock + self.pause()}
        elif idle and self.wait:
            self.wait -= 1
        merged = self.going is not None and self.clock >= self.going["merged"]
        self.scan = self.clock % PERIOD == PERIOD - 1
        ctx.set(dut.start, begin)
        ctx.set(dut.merged, merged)
        ctx.set(dut.cycles, 1000 + len(self.pictures))
        ctx.set(dut.scan_start, self.scan)
        ctx.set(dut.scans, self.scans)
        ctx.set(dut.shown, self.going is not None and self.clock >= self.going.get("shown", 1e9))

    def sample(self, ctx):
        dut = self.dut
        if self.going is not None and self.clock > self.going["start"]:
            if ctx.get(dut.idle):  # since its last response was taken
                self.pictures.append(self.going)
                self.going, self.wait = None, self.pause()
        else:
            assert ctx.get(dut.idle)
        if ctx.get(dut.swap):
            assert self.scan and "swap" not in self.going
            self.going |= {"swap": self.clock, "shown": self.clock + 1 + self.pause(),
                           "scans": self.scans}
        self.scans += self.scan
        self.clock += 1


def run(count, pause, host):
    dut = Presenter()
    merging, sink = Merging(dut, count, pause), Sink(dut.responses, 2 * count, host)
    simulate(dut, merging, sink)
    kinds = [ResponseKind(item.kind) for item in sink.items]
    assert kinds == [ResponseKind.MERGED, ResponseKind.FRAME_SHOWN] * count
    return merging.pictures, sink


@pytest.mark.parametrize("seed", range(4))
def test_pictures(seed):
    """Each is said to be merged when it is, and shown from the first scan after that on."""
    pictures, sink = run(12, pauses(f"merging {seed}"), pauses(f"host {seed}"))
    for number, picture in enumerate(pictures):
        merged, shown = sink.items[2 * number:2 * number + 2]
        taken, last = sink.clocks[2 * number:2 * number + 2]
        assert merged.value == 1000 + number
        assert shown.value == picture["scans"]
        assert taken > picture["merged"]
        first = taken + 1 + (PERIOD - 1 - (taken + 1)) % PERIOD
        assert picture["swap"] == first
        assert last >= picture["shown"]


def test_latency():
    pictures, sink = run(3, no_pause, no_pause)
    for number, picture in enumerate(pictures):
        merged, shown = sink.clocks[2 * number:2 * number + 2]
        assert merged == picture["start"] + 1
        assert shown == picture["shown"] == picture["swap"] + 1
    later, sink = run(1, iter([0, 5, 3, 0]).__next__, no_pause)
    assert sink.clocks == [later[0]["merged"] + 1, later[0]["swap"] + 4]
