"""The RAM with one port against an array."""

import pytest
from hdl_bench.accesses import Accesses
from hdl_bench.bench import rejects, simulate

from cardcage.hdl.memory_unit.one_port_memory import OnePortMemory


@pytest.mark.parametrize(("words", "depth_bits", "tag_bits", "seed"),
                         [(1, 3, 2, 0), (2, 8, 4, 1), (13, 24, 4, 2), (16, 32, 6, 3)])
def test_random_accesses(words, depth_bits, tag_bits, seed):
    dut = OnePortMemory(words=words, depth_bits=depth_bits, tag_bits=tag_bits)
    assert dut.latency == 1
    accesses = Accesses(dut, seed, 800, ports=1)
    simulate(dut, accesses)
    assert accesses.checked > 300
    assert min(accesses.counts.values()) > 50


@pytest.mark.parametrize(("name", "wrong"), [
    ("words", 0), ("words", -1), ("words", 1 << 21), ("depth_bits", 0), ("depth_bits", 49),
    ("tag_bits", 1), ("tag_bits", 7)])
def test_bad_sizes(name, wrong):
    rejects(OnePortMemory, name, **{"words": 4, "depth_bits": 8, "tag_bits": 4} | {name: wrong})
