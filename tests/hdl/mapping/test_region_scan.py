"""Where pixels lie when regions are dealt out: every pixel of a picture, of every unit."""

import pytest
from hdl_bench.bench import evaluate
from hdl_bench.regions import MACHINES, random_table, region_machine

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.hdl.mapping.region_address import RegionAddress
from cardcage.hdl.mapping.region_scan import RegionScanAddress


def pixels(configuration, organisation):
    """x, y, and what is known of their region, of every pixel."""
    for y in range(configuration.height):
        for x in range(configuration.width):
            region = organisation.regions.region(x, y)
            yield {"x": x, "y": y, "element": int(organisation.table[region]),
                   "slot": int(organisation.slot[region])}


def ask(ctx, dut, pixel):
    for name, value in pixel.items():
        if len(getattr(dut, name)):
            ctx.set(getattr(dut, name), value)


@pytest.mark.parametrize("name", MACHINES)
def test_every_pixel(name):
    configuration = region_machine(name)
    organisation = organisation_of(configuration).dealt(random_table(configuration, name))
    dut = RegionAddress(configuration=configuration)

    def steps(ctx):
        for pixel in pixels(configuration, organisation):
            ask(ctx, dut, pixel)
            place = pixel["x"], pixel["y"]
            assert ctx.get(dut.unit) == organisation.unit(*place)
            assert ctx.get(dut.address) == organisation.word(*place)

    evaluate(dut, steps)


@pytest.mark.parametrize("name", MACHINES)
def test_every_unit_reads_what_it_holds_as_its_group_begins(name):
    configuration = region_machine(name)
    organisation = organisation_of(configuration).dealt(random_table(configuration, name))
    dut = RegionScanAddress(configuration=configuration)
    group = organisation.scan_group

    def steps(ctx):
        for unit in {0, 1, configuration.units // 2, configuration.units - 1}:
            read = None
            ctx.set(dut.id, unit)
            for pixel in pixels(configuration, organisation):
                ask(ctx, dut, pixel)
                x, y = pixel["x"], pixel["y"]
                held = organisation.unit(x, y) == unit
                assert ctx.get(dut.selected) == held
                if ctx.get(dut.fetch):
                    assert x % group == 0
                    assert pixel["element"] == unit >> configuration.share_bits
                    read = y, x // group, ctx.get(dut.address)
                if held:
                    assert read == (y, x // group, organisation.word(x, y))

    evaluate(dut, steps)
