"""The RAMs with two ports against an array, whatever a word reads as in the clock of its write."""

import pytest
from hdl_bench.accesses import Accesses, careless_memory
from hdl_bench.bench import rejects, simulate

from cardcage.hdl.memory_unit import two_port_memory
from cardcage.hdl.memory_unit.two_port_memory import TwoPortMemory


@pytest.mark.parametrize("kind", ["old", "new", "garbage"])
@pytest.mark.parametrize(("words", "depth_bits", "tag_bits", "seed"),
                         [(1, 3, 2, 0), (2, 8, 4, 1), (13, 24, 4, 2), (16, 32, 6, 3)])
def test_random_accesses(monkeypatch, kind, words, depth_bits, tag_bits, seed):
    monkeypatch.setattr(two_port_memory, "memory", careless_memory(kind))
    dut = TwoPortMemory(words=words, depth_bits=depth_bits, tag_bits=tag_bits)
    assert dut.latency == 1
    accesses = Accesses(dut, seed, 800, ports=2)
    simulate(dut, accesses)
    assert accesses.checked > 300
    assert min(accesses.counts.values()) > 50
    assert accesses.met > 20


@pytest.mark.parametrize(("name", "wrong"), [
    ("words", 0), ("words", 1 << 21), ("depth_bits", 49), ("tag_bits", 1)])
def test_bad_sizes(name, wrong):
    rejects(TwoPortMemory, name, **{"words": 4, "depth_bits": 8, "tag_bits": 4} | {name: wrong})
