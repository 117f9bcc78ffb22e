"""The four users of a memory unit's RAM at random, and RAMs that read what they like."""

import random
from types import SimpleNamespace

from amaranth.hdl import Module, Signal, Value
from amaranth.lib import memory

from .bench import Agent


class Accesses(Agent):
    """Random requests in every clock, and what must come of them one clock later.

    ``ports``: 1, and each clock is one user's; 2, and only the sweep waits.  What is read of the
    part that is written in that clock may be anything.
    ``counts`` of what took place; ``met``: reads of the word written in that clock.
    """

    def __init__(self, dut, seed, clocks, *, ports):
        self.dut, self.access = dut, dut.access
        self.pick = random.Random(f"accesses {seed}")
        self.clocks, self.ports = clocks, ports
        # (tag, value) of each part; None is unknown.
        self.words = [[(None, None)] * 3 for _ in range(dut.words)]
        self.expected = {}
        self.checked = self.met = self.clock = 0
        self.counts = dict.fromkeys(("scan", "write", "read", "sweep", "erase"), 0)

    @property
    def finished(self):
        return self.clock >= self.clocks

    def drive(self, ctx):
        pick, words = self.pick, self.dut.words
        near = pick.randrange(words)  # so that users often meet at one word
        sweeping = pick.randrange(3)
        self.asked = {
            "scan": pick.random() < 0.3, "write": pick.random() < 0.4,
            "read": pick.random() < 0.4, "sweep": sweeping == 1,
            "erase": pick.randrange(1, 8) if sweeping == 2 else 0, "back": pick.getrandbits(1),
            **{f"{user}_address": pick.choice((near, pick.randrange(words)))
               for user in ("scan", "write", "read", "sweep")},
            **{name: {"tag": pick.randrange(1, 1 << self.dut.tag_bits),
                      "value": pick.getrandbits(bits)}
               for name, bits in (("depth_in", self.dut.depth_bits), ("color_in", 24))},
        }
        for name, value in self.asked.items():
            ctx.set(getattr(self.access, name), value)

    def sample(self, ctx):
        access, asked = self.access, self.asked
        answers = (access.depth, *access.color)
        for part, word in self.expected.items():
            got = ctx.get(answers[part])
            for name, value in zip(("tag", "value"), word, strict=True):
                if value is not None:
                    assert getattr(got, name) == value, f"clock {self.clock}: part {part} {name}"
                    self.checked += 1

        one = self.ports == 1
        scan, write, read = (bool(asked[user]) for user in ("scan", "write", "read"))
        assert ctx.get(access.sweep_busy) == (scan or write or read)
        if one:
            assert ctx.get(access.write_busy) == scan
            assert ctx.get(access.read_busy) == (scan or write)
            write, read = write and not scan, read and not (scan or write)
        else:
            assert not ctx.get(access.write_busy) and not ctx.get(access.read_busy)
        idle = not (asked["scan"] or asked["write"] or asked["read"])

        before = [list(word) for word in self.words]
        back = 1 + asked["back"]
        if write:
            word = self.words[asked["write_address"]]
            word[0] = asked["depth_in"]["tag"], asked["depth_in"]["value"]
            word[back] = asked["color_in"]["tag"], asked["color_in"]["value"]
        if idle and asked["erase"]:
            word = self.words[asked["sweep_address"]]
            for part in range(3):
                if asked["erase"] >> part & 1:
                    word[part] = 0, None
        self.expected = {}
        if read:
            met = write and asked["read_address"] == asked["write_address"]
            self.met += met
            if not met:
                self.expected[0] = before[asked["read_address"]][0]
        if scan:
            for part in (1, 2):
                met = write and part == back and asked["scan_address"] == asked["write_address"]
                if not met:
                    self.expected[part] = before[asked["scan_address"]][part]
        if idle and asked["sweep"]:
            self.expected = dict(enumerate(before[asked["sweep_address"]]))
        for user, done in (("scan", scan), ("write", write), ("read", read),
                           ("sweep", idle and asked["sweep"]), ("erase", idle and asked["erase"])):
            self.counts[user] += bool(done)
        self.clock += 1


def careless_memory(kind):
    """In place of ``amaranth.lib.memory``: block RAMs that read, in the clock in which a word is
    written, the ``"old"`` word, the ``"new"`` one, or ``"garbage"``, which is neither."""

    class CarelessMemory(memory.Memory):
        def read_port(self, **arguments):
            self._port = super().read_port(**arguments)
            self._read = Signal.like(Value.cast(self._port.data))
            data = self.shape(self._read) if hasattr(self.shape, "members") else self._read
            return SimpleNamespace(addr=self._port.addr, en=self._port.en, data=data)

        def elaborate(self, platform):
            m = Module()
            m.submodules.real = super().elaborate(platform)
            write, read = self.write_ports[0], self._port
            met = Signal()
            new = Signal.like(self._read)
            real = Value.cast(read.data)
            m.d.sync += [met.eq(read.en & write.en & (read.addr == write.addr)),
                         new.eq(Value.cast(write.data))]
            m.d.comb += self._read.eq(real)
            with m.If(met):
                m.d.comb += self._read.eq({"old": real, "new": new, "garbage": ~(real ^ new)}[kind])
            return m

    return SimpleNamespace(Memory=CarelessMemory)
