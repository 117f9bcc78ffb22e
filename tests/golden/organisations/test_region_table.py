"""Tables of regions: the contract of packing, straight from its sentences."""

import numpy as np
import pytest

from cardcage.golden.organisations.region_table import (
    packed_table,
    runs_table,
    slots_of,
    static_table,
)
from cardcage.golden.specification.errors import InputError


def packed_by_hand(counts, elements, slots):
    """Heaviest first, then lowest; to the least loaded with room, fewest regions, lowest."""
    load, held, table = [0] * elements, [0] * elements, [0] * len(counts)
    for region in sorted(range(len(counts)), key=lambda region: (-counts[region], region)):
        element = min((element for element in range(elements) if held[element] < slots),
                      key=lambda element: (load[element], held[element], element))
        table[region] = element
        load[element] += counts[region] + 1
        held[element] += 1
    return table


@pytest.mark.parametrize("seed", range(40))
def test_packing_is_what_the_contract_says(seed):
    print("seed", seed)
    numbers = np.random.default_rng(seed)
    elements = int(numbers.integers(1, 12))
    regions = int(numbers.integers(1, 60))
    slots = -(-regions // elements) + int(numbers.integers(0, 3))
    counts = numbers.integers(0, int(numbers.choice([1, 2, 5, 1000, 1 << 32])), regions)
    table = packed_table(counts, elements, slots)
    assert table.tolist() == packed_by_hand(counts.tolist(), elements, slots)
    assert np.bincount(table, minlength=elements).max() <= slots


def test_empty_regions_are_spread_and_do_not_all_go_to_one():
    assert np.bincount(packed_table(np.zeros(128, np.int64), 16, 10)).tolist() == [8] * 16


def test_greatest_counts_do_not_overflow():
    counts = np.full(1024, (1 << 32) - 1)
    assert np.bincount(packed_table(counts, 16, 64)).tolist() == [64] * 16


def test_slots_count_lower_regions_of_the_same_element():
    table = np.array([2, 0, 2, 2, 1, 0])
    assert slots_of(table).tolist() == [0, 0, 1, 2, 0, 1]
    assert static_table(7, 3).tolist() == [0, 1, 2, 0, 1, 2, 0]
    assert slots_of(static_table(7, 3)).tolist() == [0, 0, 0, 1, 1, 1, 2]


@pytest.mark.parametrize("elements", [1, 2, 3, 4, 7, 8, 16])
@pytest.mark.parametrize("regions", [1, 4, 12, 64, 65])
def test_runs_are_as_even_as_can_be(regions, elements):
    table = runs_table(regions, elements).tolist()
    assert table == [element for element in range(elements) for region in range(
        element * regions // elements, (element + 1) * regions // elements)]
    assert max(map(table.count, table)) == -(-regions // elements)


@pytest.mark.parametrize(("counts", "elements", "slots", "message"), [
    ([1, 2, 3], 2, 1, "slots: 1 in each of 2 processing elements do not hold 3 regions"),
    ([[1, 2]], 2, 2, "counts: are not whole numbers from 0 on, one for each region"),
    (5, 2, 2, "counts: are not whole numbers"),
    ([1.5, 2.0], 2, 2, "counts: are not whole numbers"),
    ([1, -1], 2, 2, "counts: are not whole numbers"),
    ([1 << 62], 2, 2, "counts: are not whole numbers"),
    ([1], -2, -2, "elements: -2 is not a whole number"),
    ([1], 2, 0, "slots: 0 is not a whole number"),
], ids=str)
def test_what_cannot_be_packed(counts, elements, slots, message):
    with pytest.raises(InputError, match=message):
        packed_table(counts, elements, slots)
