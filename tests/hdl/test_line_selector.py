"""The memory lines, given to one part at a time."""

import random

import pytest
from amaranth.hdl import Value
from hdl_bench.bench import evaluate, rejects
from hdl_bench.pictures import small_machine

from cardcage.hdl.line_selector import LineSelector

ANSWERS = ("read_busy", "read_data", "write_busy", "scanned")


@pytest.mark.parametrize("sources", [2, 3, 4])
def test_the_selected_source_has_the_lines(sources):
    dut = LineSelector(configuration=small_machine("PMM"), sources=sources)
    pick = random.Random(f"lines {sources}")

    def scramble(ctx, lines, names):
        words = {}
        for name in names:
            target = Value.cast(getattr(lines, name))
            words[name] = pick.getrandbits(len(target))
            ctx.set(target, words[name])
        return words

    def steps(ctx):
        for _ in range(20):
            requests = [scramble(ctx, source, ("read", "write")) for source in dut.sources]
            answers = scramble(ctx, dut.lines, ANSWERS)
            for chosen in range(sources):
                ctx.set(dut.select, (1 << chosen) & ((1 << sources - 1) - 1))
                assert {name: ctx.get(Value.cast(getattr(dut.lines, name)))
                        for name in ("read", "write")} == requests[chosen]
                for source in dut.sources:
                    assert {name: ctx.get(getattr(source, name)) for name in ANSWERS} == answers

    evaluate(dut, steps)


@pytest.mark.parametrize("sources", [-1, 0, 1])
def test_needs_two_sources(sources):
    rejects(LineSelector, "sources", configuration=small_machine("PMM"), sources=sources)
