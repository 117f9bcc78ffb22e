"""Sixty-four nodes, as small as can be."""

from frames import joined, random_list
from node_frames import all_tied, compiled, frames, immediate

from cardcage.golden.specification.configuration import MachineConfiguration


def test_sixty_four_nodes():
    """More triangles than nodes, so that the order decides in ties; and fewer, so that most of
    them draw nothing."""
    machine = MachineConfiguration(
        cards="64x(PMC)", width=16, height=4, depth_bits=12, fraction_bits=24, shading="flat",
        fifo_depth=2, clocks_per_pixel=2, packet=1, order_bits=2)
    assert machine.nodes == machine.words == 64
    ties = all_tied(140, 1, width=16, height=4)
    few = random_list(5, 5, width=16, height=4, flat=True)
    lists = [ties, joined(few, ties.chosen([0])), few]
    frames(machine, [(immediate(machine, listed), machine, listed) for listed in lists],
           compiled(), memory_seed=1)
