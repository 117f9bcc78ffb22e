"""Memory units as the memory bus of a processing element shows them, in software."""

import random

from .bench import Agent


class MemoryBusModel(Agent):
    """Memory units ``first`` … ``end - 1`` of ``words`` words at the right of ``bus``.

    A unit's one port goes to the scan, else to the write, else to the read.  The
    scan takes each unit's port with probability ``scan``, drawn anew every
    clock.  With two ports nobody waits, and what a read sees of the write of its own
    clock is drawn anew.  With probability ``refused`` the bus is somebody else's to
    write, and to read, and the unit knows nothing of the request.  Contents start out
    random.

    ``depth``, ``back``   dicts (unit, address) → word
    ``reads``, ``writes`` lists of (clock, unit, address)
    """

    def __init__(self, bus, *, first, end, words, depth_bits, seed=0, scan=0.0, ports=1,
                 refused=0.0):
        self._bus = bus
        self._source = random.Random(f"memory {seed}")
        self._scan = scan
        self._units = range(first, end)
        self._words = words
        places = [(unit, address) for unit in self._units for address in range(words)]
        self.depth, self.back = (
            {place: self._source.getrandbits(bits) for place in places}
            for bits in (depth_bits, 24))
        self._background = (1 << depth_bits) - 1
        self._ports = ports
        self._refused = refused
        self.reads, self.writes = [], []
        self._answer = 0
        self._clock = 0

    def start_frame(self):
        """Background everywhere: the greatest depth, and no colour."""
        self.depth = dict.fromkeys(self.depth, self._background)
        self.back = dict.fromkeys(self.back)

    def drive(self, ctx):
        bus, port = self._bus, self._source
        ctx.set(bus.read_data, self._answer)
        scanned = {unit for unit in self._units if port.random() < self._scan}
        if self._ports == 2:
            self._write_busy = self._read_busy = False
            return
        ctx.set(bus.scanned, sum(1 << parity for parity in {unit & 1 for unit in scanned}))
        no_write, no_read = (port.random() < self._refused for _ in range(2))
        # A read may wait for the write, not the other way round.
        write = ctx.get(bus.write)
        self._write_busy = bool(write.valid) and (write.unit in scanned or no_write)
        ctx.set(bus.write_busy, self._write_busy)
        read = ctx.get(bus.read)
        written = {write.unit} & set(self._units) if write.valid and not no_write else set()
        self._read_busy = bool(read.valid) and (read.unit in (scanned | written) or no_read)
        ctx.set(bus.read_busy, self._read_busy)

    def sample(self, ctx):
        read, write = ctx.get(self._bus.read), ctx.get(self._bus.write)
        self._answer = 0
        met = False  # with two ports only
        if write.valid and not self._write_busy:
            place = write.unit, write.address
            met = read.valid and not self._read_busy and place == (read.unit, read.address)
            self.writes.append((self._clock, *place))
            if place[0] in self._units:
                assert place in self.depth, f"clock {self._clock}: writes {place}"
                self.depth[place], self.back[place] = write.depth, write.color
        if read.valid and not self._read_busy:
            place = read.unit, read.address
            self.reads.append((self._clock, *place))
            if place[0] in self._units:
                assert place in self.depth, f"clock {self._clock}: reads {place}"
                self._answer = (self._source.randint(0, self._background) if met
                                else self.depth[place])
        self._clock += 1
