"""Memory units as the lines of a processing element show them, in software."""

import random

from cardcage.hdl.backplane import Lane

from .bench import Agent


class MemoryLines(Agent):
    """One-port memory units ``first`` … ``end - 1`` of ``words`` words at the right of ``lines``.

    A unit's port goes to the scan, else to the write, else to the read.  The
    scan takes each unit's port with probability ``scan``, drawn anew every
    clock.  Contents start out random.

    ``depth``, ``back``, ``front``  dicts (unit, address) → word
    ``reads``, ``writes``           lists of (clock, unit, address[, lanes])
    """

    def __init__(self, lines, *, first, end, words, depth_bits, seed=0, scan=0.0):
        self._lines = lines
        self._source = random.Random(f"memory {seed}")
        self._scan = scan
        self._units = range(first, end)
        self._words = words
        places = [(unit, address) for unit in self._units for address in range(words)]
        self.depth, self.back, self.front = (
            {place: self._source.getrandbits(bits) for place in places}
            for bits in (depth_bits, 24, 24))
        self.reads, self.writes = [], []
        self._answer = 0
        self._clock = 0

    def drive(self, ctx):
        lines, port = self._lines, self._source
        ctx.set(lines.read_data, self._answer)
        self._scanned = {unit for unit in self._units if port.random() < self._scan}
        # A read may wait for the write, not the other way round.
        write = ctx.get(lines.write)
        self._written = set()
        if write.valid:
            self._written = {unit for unit in self._units if write.every or unit == write.unit}
        self._write_busy = bool(self._written & self._scanned)
        ctx.set(lines.write_busy, self._write_busy)
        read = ctx.get(lines.read)
        self._read_busy = bool(read.valid) and read.unit in (self._scanned | self._written)
        ctx.set(lines.read_busy, self._read_busy)

    def sample(self, ctx):
        read, write = ctx.get(self._lines.read), ctx.get(self._lines.write)
        self._answer = 0
        if read.valid and not self._read_busy:
            place = read.unit, read.address
            self.reads.append((self._clock, *place))
            if place[0] in self._units:
                assert place in self.depth, f"clock {self._clock}: reads {place}"
                self._answer = self.depth[place]
        if write.valid:
            # Where one unit of several is scanned the one busy line holds the request, and the
            # others write it, too, and then again.
            for unit in self._written - self._scanned:
                place = unit, write.address
                assert place in self.depth, f"clock {self._clock}: writes {place}"
                if write.lanes & Lane.DEPTH:
                    self.depth[place] = write.depth
                if write.lanes & Lane.BACK:
                    self.back[place] = write.color
                if write.lanes & Lane.FRONT:
                    self.front[place] = write.color
            if not self._write_busy:
                self.writes.append((self._clock, write.unit, write.address, write.lanes))
        self._clock += 1
