"""Pixels that pass a merge card while they are scanned, against ``golden.merging``."""

import random
from dataclasses import replace

import numpy as np
import pytest
from hdl_bench.bench import Agent, simulate
from hdl_bench.pictures import small_machine

from cardcage.golden.merging.node_picture import NodePicture, nearer
from cardcage.golden.specification.commands import ResponseKind
from cardcage.golden.specification.picture import NO_PRIMITIVE, Picture
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.nodes.chain_merge import ChainMerge

BACKGROUND = 0x0A0B0C
SYNCS = ("begin", "active", "horizontal_sync", "vertical_sync")


def node_picture(words, configuration):
    """One of golden's, a row of pixels, from (depth, order, colour) or None where nothing was
    drawn."""
    greatest = (1 << configuration.order_bits) - 1
    undrawn = configuration.depth_background, greatest, BACKGROUND
    depth, order, color = zip(*(word or undrawn for word in words), strict=True)
    winner = [NO_PRIMITIVE if word is None else 0 for word in words]
    channels = [[value >> shift & 255 for shift in (0, 8, 16)] for value in color]
    return NodePicture(Picture(np.array([channels], np.uint8), np.array([depth]),
                               np.array([winner])), np.array([order]))


def merged(lower, higher, configuration):
    """(depth, order, colour) of each pixel, as golden merges two nodes."""
    picture = nearer(node_picture(lower, configuration), node_picture(higher, configuration))
    color = picture.picture.color[0].astype(int) @ [1, 1 << 8, 1 << 16]
    return list(zip(picture.picture.depth[0].tolist(), picture.order[0].tolist(), color.tolist(),
                    strict=True))


class Scan(Agent):
    """A pixel in every clock: what comes from the left, and what the card's own node shows.

    ``pixels``: (four syncs, left, own) each, of words as in ``node_picture``.  ``out``: what
    leaves the card in each clock.
    """

    def __init__(self, dut, pixels):
        self.dut, self.pixels = dut, pixels
        self.out, self.lines = [], []
        self.pick = random.Random("addresses")

    @property
    def finished(self):
        return len(self.out) == len(self.pixels) + 1

    def drive(self, ctx):
        clock = min(len(self.out), len(self.pixels) - 1)
        syncs, left, own = self.pixels[clock]
        dut, order_bits = self.dut, self.dut.configuration.order_bits
        depth, order, color = left or (self.dut.configuration.depth_background,
                                       (1 << order_bits) - 1, BACKGROUND)
        if not syncs["active"]:
            color = 0
        ctx.set(dut.scan_left.pixel, {**syncs, "rank": depth << order_bits | order,
                                      "color": color})
        depth, order, color = own or (0, 0, 0)  # wired or: nobody drives
        ctx.set(dut.scan.drawn, own is not None)
        ctx.set(dut.scan.rank, depth << order_bits | order)
        ctx.set(dut.scan.video, color)
        lines = {"fetch": {"valid": self.pick.getrandbits(1), "x": self.pick.randrange(8),
                           "y": self.pick.randrange(8)},
                 "show": {"valid": self.pick.getrandbits(1), "x": self.pick.randrange(8),
                          "y": self.pick.randrange(8)}, "front": self.pick.getrandbits(1)}
        for name, value in lines.items():
            ctx.set(getattr(dut.scan_left, name), value)
        self.lines.append(lines)

    def sample(self, ctx):
        dut = self.dut
        pixel = ctx.get(dut.scan_right.pixel)
        order_bits = dut.configuration.order_bits
        self.out.append(({name: pixel[name] for name in SYNCS},
                         (pixel.rank >> order_bits, pixel.rank & (1 << order_bits) - 1,
                          pixel.color)))
        # The node's units scan what comes from the left, in the same clock; the next node's a
        # clock later.
        for lines, sent in ((dut.scan, self.lines[-1]),
                            (dut.scan_right, self.lines[-2] if len(self.lines) > 1 else None)):
            for name in ("fetch", "show"):
                got = ctx.get(getattr(lines, name))
                assert sent is None or {field: got[field] for field in sent[name]} == sent[name]
        if len(self.lines) > 1:
            assert ctx.get(dut.scan_right.front) == self.lines[-2]["front"]


def machine(order_bits, depth_bits=8):
    return small_machine("3x(PMC)", order_bits=order_bits, depth_bits=depth_bits)


def random_pixels(configuration, seed, count):
    """Few depths and orders, so that nodes tie; some not drawn by one node, or by either."""
    pick = random.Random(f"pixels {seed}")

    def word():
        if pick.random() < 0.25:
            return None
        most = configuration.depth_background - 1
        return (pick.choice((0, 1, most, pick.randrange(most))),
                pick.choice((0, (1 << configuration.order_bits) - 1,
                             pick.getrandbits(8) % (1 << configuration.order_bits))),
                pick.getrandbits(24))

    pixels = []
    for _ in range(count):
        left = word()
        own = word()
        if left and own and pick.random() < 0.5:
            own = left[0], pick.choice((left[1], own[1])), own[2]
        syncs = {name: int(pick.random() < 0.8) for name in SYNCS}
        pixels.append((syncs, left, own))
    return pixels


@pytest.mark.parametrize("order_bits", [0, 1, 4])
@pytest.mark.parametrize("depth_bits", [2, 8])
def test_the_nearer_pixel_a_clock_later(order_bits, depth_bits):
    configuration = machine(order_bits, depth_bits)
    pixels = random_pixels(configuration, f"{order_bits} {depth_bits}", 500)
    dut = ChainMerge(configuration=configuration)
    scan = Scan(dut, pixels)
    simulate(dut, scan)
    _, lefts, owns = zip(*pixels, strict=True)
    both = merged(lefts, owns, configuration)
    alone = merged(lefts, [None] * len(lefts), configuration)
    assert ChainMerge.latency == 1
    seen = dict.fromkeys(("left", "own", "tie", "nobody", "outside"), 0)
    for (syncs, left, own), nearest, passed, (got_syncs, got) in zip(
            pixels, both, alone, scan.out[1:], strict=True):
        assert got_syncs == syncs
        if not syncs["active"]:  # black, and as far away as it came
            seen["outside"] += own is not None
            assert got == (*passed[:2], 0)
            continue
        assert got == nearest
        seen["nobody"] += left is None and own is None
        seen["tie"] += left is not None and own is not None and left[:2] == own[:2]
        seen["own" if own is not None and got == own and own != left else "left"] += 1
    assert min(seen.values()) > 15, seen


@pytest.mark.parametrize("order_bits", [0, 3])
def test_ties(order_bits):
    """The lesser order; of equal ones the lower node.  What no one has drawn changes nothing."""
    configuration = machine(order_bits)
    active = dict.fromkeys(SYNCS, 1)
    greatest = (1 << order_bits) - 1
    background = configuration.depth_background, greatest, BACKGROUND
    left, own = (7, greatest, 1), (7, greatest, 2)
    pairs = [(left, own, left), (None, own, own), (left, None, left), (None, None, background)]
    # The farthest that is drawn is nearer than what is not.
    last = configuration.depth_background - 1, greatest, 3
    pairs += [(None, last, last), (last, None, last)]
    if order_bits:
        pairs += [(left, (7, 0, 2), (7, 0, 2)), ((7, 0, 1), own, (7, 0, 1)),
                  ((7, 0, 1), (6, greatest, 2), (6, greatest, 2))]
    dut = ChainMerge(configuration=configuration)
    scan = Scan(dut, [(active, *pair[:2]) for pair in pairs])
    simulate(dut, scan)
    assert [got for _, got in scan.out[1:]] == [wanted for *_, wanted in pairs]


class Counter(Agent):
    """Scans of so many pixels of the picture each, and what READ_COUNTERS says after each of
    them."""

    def __init__(self, dut, scans):
        self.dut = dut
        self.positive = dut.configuration.timing.vertical_sync_positive
        self.clocks = [signals for active in scans for signals in self.scan(active)]
        self.said, self.clock = [], 0

    def scan(self, active):
        """(begin, active, in sync, asks) of each clock; a pixel takes two."""
        pick = random.Random(f"scan {active}")
        places = [1] * active + [0] * 5
        pick.shuffle(places)
        lines = [(1, 0, 1, 0), (0, 0, 1, 0)] * 3 + [(0, 0, 1, 1)]
        return lines + [signals for on in places for signals in ((1, on, 0, 0), (0, on, 0, 0))]

    @property
    def finished(self):
        return self.clock >= len(self.clocks)

    def drive(self, ctx):
        begin, active, in_sync, asks = self.clocks[min(self.clock, len(self.clocks) - 1)]
        dut = self.dut
        ctx.set(dut.scan_left.pixel.begin, begin)
        ctx.set(dut.scan_left.pixel.active, active)
        ctx.set(dut.scan_left.pixel.vertical_sync, in_sync == self.positive)
        ctx.set(dut.broadcast.strobe, asks and not self.finished)
        ctx.set(dut.broadcast.packet.operation, Operation.READ_COUNTERS)
        ctx.set(dut.left.response.ready, 1)

    def sample(self, ctx):
        response = self.dut.left.response
        if ctx.get(response.valid):
            assert ctx.get(response.payload.kind) == ResponseKind.SENT
            self.said.append(ctx.get(response.payload.value))
        self.clock += 1


@pytest.mark.parametrize("positive", [False, True])
def test_pixels_sent_in_the_last_whole_scan(positive):
    timing = replace(small_machine("3x(PMC)").timing, vertical_sync_positive=positive)
    configuration = small_machine("3x(PMC)", timing=timing)
    dut = ChainMerge(configuration=configuration)
    counter = Counter(dut, [64, 63, 1, 0, 64, 64])
    simulate(dut, counter, after=4)
    assert counter.said == [0, 64, 63, 1, 0, 64]
