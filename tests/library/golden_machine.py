"""A machine that deals out regions, of triangles or of objects that are passed on, as the golden
models say it answers: in an engine's place."""

from __future__ import annotations

import numpy as np

from cardcage.golden.objects.forwarding import forwarded_objects, made_at_elements
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.region_table import packed_table, static_table
from cardcage.golden.reference import exact
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind, opcode_of, unpack
from cardcage.testbenches.engines.engine import EngineRun, Scan
from cardcage.testbenches.frames.conversation import owed_at_boot
from cardcage.testbenches.frames.region_figures import golden_counts
from cardcage.testbenches.frames.region_host import of_slots


class GoldenMachine:
    """Draws ``lists`` one after another, and again from the first one on.

    ``change``  takes and returns the value of each response, of a kind: to be wrong in
    """

    name = "golden"

    def __init__(self, lists, change=lambda kind, number, value: value):
        self.lists, self.change = lists, change

    def run(self, job, progress=None):
        return _Run(self, job).result


class _Run:
    def __init__(self, machine, job):
        self.machine, self.job, c = machine, job, job.configuration
        self.configuration, self.organisation = c, organisation_of(c)
        self.responses, self.scans, self.accepted = [], [], []
        self.table = (self.organisation.table if c.forwards_objects else
                      static_table(c.dealt_regions.count, c.processing_elements))
        self.heard, self.next_table = [], self.table
        self.cycle = 1
        self.picture = np.zeros((c.height, c.width, 3), np.uint8)
        self.frames = 0
        self.numbers = {}
        for kind, value in owed_at_boot(self.organisation):
            self.answer(kind, 70 if value is None else value)
        for word in job.commands:
            self.pass_clocks(1)
            self.accepted.append(self.cycle)
            getattr(self, Opcode(opcode_of(word)).name.lower(), self.nothing)(word)
        assert len(self.responses) == job.responses
        self.pass_clocks(2 * c.cycles_per_scan)
        self.result = EngineRun(self.responses, self.scans, self.cycle, 1.0, engine="golden",
                                accepted=np.array(self.accepted))

    def pass_clocks(self, clocks):
        for _ in range(clocks):
            if self.cycle % self.configuration.cycles_per_scan == 1:
                self.scans.append(Scan(self.cycle, self.picture))
            self.cycle += 1

    def answer(self, kind, value):
        number = self.numbers.get(kind, 0)
        self.numbers[kind] = number + 1
        self.responses.append((kind, int(self.machine.change(kind, number, value)), self.cycle))

    def nothing(self, word):
        pass

    def region(self, word):
        assert self.configuration.balancer == "host"
        fields = unpack(commands.region_layout(self.configuration), word >> commands.BODY_OFFSET)
        columns = self.configuration.dealt_regions.columns
        assert fields["row"] * columns + fields["column"] == len(self.heard)
        self.heard.append(fields["element"])

    def frame_start(self, word):
        if self.heard:
            assert len(self.heard) == self.configuration.dealt_regions.count
            self.table = np.array(self.heard)
        elif self.configuration.balancer == "hardware":
            self.table = self.next_table
        self.heard = []
        self.started = self.cycle

    def frame_end(self, word):
        c = self.configuration
        self.list = self.machine.lists[self.frames % len(self.machine.lists)]
        self.frames += 1
        self.drawn = exact.draw(self.list, shading=c.shading)
        self.counts = golden_counts(c, self.list)
        if c.balance != "static":
            self.next_table = packed_table(self.counts, c.processing_elements, c.slots)
        self.answer(ResponseKind.FRAME_DRAWN, self.cycle - self.started)
        scans = -(-(self.started - 1) // c.cycles_per_scan)
        until = -(-(self.cycle - 1) // c.cycles_per_scan)
        self.pass_clocks(until * c.cycles_per_scan + 1 - self.cycle)
        self.picture = self.organisation.video(self.drawn.color)
        self.answer(ResponseKind.FRAME_SHOWN, until - scans)

    def read_depth(self, word):
        dealt = self.organisation.dealt(self.table)
        x, y = dealt.pixel(*dealt.read_back)
        height, width = self.drawn.depth.shape
        inside = (x < width) & (y < height)
        for place in range(len(x)):
            depth = self.drawn.depth[y[place], x[place]] if inside[place] else 0
            self.answer(ResponseKind.DEPTH, depth)

    def read_counters(self, word):
        complexity = exact.depth_complexity(self.list)
        dealt = self.organisation.dealt(self.table)
        y, x = np.mgrid[:complexity.shape[0], :complexity.shape[1]]
        owner = dealt.owners[0, dealt.unit(x, y)]
        c = self.configuration
        made = made_at_elements(c, self.list) if c.forwards_objects else []
        passed = forwarded_objects(c, self.list) if c.forwards_objects else None
        for element in range(c.processing_elements):
            self.answer(ResponseKind.FRAGMENTS, complexity[owner == element].sum())
            self.answer(ResponseKind.BUSY, 5)
            if passed is not None:
                self.answer(ResponseKind.MADE, made[element].made)
                self.answer(ResponseKind.DROPPED, made[element].dropped)
                self.answer(ResponseKind.FORWARDED, commands.response_value(
                    ResponseKind.FORWARDED, left=int(passed.left[element]),
                    right=int(passed.right[element])))

    def read_regions(self, word):
        for count in of_slots(self.configuration, self.table, self.counts).ravel():
            self.answer(ResponseKind.REGION_COUNT, count)

    def read_table(self, word):
        for element in self.next_table:
            self.answer(ResponseKind.TABLE_ENTRY, element)
