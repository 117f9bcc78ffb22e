"""The set bits of words, in order."""

import random

import pytest
from hdl_bench.bench import Watch, rejects, simulate
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.hdl.merging.set_bits import SetBits


def numbers(words, word_bits):
    """The model, of (place, bits) each."""
    return [place * word_bits + bit for place, bits in words
            for bit in range(word_bits) if bits >> bit & 1]


def run(words, *, places, word_bits, send=no_pause, take=no_pause):
    dut = SetBits(words=places, word_bits=word_bits)
    expected = numbers(words, word_bits)
    source = Source(dut.words_in, [{"place": place, "bits": bits} for place, bits in words], send)
    sink = Sink(dut.numbers, len(expected), take)

    def holds_something(ctx, clock):
        came = numbers(words[:sum(taken < clock for taken in source.taken)], word_bits)
        gone = sum(given < clock for given in sink.clocks)
        assert not (ctx.get(dut.empty) and len(came) > gone)
        if clock > 3 and source.finished and gone == len(expected) and clock > sink.clocks[-1]:
            assert ctx.get(dut.empty)

    simulate(dut, source, sink, Watch(holds_something), after=4)
    assert sink.items == expected
    return dut, source, sink


@pytest.mark.parametrize("seed", range(2))
def test_every_word_of_four_bits(seed):
    pick = random.Random(f"words {seed}")
    words = [(pick.randrange(5), bits) for bits in range(1, 16)] + [
        (pick.randrange(5), pick.getrandbits(4)) for _ in range(80)]
    run(words, places=5, word_bits=4, send=pauses(f"send {seed}"), take=pauses(f"take {seed}"))


@pytest.mark.parametrize(("places", "word_bits"), [(1, 2), (1, 64), (300, 64), (7, 16)])
def test_random_words(places, word_bits):
    """Dense, sparse and empty."""
    pick = random.Random(f"words {places} {word_bits}")
    words = [(pick.randrange(places), pick.getrandbits(word_bits) & pick.choice(
        (0, pick.getrandbits(word_bits), 1 << pick.randrange(word_bits), -1))) for _ in range(60)]
    words.append((places - 1, 1 << word_bits - 1))
    run(words, places=places, word_bits=word_bits, send=pauses(places), take=pauses(word_bits))


def test_latency_and_throughput():
    """A bit a clock, whatever words they are in; a word of none takes a clock."""
    pick = random.Random("set bits")
    words = [(place, pick.choice((0, 0, 1 << pick.randrange(64), pick.getrandbits(64), -1 % 2**64)))
             for place in range(30)] + [(30, 5)]
    dut, source, sink = run(words, places=31, word_bits=64)
    begins, clock = [], 0
    for _, bits in words:
        begins.append(clock)
        clock += max(1, bits.bit_count())
    # A word is taken as the last group of the one before it goes.
    assert all(taken <= begin for taken, begin in zip(source.taken, begins, strict=True))
    assert sink.clocks == [begin + dut.latency + bit for begin, (_, bits)
                           in zip(begins, words, strict=True) for bit in range(bits.bit_count())]


@pytest.mark.parametrize(("name", "wrong"), [
    ("words", 0), ("word_bits", 1), ("word_bits", 12), ("word_bits", 0)])
def test_bad_sizes(name, wrong):
    rejects(SetBits, name, **{"words": 4, "word_bits": 8} | {name: wrong})
