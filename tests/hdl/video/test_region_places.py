"""The scan where regions are dealt out: each pixel with the place of its region."""

import random

import pytest
from hdl_bench.bench import Drive, Watch, simulate
from hdl_bench.pictures import small_machine
from hdl_bench.regions import MACHINES, RegionDriver, random_table, region_machine, region_words

from cardcage.golden.organisations.region_table import slots_of
from cardcage.hdl.video.region_places import RegionPlaces
from cardcage.hdl.video.video_scan_generator import VideoScanGenerator


class Tables(RegionDriver):
    """Fills one table after another, each while the one before is in use.

    ``begin``: the clock from which each is, and in which the next one begins to come.
    """

    def __init__(self, lines, configuration, begin):
        super().__init__(lines)
        self.tables = [random_table(configuration, number) for number in range(len(begin) + 1)]
        self.words = [region_words(configuration, table) for table in self.tables]
        self.begin = begin

    def at(self, clock):
        """How many of them have been in use by then."""
        return sum(begin <= clock for begin in self.begin)

    def drive(self, ctx, clock):
        number = self.at(clock)
        since = clock - [0, *self.begin][number]
        words = self.words[number] if number < len(self.words) else []
        self.say(ctx, words[since] if since < len(words) else None, number % 2)


@pytest.mark.parametrize("name", MACHINES)
def test_places(name):
    """Looked up by the one table while the other is filled."""
    configuration = region_machine(name)
    regions, count = configuration.dealt_regions, configuration.dealt_regions.count
    dut, pick = RegionPlaces(configuration=configuration), random.Random(name)
    begin = [count + 3, 3 * count + 40]
    tables = Tables(dut.regions, configuration, begin)
    asked, found = [], []

    def drive(ctx, clock):
        tables.drive(ctx, clock)
        asked.append((pick.randrange(configuration.width), pick.randrange(configuration.height)))
        ctx.set(dut.x, asked[-1][0])
        ctx.set(dut.y, asked[-1][1])

    def watch(ctx, clock):
        place = ctx.get(dut.place)
        found.append((place.element, place.slot))

    simulate(dut, Drive(drive), Watch(watch, clocks=begin[-1] + 60))
    for clock, (x, y) in enumerate(asked[:-dut.latency]):
        if number := tables.at(clock):
            table, region = tables.tables[number - 1], regions.region(x, y)
            assert found[clock + dut.latency] == (table[region], slots_of(table)[region])


@pytest.mark.parametrize("name", ["three", "small"])
def test_the_scan_is_that_of_other_machines_a_clock_later(name):
    """Pin by pin, and with each pixel the place of its region, whatever tables come meanwhile."""
    cards, size, regions = {"three": ("3x(PM)", (9, 6), (5, 3)),
                            "small": ("2x(PM)", (5, 3), (1, 1))}[name]
    plain = small_machine("PM", *size)
    dealt = small_machine(cards, *size, regions=regions)
    clocks = 3 * plain.cycles_per_scan
    tables = None

    def scanned(configuration, begin):
        nonlocal tables
        dut, seen = VideoScanGenerator(configuration=configuration), []
        later = configuration is dealt
        if later:
            tables = Tables(dut.regions, configuration, begin)

        def drive(ctx, clock):
            show = ctx.get(dut.scan.show)
            ctx.set(dut.scan.drawn, color[0] is not None)
            ctx.set(dut.scan.video, color[0] or 0)
            color[0] = (show.x * 7 + show.y * 0x1001 + 1) if (show.x + show.y) % 3 else None
            ctx.set(dut.background, 0x123456)
            if later:
                tables.drive(ctx, clock)

        def watch(ctx, clock):
            pins, fetch, show = (ctx.get(part) for part in (
                dut.pins.active, dut.scan.fetch, dut.scan.show))
            seen.append({
                "start": ctx.get(dut.start),
                "pins": (pins, *(ctx.get(getattr(dut.pins, pin)) for pin in (
                    "pixel", "horizontal_sync", "vertical_sync", "red", "green", "blue"))),
                "fetch": (fetch.x, fetch.y) if fetch.valid else None,
                "show": (show.x, show.y) if show.valid else None,
                "places": [(address.element, address.slot) if address.valid else None
                           for address in ((fetch, show) if later else ())]})

        color = [None]
        simulate(dut, Drive(drive), Watch(watch, clocks=clocks), limit=clocks + 2)
        return seen

    before = scanned(plain, ())
    starts = [clock for clock, seen in enumerate(before) if seen["start"]]
    # As the controller does it: from the clock after a scan's start on.
    after = scanned(dealt, [start + 1 for start in starts[1:]])
    assert [seen["start"] for seen in after] == [seen["start"] for seen in before]
    latency = VideoScanGenerator.latency
    for name, warm in (("fetch", 0), ("show", 0), ("pins", latency)):
        assert [seen[name] for seen in after][warm + 1:] == [seen[name] for seen in before][warm:-1]
    for clock in range(starts[1], clocks):
        table = tables.tables[tables.at(clock - 2) - 1]
        for what, place in zip(("fetch", "show"), after[clock]["places"], strict=True):
            if place is not None:
                region = dealt.dealt_regions.region(*after[clock][what])
                assert place == (table[region], slots_of(table)[region])
