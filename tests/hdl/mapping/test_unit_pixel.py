"""The way back from an address to its pixel: exhaustive over pictures, a pixel a clock."""

import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.pictures import small_machine

from cardcage.hdl.mapping.unit_pixel import UnitPixel, reciprocal_shift

#: Machines whose pitch is a power of two for every number of units, and others.
MACHINES = {
    "shifts": ("PMMMM", (16, 8), {}),
    "odd": ("PMMMM", (13, 9), {}),
    "one column": ("PMM", (1, 11), {}),
    "one pixel": ("PMMMM", (1, 1), {}),
    "coarser": ("PMMMM", (23, 17), {"words": 30}),
    "skewed": ("PMMPMM", (23, 17), {"skew": True}),
    "squares": ("4x(PMM)", (23, 17), {"block": 4}),
    "lines": ("4x(PMM)", (23, 17), {"lines": True}),
    "diagonal": ("PPDMMMM", (23, 17), {}),
}


@pytest.mark.parametrize("name", MACHINES)
def test_every_word_of_every_unit(name):
    cards, (width, height), changes = MACHINES[name]
    configuration = small_machine(cards, width, height, **changes)
    for interlace in configuration.interlaces():
        dut = UnitPixel(configuration=configuration)
        places = [(interlace.unit(x, y), interlace.address(x, y), x, y)
                  for y in range(interlace.height) for x in range(interlace.width)]
        found = []

        def drive(ctx, clock, dut=dut, places=places, interlace=interlace):
            unit, address, *_ = places[min(clock, len(places) - 1)]
            ctx.set(dut.total, interlace.units)
            ctx.set(dut.unit, unit)
            ctx.set(dut.address, address)

        def watch(ctx, clock, dut=dut, found=found):
            found.append((ctx.get(dut.x), ctx.get(dut.y)))

        simulate(dut, Drive(drive), Watch(watch, clocks=len(places) + dut.latency))
        assert found[dut.latency:] == [(x, y) for *_, x, y in places]


def test_the_reciprocal_is_exact():
    for words in (1, 2, 7, 64, 1000, 4096):
        for pitch in range(1, 70):
            shift = reciprocal_shift(pitch, words)
            for given in (shift, shift + 1, shift + 5):  # where another pitch wants more
                factor = -(-(1 << given) // pitch)
                assert all(address * factor >> given == address // pitch
                           for address in range(words))
            assert shift <= (words - 1).bit_length() + (pitch - 1).bit_length()
