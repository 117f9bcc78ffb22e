"""The cage whose elements have no pixels: all of them draw everywhere, into one picture."""

import numpy as np
import pytest
from counted_lists import list_of

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.specification.commands import Fault
from cardcage.golden.specification.configuration import MachineConfiguration

CAGES = {
    "four for four": {"cards": "PPPPDMMMM"},
    "one of each": {"cards": "PDM"},
    "three for eight": {"cards": "3xP D 8xM"},
    "five for one": {"cards": "5xP D M"},
    "coarser": {"cards": "PPDMM", "words": 50},
}


def cage(name, **changes):
    return organisation_of(MachineConfiguration(
        **{"width": 19, "height": 13, "fraction_bits": 16} | CAGES[name] | changes))


@pytest.fixture(params=CAGES)
def organisation(request):
    return cage(request.param)


def pixels(organisation):
    y, x = np.mgrid[:organisation.resolution.height, :organisation.resolution.width]
    return x.ravel(), y.ravel()


def test_who_draws_where(organisation):
    cards = organisation.configuration.cards
    elements, units = cards.count("P"), cards.count("M")
    assert organisation.name == "direct" and organisation.merges
    assert organisation.fault is None and organisation.merge_steps == 0
    assert (organisation.nodes, organisation.units) == (elements, units)
    assert (organisation.memory_units, organisation.owned_units) == (units, units)
    assert organisation.node_units == (units,) * elements
    assert list(organisation.domains) == [(node, 0, units) for node in range(elements)]
    assert organisation.owners.tolist() == [[node] * units for node in range(elements)]
    assert organisation.owned_pixels.all()
    assert all(organisation.is_scanned(node) for node in range(elements))
    assert organisation.shares(list_of(50)) == Shares(elements, 50, 1)


def test_every_element_walks_the_whole_screen(organisation):
    assert [block.element for block in organisation.blocks] == list(range(organisation.nodes))
    for block in organisation.blocks:
        assert block[1:8] == (0, 0, 0, 0, 0, 0, False) and block.units == organisation.units
        assert block.alternating == (organisation.units > 1)


def test_each_is_such_a_cage_of_one_element(organisation):
    assert len(organisation.each) == organisation.nodes
    for alone in organisation.each:
        assert alone.configuration.cards == "PD" + "M" * organisation.units
        assert alone.blocks == organisation.blocks[:1]
        assert alone.domains == organisation.domains[:1]
        assert alone.resolution == organisation.resolution
        np.testing.assert_array_equal(alone.scan_tile, organisation.scan_tile)


def test_neighbours_lie_in_different_units_and_rows_begin_at_others(organisation):
    x, y = pixels(organisation)
    unit, word = organisation.unit(x, y), organisation.word(x, y)
    assert len(set(zip(unit.tolist(), word.tolist(), strict=True))) == len(x)
    assert word.max() < organisation.words
    np.testing.assert_array_equal(organisation.pixel(unit, word), (x, y))
    np.testing.assert_array_equal(
        unit, (x + organisation.configuration.interlace.diagonal_step * y) % organisation.units)
    tile, group = organisation.scan_tile, organisation.scan_group
    np.testing.assert_array_equal(unit, tile[y % len(tile), x % tile.shape[1]])
    assert group == organisation.units  # a unit reads once for so many pixels
    assert organisation.scan_reads_per_line == -(-organisation.resolution.width // group)


def test_depths_go_where_their_pixels_are(organisation):
    width, height, *_ = organisation.resolution
    image = 1000 * np.arange(height)[:, np.newaxis] + np.arange(width)
    x, y = pixels(organisation)
    place = dict(zip(zip(organisation.unit(x, y).tolist(), organisation.word(x, y).tolist(),
                         strict=True), image.ravel().tolist(), strict=True))
    depths = [place.get((unit, word), -5) for unit in range(organisation.units)
              for word in range(organisation.words)]
    assert organisation.depths_read_back == len(depths)
    np.testing.assert_array_equal(organisation.depth_image(depths), image)


def test_a_number_of_units_that_cannot_be():
    """As where boards have been pulled out."""
    three = {"cards": "PPDMMM", "allow_orphans": True, "words": 130}
    assert cage("four for four", **three).fault == Fault.UNITS_UNSUPPORTED
