"""Start and increments of single interpolants against ``golden.reference.triangle_setup``."""

import random
from dataclasses import replace

import pytest
from hdl_bench.bench import Drive, rejects, simulate
from hdl_bench.pictures import prepare, random_triangles, small_machine
from hdl_bench.pipelines import Results, Starts
from suite.cases import chosen

from cardcage.golden.specification.configuration import MAXIMUM_SETUP_INTERVAL
from cardcage.hdl.triangle_setup.plane_setup import PlaneSetup, Slot

INPUTS = ("slot", "upper", "first", "second", "factor_1", "factor_2", "offset", "double_area")


def slots_of(configuration, seed, count, interpolant, *, color_bits=8):
    """(inputs, result) of each slot of each triangle: what the slot does not need is left out."""
    listed = random_triangles(seed, count, width=configuration.width, height=configuration.height,
                              sub_bits=configuration.sub_bits, depth_bits=configuration.depth_bits,
                              extreme=True)
    listed = replace(listed, color=listed.color >> 8 - color_bits)
    prepared = prepare(configuration, listed)
    planes, values = ((prepared.depth, listed.depth) if interpolant == "depth" else
                      (prepared.color[0], listed.color[:, :, 0]))
    grid = prepared.grid
    slots = []
    for place, primitive in enumerate(prepared.primitive.tolist()):
        corners = [(int(x), int(y), int(value)) for (x, y), value in
                   zip(listed.position[primitive], values[primitive], strict=True)]
        x, y, upper = min(corners, key=lambda corner: corner[1])
        turn = corners.index((x, y, upper))
        (x1, y1, first), (x2, y2, second) = (
            (other_x - x, other_y - y, value - upper)
            for other_x, other_y, value in corners[turn + 1:] + corners[:turn])
        area = x1 * y2 - x2 * y1
        if area < 0:
            (x1, y1, first), (x2, y2, second) = (x2, y2, second), (x1, y1, first)
        rises = {"first": first, "second": second, "double_area": abs(area)}
        left, top = int(prepared.left[place]), int(prepared.top[place])
        slots += [
            (rises | {"slot": Slot.STEP_X, "factor_1": y2, "factor_2": -y1,
                      "offset": left * grid.unit_x + grid.unit_x // 2 - x},
             int(planes.step_x[place])),
            (rises | {"slot": Slot.STEP_Y, "factor_1": -x2, "factor_2": x1,
                      "offset": top * grid.unit_y + grid.unit_y // 2 - y},
             int(planes.step_y[place])),
            ({"slot": Slot.START, "upper": upper, "double_area": abs(area)},
             int(planes.start[place])),
        ]
    return slots


def run(configuration, slots, interpolant, seed, gap=lambda: 0, **changes):
    """All ``slots`` through the unit, ``gap()`` clocks later than it could take each."""
    widths = ({"value_bits": configuration.depth_bits,
               "word_bits": configuration.depth_plane_bits} if interpolant == "depth" else
              {"value_bits": 8, "word_bits": configuration.channel_plane_bits})
    dut = PlaneSetup(configuration=configuration, **widths | changes)
    grid = {name: getattr(configuration.interlace, name)
            for name in ("width", "height", "x_shift", "y_shift")}
    starts = Starts(dut, dut.start, INPUTS, [inputs for inputs, _ in slots],
                    lambda: dut.interval + gap(), seed)
    results = Results(dut.done, dut.result, len(slots))
    simulate(dut, Drive(lambda ctx, clock: ctx.set(dut.grid, grid)), starts, results,
             after=dut.latency + 3, limit=60_000)
    # golden.setup keeps some bits above those that this machine carries.
    mask = (1 << dut.word_bits) - 1
    assert results.values == [result & mask for _, result in slots]
    # In time, whatever the pauses between them.
    assert results.clocks == [clock + dut.latency for clock in starts.clocks]
    return dut, starts


MACHINES = {
    "a stage a bit": {},
    "two clocks a step": {"setup_interval": 2},
    "a few stages": {"setup_interval": 7},
    "one divider": {"setup_interval": MAXIMUM_SETUP_INTERVAL},
    "no fraction": {"fraction_bits": 0},
    "few bits": {"sub_bits": 1, "depth_bits": 2, "fraction_bits": 30},
    "many bits": {"sub_bits": 8, "depth_bits": 32, "fraction_bits": 44},
    "not square": {"width": 3, "height": 21},
    "y halved": {"words": 128},
    "both halved": {"words": 64},
}


@pytest.mark.parametrize("interpolant", ["depth", "red"])
@pytest.mark.parametrize("kind", chosen(
    MACHINES, "a stage a bit", "a few stages", "one divider", "many bits", "both halved"))
def test_equal_to_golden_at_random_times(kind, interpolant):
    configuration = small_machine("PM", **{"width": 16, "height": 16, "shading": "gouraud"}
                                  | MACHINES[kind])
    seed = f"{kind} {interpolant}"
    slots = slots_of(configuration, seed, 40 if configuration.setup_interval < 7 else 12,
                     interpolant)
    assert len(slots) > 15
    pick = random.Random(f"gaps {seed}")
    run(configuration, slots, interpolant, seed,
        lambda: pick.choice((0, 0, 1, 3, pick.randrange(40))))


def test_one_bit_is_enough():
    """Of the values, and of what is carried."""
    configuration = small_machine("PM", 16, 16, shading="gouraud")
    slots = slots_of(configuration, "one bit", 12, "red", color_bits=1)
    assert {inputs["first"] for inputs, _ in slots if "first" in inputs} == {-1, 0, 1}
    assert {result & 1 for _, result in slots} == {0, 1}
    run(configuration, slots, "red", "one bit", value_bits=1, word_bits=1)


@pytest.mark.parametrize(("interval", "actual"), [(1, 1), (2, 2), (9, 9), (256, 34)])
def test_latency_and_throughput(interval, actual):
    """A slot a division, one after the other; its result ``latency`` clocks later."""
    configuration = small_machine("PM", 16, 16, setup_interval=interval)
    slots = slots_of(configuration, "speed", 12, "depth")
    dut, starts = run(configuration, slots, "depth", "speed")
    assert dut.interval == actual
    assert starts.clocks == [place * dut.interval for place in range(len(slots))]


@pytest.mark.parametrize("name", ["value_bits", "word_bits"])
def test_bad_arguments(name):
    rejects(PlaneSetup, name, **{"configuration": small_machine("PM"), "value_bits": 8,
                                 "word_bits": 16} | {name: 0})
