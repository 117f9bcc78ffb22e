"""Fragments of many elements that meet in memory, in any order."""

import random
from dataclasses import replace

import numpy as np
import pytest
from counted_lists import list_of

from cardcage.golden.merging.cage import merge_cage
from cardcage.golden.merging.direct import direct_traffic
from cardcage.golden.merging.ties import nodes_tie, order_matters
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.reference import exact
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.configuration import MachineConfiguration

CAGES = ("PDM", "PPDMM", "3xP D 4xM", "8xP D 2xM", "5xP D 8xM")


def listed_at(seed, depths):
    """Level triangles at so many depths; the fewer, the more tie."""
    source = np.random.default_rng(seed)
    listed = make_display_list(f"random:n={int(source.integers(1, 50))},size=12,seed={seed}",
                               width=23, height=17).display_list
    listed.depth[:] = source.integers(0, depths, (listed.triangles, 1))
    return listed


def arrivals(elements, pick):
    """The fragments of all elements, those of each in its order, else in any."""
    turns = np.concatenate([np.full(len(own), number) for number, own in enumerate(elements)])
    order = np.random.default_rng(pick.randrange(1 << 30)).permutation(turns)
    rests = [iter(own) for own in elements]
    return [next(rests[number]) for number in order.tolist()]


def stored(configuration, listed, pick):
    """Memory after fragments came in some order: pixel → (rank, primitive), one after another."""
    organisation = organisation_of(configuration)
    shares = organisation.shares(listed)
    drawn = exact.fragments(listed, **organisation.resolution.shifts)
    node = shares.node[drawn.primitive]
    elements = [[] for _ in range(configuration.nodes)]
    for place, primitive in enumerate(drawn.primitive.tolist()):
        order = (int(shares.round[primitive]) << configuration.node_order_bits) + int(node[place])
        rank = ((int(drawn.depth[place]) << configuration.order_bits)
                + (order & ((1 << configuration.order_bits) - 1)))
        elements[node[place]].append(
            ((int(drawn.x[place]), int(drawn.y[place])), rank, primitive))
    memory = {}
    for pixel, rank, primitive in arrivals(elements, pick):
        if pixel not in memory or rank < memory[pixel][0]:
            memory[pixel] = rank, primitive
    return memory


@pytest.mark.parametrize("cards", CAGES)
@pytest.mark.parametrize("seed", range(6))
def test_whoever_comes_first_the_picture_is_the_exact_one(cards, seed):
    print("seed", seed)
    pick = random.Random(f"{cards} {seed}")
    listed = listed_at(seed, pick.choice((1, 4, 300, 1 << 24)))
    for packet in (1, pick.randint(2, 9), "contiguous"):
        machine = plan(listed, cards=cards, packet=packet).configuration
        whole = exact.draw(listed).winner
        picture, _ = merge_cage(machine, listed)
        np.testing.assert_array_equal(picture.picture.winner, whole)
        for wider in (machine, replace(machine, order_bits=16)):
            memory = stored(wider, listed, pick)
            merged, _ = merge_cage(wider, listed)
            assert len(memory) == (whole >= 0).sum()
            for (x, y), (rank, primitive) in memory.items():
                assert primitive == whole[y, x]
                # The order that golden says is kept, too.
                assert rank == ((int(merged.picture.depth[y, x]) << wider.order_bits)
                                + int(merged.order[y, x]))
            assert (merged.order[whole < 0] == (1 << wider.order_bits) - 1).all()


def test_without_an_order_it_matters_who_comes_first():
    listed, pick = listed_at(2, 1), random.Random(1)
    whole = exact.draw(listed).winner
    for packet in (1, "contiguous"):
        machine = plan(listed, cards="3xP D 4xM", packet=packet).configuration
        assert machine.order_bits >= machine.node_order_bits == 2
        without = replace(machine, order_bits=0)
        wrong = [primitive != whole[y, x]
                 for (x, y), (_, primitive) in stored(without, listed, pick).items()]
        assert any(wrong)


@pytest.mark.parametrize("seed", range(20))
def test_nodes_tie_where_two_have_the_nearest_depth(seed):
    print("seed", seed)
    pick = random.Random(seed)
    listed = listed_at(100 + seed, pick.choice((1, 40, 4000)))
    shares = Shares(pick.choice((1, 2, 5)), listed.triangles, pick.choice((1, 3, "contiguous")))
    drawn = exact.fragments(listed)
    nearest: dict = {}
    for place in range(len(drawn)):
        pixel = int(drawn.x[place]), int(drawn.y[place])
        found = int(drawn.depth[place]), {int(shares.node[drawn.primitive[place]])}
        if pixel not in nearest or found[0] < nearest[pixel][0]:
            nearest[pixel] = found
        elif found[0] == nearest[pixel][0]:
            nearest[pixel][1].update(found[1])
    ties = any(len(nodes) > 1 for _, nodes in nearest.values())
    assert nodes_tie(listed, shares) == ties
    assert ties or not order_matters(listed, shares)


@pytest.mark.parametrize("cards", CAGES)
@pytest.mark.parametrize("words", [0, 140])
def test_each_unit_takes_the_fragments_of_its_pixels(cards, words):
    listed = make_display_list("random:n=90,size=12,seed=4", width=23, height=17).display_list
    for packet in (1, 7, "contiguous"):
        machine = MachineConfiguration(cards, 23, 17, words=words, packet=packet, order_bits=9)
        organisation = organisation_of(machine)
        drawn = exact.fragments(listed, **organisation.resolution.shifts)
        taken = np.zeros((machine.nodes, machine.units), int)
        step = machine.interlace.diagonal_step
        for primitive, x, y in zip(drawn.primitive, drawn.x, drawn.y, strict=True):
            node = organisation.shares(list_of(90)).node[primitive]
            taken[node, (int(x) + step * int(y)) % machine.units] += 1
        traffic = direct_traffic(organisation, listed)
        np.testing.assert_array_equal(traffic.taken, taken)
        assert traffic.sent == taken.sum(axis=1).tolist() and traffic.pixels == len(drawn)
        assert traffic.busiest_piece == max(*traffic.sent, *taken.sum(axis=0).tolist())
        merged, whole = merge_cage(machine, listed)
        assert whole.pixel_bits == 24 + 9 + 24 + machine.id_bits + machine.address_bits
        assert whole.bits == len(drawn) * whole.pixel_bits
        np.testing.assert_array_equal(
            merged.picture.winner, exact.draw(listed, **organisation.resolution.shifts).winner)
