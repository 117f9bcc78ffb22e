"""The memory bus, given to one part at a time."""

import random

from amaranth.hdl import Value
from hdl_bench.bench import evaluate

from cardcage.hdl.processing_element.memory_bus_selector import MemoryBusSelector

ANSWERS = ("read_busy", "read_data", "write_busy", "scanned")
SOURCES = ("depth_test", "survey", "read_back")


def test_the_one_whose_turn_it_is_has_the_bus():
    dut = MemoryBusSelector(id_bits=2, address_bits=6, depth_bits=8)
    pick = random.Random("bus")

    def scramble(ctx, target):
        word = pick.getrandbits(len(Value.cast(target)))
        ctx.set(Value.cast(target), word)
        return target.shape().from_bits(word) if hasattr(target, "shape") else word

    def steps(ctx):
        for _ in range(40):
            reads, writes = ({name: scramble(ctx, getattr(getattr(dut, name), which))
                              for name in SOURCES} for which in ("read", "write"))
            answers = {name: pick.getrandbits(len(getattr(dut.lines, name))) for name in ANSWERS}
            for name, word in answers.items():
                ctx.set(getattr(dut.lines, name), word)
            for turn in SOURCES:
                ctx.set(dut.surveying, turn == "survey")
                ctx.set(dut.reading, turn == "read_back")
                assert ctx.get(dut.lines.read).as_bits() == reads[turn].as_bits()
                write, idle = ctx.get(dut.lines.write), writes["depth_test"]
                if turn == "survey":
                    own = writes["survey"]
                    assert (write.valid, write.unit, write.depth) == (own.valid, own.unit,
                                                                      own.depth)
                    # What it does not say.
                    assert (write.address, write.color) == (idle.address, idle.color)
                else:  # the read-back does not write, and the depth test does not meanwhile
                    assert write.as_bits() == idle.as_bits()
                for source in SOURCES:
                    bus = getattr(dut, source)
                    assert {name: ctx.get(getattr(bus, name)) for name in ANSWERS} == answers

    evaluate(dut, steps)
