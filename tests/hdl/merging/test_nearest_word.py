"""Which of two words stays, against the definition; every pair at small widths."""

import random
from itertools import product

import pytest
from hdl_bench.bench import evaluate, rejects

from cardcage.hdl.merging.nearest_word import NearestWord

#: Widths at which every pair is tried.
SMALL = [(1, 0), (3, 0), (1, 1), (2, 2), (1, 3), (3, 2)]


def wanted(lower, higher):
    """Whether the higher node's word stays, of (depth, order) each."""
    if lower[0] != higher[0]:
        return higher[0] < lower[0]
    return higher[1] < lower[1]


def answers(depth_bits, order_bits, pairs):
    """What the hardware says of each pair of (depth, order)."""
    dut = NearestWord(depth_bits=depth_bits, order_bits=order_bits)
    found = []

    def steps(ctx):
        for pair in pairs:
            for side, (depth, order) in zip((dut.lower, dut.higher), pair, strict=True):
                ctx.set(side, {"depth": depth, "order": order})
            found.append(bool(ctx.get(dut.higher_stays)))

    evaluate(dut, steps)
    return found


def every_word(depth_bits, order_bits):
    return list(product(range(1 << depth_bits), range(1 << order_bits)))


@pytest.mark.parametrize(("depth_bits", "order_bits"), SMALL)
def test_every_pair_of_small_words(depth_bits, order_bits):
    pairs = list(product(every_word(depth_bits, order_bits), repeat=2))
    assert answers(depth_bits, order_bits, pairs) == [wanted(*pair) for pair in pairs]


@pytest.mark.parametrize(("depth_bits", "order_bits"), [(32, 20), (24, 0), (24, 1)])
def test_random_words_of_full_width(depth_bits, order_bits):
    """Equal ones, neighbours and ends of the ranges among them."""
    pick = random.Random(f"nearest {depth_bits} {order_bits}")

    def number(bits, near):
        most = (1 << bits) - 1
        return pick.choice((0, most, near, min(near + 1, most), near ^ (most + 1 >> 1),
                            pick.randint(0, most)))

    pairs = []
    for _ in range(500):
        lower = tuple(pick.getrandbits(bits) for bits in (depth_bits, order_bits))
        higher = tuple(number(bits, near) for bits, near in
                       zip((depth_bits, order_bits), lower, strict=True))
        pairs.append((lower, higher))
    expected = [wanted(*pair) for pair in pairs]
    assert 100 < sum(expected) < 400
    assert sum(lower == higher for lower, higher in pairs) > 10
    assert answers(depth_bits, order_bits, pairs) == expected


@pytest.mark.parametrize(("depth_bits", "order_bits"), SMALL)
def test_neighbours_may_be_merged_in_any_order(depth_bits, order_bits):
    """Of three nodes the same one's word stays, whichever two are merged first: by the hardware's
    own answers."""
    words = every_word(depth_bits, order_bits)
    pairs = list(product(words, repeat=2))
    higher_stays = dict(zip(pairs, answers(depth_bits, order_bits, pairs), strict=True))

    def merged(lower, higher):
        return higher if higher_stays[lower[0], higher[0]] else lower

    for three in product(words, repeat=3):
        one, two, last = ((word, node) for node, word in enumerate(three))
        stays = merged(merged(one, two), last)
        assert stays == merged(one, merged(two, last))
        assert stays == min((one, two, last))


@pytest.mark.parametrize(("depth_bits", "order_bits"), [*SMALL, (24, 9)])
def test_a_word_that_is_not_drawn_changes_nothing(depth_bits, order_bits):
    depths = range(min((1 << depth_bits) - 1, 1000))  # none is the greatest
    orders = (0, (1 << order_bits) - 1)
    undrawn = (1 << depth_bits) - 1, (1 << order_bits) - 1
    words = list(product(depths, orders))
    assert all(answers(depth_bits, order_bits, [(undrawn, word) for word in words]))
    assert not any(answers(depth_bits, order_bits, [(word, undrawn) for word in words]))


def test_bad_sizes():
    rejects(NearestWord, "depth_bits", depth_bits=0, order_bits=3)
    rejects(NearestWord, "order_bits", depth_bits=3, order_bits=-1)
