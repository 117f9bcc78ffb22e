"""A memory unit where regions are dealt out: it shows the pixels that the table gives to it."""

import random

import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.regions import random_table, region_machine

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.hdl.memory_unit.memory_unit import MemoryUnit

SHOW_LATENCY, BUS_LATENCY = 3, 4  # of the video scan generator


@pytest.mark.parametrize("ports", [1, 2])
@pytest.mark.parametrize("name", ["few", "wide", "one each"])
def test_two_pictures_with_a_table_each(name, ports):
    """Every word of one unit is drawn, and scanned by two tables in turn; it shows what lies at the
    place that comes with a pixel, if it holds that, and nothing of what others hold."""
    configuration = region_machine(name, memory_ports=ports)
    pick = random.Random(f"{name} {ports}")
    number = pick.randrange(configuration.units)
    colors = [pick.getrandbits(24) for _ in range(configuration.words)]
    tables = [organisation_of(configuration).dealt(random_table(configuration, seed))
              for seed in range(2)]
    dut = MemoryUnit(configuration=configuration)
    period, swept = configuration.clocks_per_pixel, configuration.words + 4
    addresses = []
    for table in tables:
        for y in range(configuration.height):
            for x in range(configuration.width):
                region = table.regions.region(x, y)
                addresses.append({"x": x, "y": y, "element": int(table.table[region]),
                                  "slot": int(table.slot[region]), "valid": 1})
    first = swept + configuration.words + 4
    owed = [colors[table.word(pixel["x"], pixel["y"])]
            if table.unit(pixel["x"], pixel["y"]) == number else None
            for pixel, table in zip(addresses, [
                table for table in tables
                for _ in range(configuration.width * configuration.height)], strict=True)]

    def address(clock):
        place, rest = divmod(clock - first, period)
        if not 0 <= place < len(addresses):
            return {"valid": 0}
        return addresses[place] | {"valid": rest == 0}

    def drive(ctx, clock):
        ctx.set(dut.left.id, number)
        ctx.set(dut.total, configuration.units)
        ctx.set(dut.pictures.initialise, clock == 0)
        ctx.set(dut.pictures.front, clock >= first - 2)
        for tag in (dut.pictures.depth_tag, *dut.pictures.color_tag):
            ctx.set(tag, 1)
        write = clock - swept
        ctx.set(dut.left.lines.write, {
            "valid": 0 <= write < configuration.words, "unit": number,
            "address": max(0, write) % configuration.words, "depth": 3,
            "color": colors[max(0, write) % configuration.words]})
        ctx.set(dut.scan.fetch, address(clock))
        ctx.set(dut.scan.show, address(clock - SHOW_LATENCY))

    shown = []

    def watch(ctx, clock):
        place, rest = divmod(clock - BUS_LATENCY - first, period)
        if rest == 0 and 0 <= place < len(addresses):
            drawn, color = ctx.get(dut.scan.drawn), ctx.get(dut.scan.video)
            shown.append(color if drawn else None)
            assert drawn or color == 0

    clocks = first + len(addresses) * period + BUS_LATENCY
    simulate(dut, Drive(drive), Watch(watch, clocks=clocks), limit=clocks + 2)
    assert any(color is not None for color in owed)
    assert shown == owed
