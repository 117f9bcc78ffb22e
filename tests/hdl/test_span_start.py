"""Interpolants at the first pixel of a span, against integers modulo a power of two."""

import random

import pytest
from hdl_bench.bench import Watch, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.golden.commands import CHANNELS
from cardcage.hdl.span_start import SpanStart, started_span_layout

PASSED_ON = ("x", "y", "more", "x_stride_bits")


def random_spans(configuration, seed, count, more=2):
    """``count`` triangles of up to ``more`` spans, each with the planes of its triangle."""
    source = random.Random(f"spans {seed}")

    def plane(bits):
        # All ones and the sign bit alone come up, too: sums must wrap.
        pick = (source.getrandbits(bits), (1 << bits) - 1, 1 << bits - 1, 0)
        return {part: source.choice(pick) for part in ("start", "step_x", "step_y")}

    def channel():
        return (source.getrandbits(8) if configuration.shading == "flat"
                else plane(configuration.channel_plane_bits))

    def span(planes, last):
        return {
            "x": source.randrange(configuration.width),
            "y": source.randrange(configuration.height),
            "x_steps": source.randrange(configuration.width),
            "y_steps": source.randrange(configuration.height),
            "more": source.randrange(configuration.width),
            "x_stride_bits": source.randrange(configuration.maximum_units.bit_length()),
            "none": int(more > 1 and last and source.random() < 0.3), "last": int(last),
            "planes": planes,
        }

    spans = []
    for _ in range(count):
        planes = {"depth": plane(configuration.depth_plane_bits),
                  **{name: channel() for name in CHANNELS}}
        inside = source.randrange(more)
        spans += [span(planes, place == inside) for place in range(inside + 1)]
    return spans


def without_planes(spans):
    return [{name: value for name, value in span.items() if name != "planes"} for span in spans]


def expected(configuration, span):
    """Values at the span's first pixel and steps along it."""
    widths = {"depth": configuration.depth_plane_bits,
              **dict.fromkeys(CHANNELS, configuration.channel_plane_bits)}
    values, steps = {}, {}
    for name, bits in widths.items():
        plane = span["planes"][name]
        if isinstance(plane, int):
            values[name], steps[name] = plane, 0
            continue
        values[name] = (plane["start"] + span["x_steps"] * plane["step_x"]
                        + span["y_steps"] * plane["step_y"]) % (1 << bits)
        steps[name] = plane["step_x"] * (1 << span["x_stride_bits"]) % (1 << bits)
    return {**{name: span[name] for name in PASSED_ON}, "values": values, "steps": steps}


def decoded(item):
    return {**{name: item[name] for name in PASSED_ON},
            **{group: {name: item[group][name] for name in ("depth", *CHANNELS)}
               for group in ("values", "steps")}}


def configurations():
    return {"flat": small_machine("PMMPMM", 16, 8, fraction_bits=3),
            "gouraud": small_machine("PMM", 8, 16, fraction_bits=11, shading="gouraud"),
            "no fraction": small_machine("PM", 8, 8, fraction_bits=0, shading="gouraud")}


@pytest.mark.parametrize("kind", configurations())
@pytest.mark.parametrize("seed", range(3))
def test_products_and_sums(kind, seed):
    configuration = configurations()[kind]
    dut = SpanStart(configuration=configuration)
    assert dut.started.payload.shape() == started_span_layout(configuration)
    spans = random_spans(configuration, f"{kind} {seed}", 60)
    drawn = [span for span in spans if not span["none"]]
    assert 60 < len(drawn) < len(spans)
    source = Source(dut.spans, without_planes(spans), pauses(f"in {seed}"))
    planes = Source(dut.planes, [span["planes"] for span in spans if span["last"]])
    sink = Sink(dut.started, len(drawn), pauses(f"out {seed}"))
    holds = []

    def count(ctx, clock):
        entered = sum(not span["none"] for span in spans[:len(source.taken)])
        holds.append((entered - len(sink.items), ctx.get(dut.busy)))

    # Counted before this clock's transfers are: what it holds now.
    simulate(dut, Watch(count), source, planes, sink, after=3)
    assert [decoded(item) for item in sink.items] == [expected(configuration, span)
                                                      for span in drawn]
    assert all(busy == (held > 0) for held, busy in holds)
    assert {held for held, _ in holds} == set(range(dut.latency + 1))


def test_latency_and_throughput():
    configuration = small_machine("PM", 8, 8)
    dut = SpanStart(configuration=configuration)
    spans = random_spans(configuration, "speed", 20, more=1)
    source = Source(dut.spans, without_planes(spans))
    planes = Source(dut.planes, [span["planes"] for span in spans])
    sink = Sink(dut.started, len(spans), no_pause)
    simulate(dut, source, planes, sink)
    assert dut.latency == 4
    assert source.taken == planes.taken == list(range(20))
    assert sink.clocks == [clock + dut.latency for clock in source.taken]
