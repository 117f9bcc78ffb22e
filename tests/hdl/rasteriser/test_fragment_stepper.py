"""Pixels along spans, one by one."""

import random

import pytest
from hdl_bench.bench import Watch, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.streams import Sink, Source, no_pause, pauses

from cardcage.hdl.rasteriser.fragment_stepper import FragmentStepper, pixel_layout


def random_spans(configuration, seed, count, *, none=0.2):
    """Runs that stay in the picture, of any stride; some without a pixel end a triangle."""
    pick = random.Random(f"spans {seed}")
    for _ in range(count):
        left = pick.randrange(configuration.width)
        x = pick.randrange(left, configuration.width)
        empty = pick.random() < none
        yield {"x": x, "y": pick.randrange(configuration.height),
               "end": pick.choice((x + 1, configuration.width,
                                   pick.randrange(x + 1, configuration.width + 1))),
               "stride": 1 << pick.randrange(configuration.maximum_units.bit_length()),
               "left": left, "y_steps": pick.randrange(configuration.height),
               "none": empty, "last": empty or pick.randrange(2)}


def pixels(span):
    """What comes of a span: its last pixel, or the word in place of one, ends the triangle."""
    found = [span["x"]] if span["none"] else range(span["x"], span["end"], span["stride"])
    for x in found:
        yield {"x": x, "y": span["y"], "x_steps": x - span["left"], "y_steps": span["y_steps"],
               "none": span["none"], "last": span["last"] and x == found[-1]}


def run(configuration, spans, pause):
    dut = FragmentStepper(configuration=configuration)
    expected = [pixel for span in spans for pixel in pixels(span)]
    source = Source(dut.spans, spans, pause[0])
    sink = Sink(dut.pixels, len(expected), pause[1])
    counts = [len(list(pixels(span))) for span in spans]

    def busy(ctx, clock):
        held = sum(counts[:len(source.taken)]) - len(sink.items)
        assert ctx.get(dut.busy) == (held > 0)

    simulate(dut, Watch(busy), source, sink, after=3)
    names = pixel_layout(configuration).members
    assert [{name: item[name] for name in names} for item in sink.items] == expected
    return dut, source, sink


@pytest.mark.parametrize("cards", ["PM", "PMMPMM", "PM 15xM"])
@pytest.mark.parametrize("size", [(8, 8), (13, 5)])
@pytest.mark.parametrize("seed", range(2))
def test_every_pixel(cards, size, seed):
    configuration = small_machine(cards, *size)
    spans = list(random_spans(configuration, f"{cards} {seed}", 60))
    run(configuration, spans, (pauses(f"in {seed}"), pauses(f"out {seed}")))


def test_latency_and_throughput():
    """A pixel a clock, the next span without a bubble."""
    configuration = small_machine("PMM", 8, 8)
    spans = list(random_spans(configuration, "speed", 30))
    dut, source, sink = run(configuration, spans, (no_pause, no_pause))
    assert dut.latency == 2
    assert source.taken[0] + dut.latency == sink.clocks[0]
    assert sink.clocks == list(range(dut.latency, dut.latency + len(sink.items)))
