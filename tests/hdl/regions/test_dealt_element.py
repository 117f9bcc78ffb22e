"""A processing element card whose regions another table gives it for every frame."""

import pytest
from hdl_bench.element_card import (
    FRAME_START,
    READ_COUNTERS,
    READ_DEPTH,
    READ_REGIONS,
    SURVEY,
    Bench,
    draw,
)
from hdl_bench.pictures import exact_words, prepare, prepared_values, random_triangles
from hdl_bench.regions import DealFrames, random_table, region_machine
from hdl_bench.streams import pauses
from suite.cases import EVERY

from cardcage.golden.balancing.region_counts import region_counts
from cardcage.golden.balancing.region_grid import RegionGrid
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification.commands import ResponseKind


@pytest.mark.parametrize(("machine", "seed", "balance", "ports"), [
    ("squares", 0, "clocks", 1), ("columns", 2, "static", 2), ("few", 1, "clocks", 1),
    ("one each", 2, "clocks", 2), pytest.param("squares", 2, "triangles", 2, marks=EVERY),
    pytest.param("wide", 1, "triangles", 1, marks=EVERY),
    pytest.param("rows", 3, "clocks", 2, marks=EVERY)])
def test_boot_frames_and_their_reports(machine, seed, balance, ports):
    plain = region_machine(machine)
    lists = [random_triangles(f"{machine} {seed} {frame}", 12, width=plain.width,
                              height=plain.height, flat=True) for frame in range(3)]
    configuration = region_machine(machine, balance=balance, memory_ports=ports,
                                   fraction_bits=max(map(scene_fraction_bits, lists)))
    element = seed % configuration.processing_elements
    tables = [random_table(configuration, f"{machine} {seed} {frame}") for frame in range(3)]
    share = 1 << configuration.share_bits
    first, end = element * share, (element + 1) * share
    packets, expected = [SURVEY, None], [(ResponseKind.DOMAIN, first << 16 | share)]
    background = (1 << configuration.depth_bits) - 1
    for scene, table in zip(lists, tables, strict=True):
        packets += [FRAME_START]
        packets += [draw(values) for values in
                    prepared_values(configuration, prepare(configuration, scene))]
        packets += [None, READ_DEPTH, None, READ_COUNTERS, None, READ_REGIONS, None]
        organisation = organisation_of(configuration).dealt(table)
        drawn, fragments = exact_words(scene, configuration.pictures()[0], flat=True)
        depths = {(organisation.unit(x, y), organisation.word(x, y)): depth
                  for (x, y), (depth, _) in drawn.items()}
        expected += [(ResponseKind.DEPTH, depths.get((unit, word), background))
                     for unit in range(first, end) for word in range(configuration.words)]
        expected += [(ResponseKind.FRAGMENTS, sum(
            first <= organisation.unit(x, y) < end for x, y in fragments)),
            (ResponseKind.BUSY, None)]
        if balance != "static":
            counts = region_counts(scene, RegionGrid.of(configuration.dealt_regions)).of(balance)
            expected += [(ResponseKind.REGION_COUNT, 0 if region < 0 else counts[region])
                         for region in organisation.region_at[element]]
    bench = Bench(configuration, first, end, packets, responses=len(expected), seed=seed,
                  scan=0.2 * seed, pause=pauses(seed) if seed else lambda: 0,
                  deal=lambda dut, announcer: DealFrames(dut, announcer, tables))
    for (kind, value), (wanted, number) in zip(bench.responses, expected, strict=True):
        assert kind == wanted
        assert number is None or value == number, kind
    colors = {(organisation.unit(x, y), organisation.word(x, y)): color
              for (x, y), (_, color) in drawn.items()}
    assert bench.memory.back == {
        place: colors.get(place) for place in bench.memory.back}
    assert sum(number for kind, number in expected if kind == ResponseKind.FRAGMENTS) > 5
