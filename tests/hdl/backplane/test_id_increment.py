"""The ID lines count the memory units they pass."""

from itertools import pairwise

import pytest
from amaranth.hdl import Module
from hdl_bench.bench import evaluate, rejects

from cardcage.hdl.backplane.id_increment import IdIncrement


@pytest.mark.parametrize("bits", [1, 2, 3, 5])
def test_adds_one_modulo_the_lines(bits):
    dut = IdIncrement(bits=bits)

    def steps(ctx):
        for left in range(1 << bits):
            ctx.set(dut.left, left)
            right, wanted = ctx.get(dut.right), (left + 1) % (1 << bits)
            assert right == wanted, (
                f"ID increment of the memory unit board: {left} comes in on {bits} lines and "
                f"{right} leaves, not {wanted}")

    evaluate(dut, steps)


def test_a_chain_numbers_its_units_and_returns_their_total():
    module = Module()
    chain = [IdIncrement(bits=4) for _ in range(11)]
    for index, link in enumerate(chain):
        module.submodules[f"link_{index}"] = link
    for link, following in pairwise(chain):
        module.d.comb += following.left.eq(link.right)

    def steps(ctx):
        numbers = [ctx.get(link.left) for link in chain]
        assert numbers == list(range(11)), f"IDs of eleven memory unit boards in a row: {numbers}"
        total = ctx.get(chain[-1].right)
        assert total == 11, f"total that eleven memory unit boards return: {total}"

    evaluate(module, steps)


@pytest.mark.parametrize("bits", [0, -1])
def test_needs_a_line(bits):
    rejects(IdIncrement, "bits", bits=bits)
