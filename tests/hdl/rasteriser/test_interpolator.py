"""Depth and colour at pixels, against integers modulo a power of two and
``golden.specification.fixed_point``."""

import random

import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.specification import fixed_point
from cardcage.golden.specification.commands import CHANNELS
from cardcage.hdl.rasteriser.interpolator import Interpolator

#: The number of the processing element, where it is a node by itself.
NODE = 2


def stored(configuration, carried, bits, limit):
    """What is stored of a carried word, and on which side it was saturated."""
    if configuration.stays_in_range:
        return fixed_point.floor_shift(carried, configuration.fraction_bits), 0
    whole = fixed_point.floor_shift(fixed_point.to_signed(carried, bits),
                                    configuration.fraction_bits)
    return fixed_point.saturate(whole, 0, limit), (whole > limit) - (whole < 0)


class Triangle:
    """Planes of which all but the value at the pixel is random; sums wrap at will."""

    def __init__(self, configuration, source):
        self.configuration = configuration
        self.widths = {"depth": (configuration.depth_plane_bits, configuration.depth_bits)}
        if configuration.shading == "gouraud":
            self.widths |= dict.fromkeys(CHANNELS, (configuration.channel_plane_bits, 8))
        self.planes = {name: source.getrandbits(8) for name in CHANNELS}
        if configuration.round_bits:
            self.planes["round"] = source.getrandbits(configuration.round_bits)
        at = source.randrange(configuration.width), source.randrange(configuration.height)
        for name, (bits, value_bits) in self.widths.items():
            edges = ((1 << bits) - 1, 1 << bits - 1, 0)
            step_x, step_y = (source.choice((source.getrandbits(bits), *edges)) for _ in "xy")
            # Around both ends of the range, at one pixel.
            around = source.choice((0, (1 << value_bits) - 1, 1 << value_bits - 1))
            unit = 1 << configuration.fraction_bits
            value = around * unit + source.randrange(-3, 4) * unit // 2
            start = (value - at[0] * step_x - at[1] * step_y) % (1 << bits)
            self.planes[name] = {"start": start, "step_x": step_x, "step_y": step_y}
        self.at = at

    def fragment(self, pixel):
        """(unit, address, rank, color), and the sides on which it was saturated."""
        limits = {"depth": (1 << self.configuration.depth_bits) - 2}
        words, sides = {}, []
        for name in ("depth", *CHANNELS):
            plane = self.planes[name]
            if isinstance(plane, int):
                words[name] = plane
                continue
            bits, value_bits = self.widths[name]
            carried = (plane["start"] + pixel["x_steps"] * plane["step_x"]
                       + pixel["y_steps"] * plane["step_y"]) % (1 << bits)
            words[name], side = stored(self.configuration, carried, bits,
                                       limits.get(name, (1 << value_bits) - 1))
            sides.append(side)
        interlace = self.configuration.interlace
        x, y = pixel["x"], pixel["y"]
        color = sum(words[name] << 8 * place for place, name in enumerate(CHANNELS))
        order = self.planes.get("round", 0)
        if self.configuration.merges_directly and self.configuration.order_bits:
            order = order << self.configuration.node_order_bits | NODE
        rank = words["depth"] << self.configuration.order_bits | order
        return (interlace.unit(x, y), interlace.address(x, y), rank, color), sides


def random_pixels(configuration, seed, count, more=3):
    """``count`` triangles of up to ``more`` pixels: (pixel, its triangle)."""
    source = random.Random(f"pixels {seed}")
    interlace = configuration.interlace
    found = []
    for _ in range(count):
        triangle = Triangle(configuration, source)
        pixels = source.randrange(1, more + 1)
        for place in range(pixels):
            steps = triangle.at if place == 0 else (source.randrange(configuration.width),
                                                    source.randrange(configuration.height))
            last = place == pixels - 1
            found.append(({
                "x": source.randrange(interlace.width), "y": source.randrange(interlace.height),
                "x_steps": steps[0], "y_steps": steps[1],
                "none": int(pixels > 1 and last and source.random() < 0.3), "last": int(last),
            }, triangle))
    return found


def configurations():
    return {
        "flat": small_machine("PMMPMM", 16, 8, fraction_bits=3),
        "flat, exact": small_machine("PMM", 16, 8, fraction_bits=30),
        "gouraud": small_machine("PMM", 8, 16, fraction_bits=5, shading="gouraud"),
        "gouraud, exact": small_machine("PMM", 9, 16, fraction_bits=21, shading="gouraud"),
        "no fraction": small_machine("PM", 8, 8, fraction_bits=0, shading="gouraud"),
        "two bits of depth": small_machine("PM", 8, 8, depth_bits=2, fraction_bits=4),
        "sixteen units": small_machine("PM 15xM", 16, 4),
        "nodes": small_machine("3x(PMMC)", 8, 8, order_bits=3),
        "nodes without an order": small_machine("2x(PMT)", 8, 8, order_bits=0, shading="gouraud"),
        "directly": small_machine("PPPDMM", 8, 8, order_bits=5),
        "directly, a round": small_machine("PPPDMM", 8, 8, order_bits=2, shading="gouraud"),
        "directly, without an order": small_machine("PPPDMM", 8, 8, order_bits=0),
    }


def run(configuration, pixels, pause):
    dut = Interpolator(configuration=configuration)
    drawn = [triangle.fragment(pixel) for pixel, triangle in pixels if not pixel["none"]]
    source = Source(dut.pixels, [pixel for pixel, _ in pixels], pause[0])
    planes = Source(dut.planes, [triangle.planes for pixel, triangle in pixels if pixel["last"]])
    sink = Sink(dut.fragments, len(drawn), pause[1])
    holds = []

    def count(ctx, clock):
        entered = sum(not pixel["none"] for pixel, _ in pixels[:len(source.taken)])
        holds.append((entered - len(sink.items), ctx.get(dut.busy)))

    # Counted before this clock's transfers are: what it holds now.
    def lines(ctx, clock):
        ctx.set(dut.total, configuration.units)
        if configuration.merges_directly and configuration.order_bits:
            ctx.set(dut.node, NODE)

    simulate(dut, Drive(lines), Watch(count), source, planes, sink, after=3)
    assert [(item.unit, item.address, item.depth, item.color) for item in sink.items] == [
        fragment for fragment, _ in drawn]
    assert all(busy == (held > 0) for held, busy in holds)
    return dut, source, planes, sink, [sides for _, sides in drawn], {held for held, _ in holds}


@pytest.mark.parametrize("kind", configurations())
@pytest.mark.parametrize("seed", range(2))
def test_every_fragment(kind, seed):
    configuration = configurations()[kind]
    pixels = random_pixels(configuration, f"{kind} {seed}", 60)
    dut, *_, sides, held = run(configuration, pixels, (pauses(f"in {seed}"), pauses(f"out {seed}")))
    assert held == set(range(dut.latency + 1))
    # Saturation took place at both ends, of depth and of every interpolated channel, or is not
    # there at all.
    for found in zip(*sides, strict=True):
        assert {0} == set(found) if configuration.stays_in_range else {-1, 0, 1} <= set(found)


def test_latency_and_throughput():
    configuration = small_machine("PM", 8, 8)
    pixels = random_pixels(configuration, "speed", 20, more=1)
    dut, source, planes, sink, *_ = run(configuration, pixels, (no_pause, no_pause))
    assert dut.latency == 5
    assert source.taken == planes.taken == list(range(20))
    assert sink.clocks == [clock + dut.latency for clock in source.taken]
