"""Fragments along spans, against ``golden.fixed`` pixel by pixel."""

import random

import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden import fixed
from cardcage.golden.commands import CHANNELS
from cardcage.hdl.fragment_stepper import FragmentStepper


def random_spans(configuration, seed, count):
    """Runs that stay in the picture, with values around both ends of their range."""
    pick = random.Random(f"spans {seed}")
    interlace, fraction_bits = configuration.interlace, configuration.fraction_bits

    def carried(value_bits, bits):
        around = pick.choice((0, (1 << value_bits) - 1, 1 << value_bits - 1))
        value = (around << fraction_bits) + pick.randrange(-3, 4) * (1 << fraction_bits) // 2
        step = pick.randrange(-2, 3) * pick.choice((1, 1 << fraction_bits)) + pick.randrange(-1, 2)
        return value % (1 << bits), step % (1 << bits)

    for _ in range(count):
        x_stride_bits = pick.randrange(interlace.x_unit_bits + 1)
        x = pick.randrange(interlace.width)
        room = (interlace.width - 1 - x) >> x_stride_bits
        parts = {"depth": carried(configuration.depth_bits, configuration.depth_plane_bits)}
        for name in CHANNELS:
            parts[name] = ((pick.getrandbits(8), 0) if configuration.shading == "flat"
                           else carried(8, configuration.channel_plane_bits))
        yield {"x": x, "y": pick.randrange(interlace.height), "x_stride_bits": x_stride_bits,
               "more": pick.choice((0, room, pick.randrange(room + 1))),
               "values": {name: value for name, (value, _) in parts.items()},
               "steps": {name: step for name, (_, step) in parts.items()}}


def fragments(configuration, span):
    """(unit, address, depth, color) of each pixel, and whether anything was saturated."""
    interlace = configuration.interlace
    for step in range(span["more"] + 1):
        x, y = span["x"] + (step << span["x_stride_bits"]), span["y"]

        def stored(name, bits, limit, step=step):
            carried = fixed.wrap(span["values"][name] + step * span["steps"][name], bits)
            whole = fixed.floor_shift(fixed.to_signed(carried, bits), configuration.fraction_bits)
            return fixed.saturate(whole, 0, limit), (whole > limit) - (whole < 0)

        depth, clipped = stored("depth", configuration.depth_plane_bits,
                                (1 << configuration.depth_bits) - 2)
        color, clippings = 0, [clipped]
        for place, name in enumerate(CHANNELS):
            channel = span["values"][name]
            if configuration.shading == "gouraud":
                channel, clipped = stored(name, configuration.channel_plane_bits, 255)
                clippings.append(clipped)
            color |= channel << 8 * place
        yield (interlace.unit(x, y), interlace.address(x, y), depth, color), clippings


def configurations():
    return {
        "flat": small_machine("PMMPMM", 8, 8, fraction_bits=0),
        "gouraud": small_machine("PMM", 8, 8, fraction_bits=5, shading="gouraud"),
        "gouraud, no fraction": small_machine("PMMMM", 8, 8, fraction_bits=0, shading="gouraud"),
        "two bits of depth": small_machine("PM", 8, 8, depth_bits=2, fraction_bits=9),
        "sixteen units": small_machine("PM 15xM", 16, 4),
    }


def run(configuration, spans, pause):
    dut = FragmentStepper(configuration=configuration)
    expected = [fragment for span in spans for fragment in fragments(configuration, span)]
    source = Source(dut.started, spans, pause[0])
    sink = Sink(dut.fragments, len(expected), pause[1])
    left = [span["more"] + 1 for span in spans]

    def busy(ctx, clock):
        held = sum(left[: len(source.taken)]) - len(sink.items)
        assert ctx.get(dut.busy) == (held > 0)

    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.total, configuration.units)), Watch(busy),
             source, sink, after=3)
    assert [(item.unit, item.address, item.depth, item.color) for item in sink.items] == [
        fragment for fragment, _ in expected]
    return dut, source, sink, [clippings for _, clippings in expected]


@pytest.mark.parametrize("kind", configurations())
@pytest.mark.parametrize("seed", range(2))
def test_every_fragment(kind, seed):
    configuration = configurations()[kind]
    spans = list(random_spans(configuration, f"{kind} {seed}", 40))
    *_, clippings = run(configuration, spans, (pauses(f"in {seed}"), pauses(f"out {seed}")))
    # Saturation took place at both ends, of depth and of every interpolated channel.
    for clipped in zip(*clippings, strict=True):
        assert {-1, 0, 1} <= set(clipped)


def test_latency_and_throughput():
    """A fragment a clock, the next span without a bubble."""
    configuration = small_machine("PMM", 8, 8)
    spans = list(random_spans(configuration, "speed", 20))
    dut, source, sink, _ = run(configuration, spans, (no_pause, no_pause))
    assert dut.latency == 2
    assert source.taken[0] + dut.latency == sink.clocks[0]
    assert sink.clocks == list(range(dut.latency, dut.latency + len(sink.items)))
