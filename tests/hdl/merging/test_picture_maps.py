"""The maps of two pictures against two sets: one is drawn into while the other is deleted from and
listed."""

import random

import pytest
from hdl_bench.bench import Agent, rejects, simulate
from hdl_bench.streams import Sink, no_pause, pauses

from cardcage.hdl.merging.picture_maps import PictureMaps


class Pictures(Agent):
    """Draws into the back picture all the time; deletes from the front one what ``deleted`` says
    and lists it, then the pictures change places.

    ``listings``: of each (clock of its start, of its end, how many addresses).
    """

    def __init__(self, dut, sink, count, *, seed, drawn=0.5, most=60):
        self.dut, self.sink, self.count, self.drawn, self.most = dut, sink, count, drawn, most
        self.pick = random.Random(f"pictures {seed}")
        self.clock = self.given = 0
        self.front = 0
        self.words = [set(), set()]
        self.left = 0  # deletions before the listing
        self.started = None
        self.listings = []
        self.begun = False

    @property
    def finished(self):
        return len(self.listings) == self.count

    def drive(self, ctx):
        dut, pick = self.dut, self.pick
        if self.clock == 0:
            for storage in dut.storages:
                for place in range(storage.depth):
                    ctx.set(storage.data[place], pick.getrandbits(dut.word_bits))
        if self.started is not None and self.clock > self.started and not ctx.get(dut.listing):
            self.ended()
        ctx.set(dut.front, self.front)
        self.begun = self.begun or (ctx.get(dut.ready) and ctx.get(dut.settled))
        listing = self.started is not None
        self.change = self.hidden = None
        if self.begun and pick.random() < self.drawn:
            self.change = pick.randrange(dut.words), pick.random() < 0.9
        start = False
        if self.begun and not listing and not self.finished:
            if self.left:
                self.left -= 1
                if self.words[self.front] and pick.random() < 0.7:
                    self.hidden = pick.choice(sorted(self.words[self.front]))
                else:
                    self.hidden = pick.randrange(dut.words)
            else:
                start = ctx.get(dut.settled)
        address, drawn = self.change or (pick.randrange(dut.words), pick.getrandbits(1))
        ctx.set(dut.change, self.change is not None)
        ctx.set(dut.address, address)
        ctx.set(dut.drawn, drawn)
        ctx.set(dut.hidden, self.hidden is not None)
        ctx.set(dut.hidden_address,
                pick.randrange(dut.words) if self.hidden is None else self.hidden)
        ctx.set(dut.start, start)
        if start:
            self.started = self.clock

    def sample(self, ctx):
        if self.begun:  # the back one takes changes whatever happens to the front one
            assert ctx.get(self.dut.ready)
        if self.change is not None:
            address, drawn = self.change
            back = self.words[1 - self.front]
            (back.add if drawn else back.discard)(address)
        if self.hidden is not None:
            self.words[self.front].discard(self.hidden)
        self.clock += 1

    def ended(self):
        listed = self.sink.items[self.given:]
        assert listed == sorted(self.words[self.front])
        self.given = len(self.sink.items)
        self.listings.append((self.started, self.clock, len(listed)))
        self.words[self.front].clear()
        self.started = None
        self.front ^= 1
        self.left = self.pick.choice((0, 1, self.most))


def run(words, word_bits, count, *, pause=no_pause, **settings):
    dut = PictureMaps(words=words, word_bits=word_bits)
    sink = Sink(dut.addresses, 0, pause)
    pictures = Pictures(dut, sink, count, **settings)
    simulate(dut, pictures, sink, after=5, limit=60_000)
    return dut, pictures


@pytest.mark.parametrize(("words", "word_bits"), [(1, 2), (37, 2), (65, 4), (130, 64), (333, 8)])
@pytest.mark.parametrize("stall", [False, True])
def test_random_pictures(words, word_bits, stall):
    pause = pauses(f"takes {words}") if stall else no_pause
    _, pictures = run(words, word_bits, 14, pause=pause, seed=f"{words} {stall}")
    assert sum(count for *_, count in pictures.listings) > 2


def test_a_listing_takes_no_longer_for_what_is_drawn_meanwhile():
    for drawn in (0.0, 1.0):
        dut, pictures = run(300, 8, 8, seed=3, drawn=drawn)
        for start, end, count in pictures.listings:
            assert end - start <= count + -(-dut.words // 64) + dut.overhead


def test_bad_sizes():
    rejects(PictureMaps, "words", words=0)
