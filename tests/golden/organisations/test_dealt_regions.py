"""Where pixels lie where regions of the screen are dealt out."""

import numpy as np
import pytest

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.region_table import packed_table
from cardcage.golden.specification.commands import Fault
from cardcage.golden.specification.configuration import MachineConfiguration

MACHINES = [("3x(PMM)", 61, 48, (8, 3)), ("5x(PM)", 17, 9, (5, 9)), ("PMMMM", 16, 16, (4, 2)),
            ("16x(PM)", 32, 32, (4, 4)), ("3x(PMMMM)", 64, 1, (1, 1))]


def of(cards, width, height, regions, **fields):
    return MachineConfiguration(cards=cards, width=width, height=height, regions=regions, **fields)


@pytest.mark.parametrize("machine", MACHINES[:4], ids=str)
@pytest.mark.parametrize("seed", range(3))
def test_every_pixel_has_a_word_of_its_own_in_its_regions_element(machine, seed):
    print("seed", seed)
    configuration = of(*machine)
    organisation = organisation_of(configuration)
    counts = np.random.default_rng(seed).integers(0, 99, organisation.regions.count)
    table = packed_table(counts, configuration.processing_elements, configuration.slots)
    dealt = organisation.dealt(table)
    y, x = np.mgrid[:configuration.height, :configuration.width]
    unit, word = dealt.unit(x, y), dealt.word(x, y)
    share = configuration.units // configuration.processing_elements
    assert (unit // share == table[dealt.regions.region(x, y)]).all()
    assert len(set(zip(unit.ravel().tolist(), word.ravel().tolist(), strict=True))) == x.size
    assert word.max() < dealt.words and unit.max() < configuration.units
    back = dealt.pixel(unit, word)
    assert (back[0] == x).all() and (back[1] == y).all()
    depths = np.arange(dealt.depths_read_back)
    image = dealt.depth_image(depths)
    assert (image == unit * dealt.words + word).all()
    assert organisation.dealt(None).table.tolist() == organisation.table.tolist()


def test_a_words_slot_is_how_many_lower_regions_its_element_has():
    configuration = of("2x(PM)", 8, 8, (4, 2), slots=5)
    dealt = organisation_of(configuration).dealt([1, 0, 1, 1, 0, 1, 0, 1])
    corners = [(2 * column, 4 * row) for row in range(2) for column in range(4)]
    assert [dealt.word(x, y) for x, y in corners] == [0, 0, 8, 16, 8, 24, 16, 32]
    assert [dealt.unit(x, y) for x, y in corners] == [1, 0, 1, 1, 0, 1, 0, 1]


@pytest.mark.parametrize(("cards", "slots", "fault"), [
    ("2x(PMM)", 3, None), ("PMMPM", 3, Fault.UNITS_UNSUPPORTED),
    ("MMPMM", 4, Fault.UNITS_UNSUPPORTED), ("PMMPMM", 2, None)])
def test_with_boards_pulled_out_it_draws_or_is_refused(cards, slots, fault):
    configuration = of(cards, 8, 8, (2, 2), slots=slots, allow_orphans=True)
    assert organisation_of(configuration).fault == fault
