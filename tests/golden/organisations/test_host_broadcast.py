"""Who draws, holds, shows and reads back each pixel of the cage of 1979."""

import numpy as np
import pytest
from counted_lists import list_of

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.specification.configuration import MachineConfiguration

CAGES = {
    "one of each": {"cards": "PM"},
    "equal shares": {"cards": "4x(PMM)"},
    "unequal shares": {"cards": "PMPMMPPMPMMMM"},
    "a share of blocks that grow": {"cards": "PMMMPMMMMM"},
    "squares": {"cards": "4x(PMM)", "block": 4},
    "skewed": {"cards": "2x(PMM)", "skew": True},
    "lines": {"cards": "4x(PMM)", "lines": True},
    "lines, one unit each": {"cards": "8x(PM)", "lines": True},
    "coarser": {"cards": "PMMPMM", "words": 20},
    "orphans": {"cards": "MMPMPM", "allow_orphans": True},
}


def cage(name, **changes):
    return MachineConfiguration(**{"width": 19, "height": 13, "fraction_bits": 16}
                                | CAGES[name] | changes)


@pytest.fixture(params=CAGES)
def organisation(request):
    return organisation_of(cage(request.param))


def pixels(organisation):
    y, x = np.mgrid[:organisation.resolution.height, :organisation.resolution.width]
    return x.ravel(), y.ravel()


def test_every_pixel_has_a_place_of_its_own(organisation):
    x, y = pixels(organisation)
    unit, word = organisation.unit(x, y), organisation.word(x, y)
    assert unit.min() >= 0 and unit.max() < organisation.units
    assert word.min() >= 0 and word.max() < organisation.words <= organisation.configuration.words
    assert len(set(zip(unit.tolist(), word.tolist(), strict=True))) == len(x)
    np.testing.assert_array_equal(organisation.pixel(unit, word), (x, y))


def test_one_node_draws_and_shows_everything(organisation):
    assert organisation.nodes == 1 and organisation.is_scanned(0) and not organisation.merges
    assert not organisation.shares(list_of(100)).node.any()


def test_domains_are_what_lies_right_of_each_processing_element(organisation):
    cards = organisation.configuration.cards
    owners, element = [], -1
    for card in cards:
        if card == "P":
            element += 1
        else:
            owners.append(element)
    assert organisation.owners.tolist() == [owners]
    assert len(organisation.domains) == cards.count("P")
    assert organisation.owned_units == sum(owner >= 0 for owner in owners)
    x, y = pixels(organisation)
    owned = np.array(owners)[organisation.unit(x, y)] >= 0
    np.testing.assert_array_equal(organisation.owned_pixels.ravel(), owned)


def test_the_read_back_is_every_owned_word_once(organisation):
    units, words = organisation.read_back
    owned = np.flatnonzero(organisation.owners[0] >= 0)
    assert list(zip(units.tolist(), words.tolist(), strict=True)) == [
        (unit, word) for unit in owned.tolist() for word in range(organisation.words)]
    # A depth goes where its pixel is; what nobody owns stays unknown.
    x, y = organisation.pixel(units, words)
    image = organisation.depth_image(1000 * y + x)
    wanted = 1000 * np.arange(image.shape[0])[:, np.newaxis] + np.arange(image.shape[1])
    np.testing.assert_array_equal(image, np.where(organisation.owned_pixels, wanted, -1))


def test_blocks_cut_up_what_their_elements_own(organisation):
    x, y = pixels(organisation)
    owner = organisation.owners[0][organisation.unit(x, y)]
    found = np.full(len(x), -1)
    for block in organisation.blocks:
        column, row = x >> block.square_bits, y >> block.square_bits
        offset = np.array([block.x_offset_of(index) for index in row.tolist()])
        inside = (((row - block.y_offset) & ((1 << block.y_bits) - 1)) == 0) & (
            ((column - offset) & ((1 << block.x_bits) - 1)) == 0)
        assert (found[inside] == -1).all(), "no pixel in two blocks"
        found[inside] = block.element
        units = organisation.unit(x[inside], y[inside])
        assert set(units.tolist()) <= set(range(organisation.units))
        assert len(set(units.tolist())) <= block.units
        line = y[inside] == y[inside][0]
        neighbours = units[line][np.argsort(x[inside][line])][:2]
        if len(neighbours) == 2:
            assert block.alternating == (neighbours[0] != neighbours[1])
    np.testing.assert_array_equal(found, owner)


def test_the_scan_tile_repeats_over_the_picture(organisation):
    tile, group = organisation.scan_tile, organisation.scan_group
    x, y = pixels(organisation)
    np.testing.assert_array_equal(organisation.unit(x, y),
                                  tile[y % tile.shape[0], x % tile.shape[1]])
    # The pixels of a group lie in different units.
    groups = tile.reshape(len(tile), -1, group)
    assert all(len(set(line)) == group for row in groups.tolist() for line in row)


def test_the_scan_shows_each_pixel_as_often_as_the_highest_resolution_has_it():
    organisation = organisation_of(cage("coarser"))
    assert organisation.resolution == (10, 7, 1, 1)
    picture = np.arange(70).reshape(7, 10)
    video = organisation.video(picture)
    assert video.shape == (13, 19)
    for x, y in ((0, 0), (18, 12), (7, 4)):
        column, row = organisation.video_pixel(x, y)
        assert video[y, x] == picture[row, column] == 10 * (y // 2) + x // 2


@pytest.mark.parametrize(("name", "changes", "refused"), [
    ("equal shares", {}, False), ("unequal shares", {}, False), ("orphans", {}, False),
    ("orphans", {"cards": "PMMM"}, True),
    ("squares", {"cards": "PMPMMM", "allow_orphans": True}, True),
])
def test_what_a_cage_refuses_at_boot(name, changes, refused):
    assert organisation_of(cage(name, **changes)).refused == refused
