"""Regions of the screen: which numbers of them there are, and what are none."""

import pytest

from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.regions import default_slots, regions_of


@pytest.mark.parametrize(("regions", "message"), [
    ((4,), "regions: (4,) is not (columns, rows), such as (8, 8)"),
    ((), "regions: () is not (columns, rows)"),
    ((4, 4, 4), "regions: (4, 4, 4) is not (columns, rows)"),
    (4, "regions: 4 is not (columns, rows)"),
    ([4, 4], "regions: [4, 4] is not (columns, rows)"),
    ((4, 4.0), "regions: rows: 4.0 is not a whole number from 1 to 4096"),
    ((16, 16), "regions: 1x1 pixels do not spread over 2 memory units; take 2x1 or more"),
], ids=str)
def test_what_is_no_number_of_regions(regions, message):
    with pytest.raises(InputError) as caught:
        MachineConfiguration(cards="3x(PMM)", width=16, height=16, regions=regions)
    assert message in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(("size", "counts", "bits"), [
    ((640, 480), (10, 8), (6, 6)), ((640, 480), (5, 15), (7, 5)), ((512, 512), (8, 16), (6, 5)),
    ((61, 1), (61, 1), (0, 0)), ((61, 1), (1, 1), (6, 0)), ((5, 7), (2, 4), (2, 1))])
def test_regions_have_the_smallest_size_of_which_there_are_as_many(size, counts, bits):
    regions = regions_of(*size, *counts)
    assert (regions.x_bits, regions.y_bits) == bits and regions.count == counts[0] * counts[1]
    assert regions.region(size[0] - 1, size[1] - 1) == regions.count - 1


def test_every_number_that_is_refused_names_the_nearest_that_work():
    for pixels in (1, 2, 7, 61, 64, 640):
        works = {-(-pixels >> bits) for bits in range(12)}
        for wanted in range(1, pixels + 3):
            if wanted in works:
                assert regions_of(pixels, 1, wanted, 1).columns == wanted
                continue
            with pytest.raises(InputError) as caught:
                regions_of(pixels, 1, wanted, 1)
            below = [max(count for count in works if count < wanted)]
            above = sorted(count for count in works if count > wanted)[:1]
            assert str(caught.value) == (
                f"regions: no power-of-two size gives {wanted} columns of {pixels} pixels; take "
                f"{' or '.join(map(str, below + above))}")


def test_no_more_than_1024_regions():
    assert regions_of(64, 64, 32, 32).count == 1024
    with pytest.raises(InputError, match="64x32 are 2048 regions, at most 1024; take larger ones"):
        regions_of(64, 64, 64, 32)


def test_slots_are_a_quarter_more_than_an_even_share():
    assert [default_slots(count, elements) for count, elements in (
        (128, 16), (128, 3), (64, 64), (5, 2))] == [10, 54, 2, 4]
