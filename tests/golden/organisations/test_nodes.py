"""Cages of nodes: who draws, holds, shows and reads back what, and which of them draw nothing."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from counted_lists import list_of

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.organisations.shares import Shares
from cardcage.golden.organisations.snooped_nodes import SnoopedNodes
from cardcage.golden.specification.commands import Fault
from cardcage.golden.specification.configuration import MachineConfiguration

#: ``{merge}`` is the card that ends the nodes.
CAGES = {
    "four alike": {"cards": "4x(PMM{merge})"},
    "one node": {"cards": "PMM{merge}"},
    "nodes of several elements": {"cards": "2x(PMMPMM{merge})"},
    "cut up differently": {"cards": "PMMMM{merge} PMPMMM{merge} PPMMPMM{merge}"},
    "coarser": {"cards": "3x(PM{merge})", "words": 70},
    "squares": {"cards": "2x(PMMPMM{merge})", "block": 4},
    "orphans in one": {"cards": "PMM{merge} MPM{merge} PMM{merge}", "allow_orphans": True},
    "orphans in two": {"cards": "MPMMM{merge} MMPMM{merge}", "allow_orphans": True},
}
NAMES = {"C": "chain of nodes", "T": "tree of nodes", "S": "snooped bus of nodes"}


def cage(name, merge, **changes):
    fields = {"width": 19, "height": 13, "fraction_bits": 16} | CAGES[name] | changes
    cards = fields["cards"].format(merge=merge)
    if merge == "S":
        fields = {"tag_bits": 3} | fields
        cards += fields.pop("frame_units", "FF")
    return organisation_of(MachineConfiguration(**fields | {"cards": cards}))


@pytest.fixture(params=product(CAGES, NAMES), ids=" ".join)
def organisation(request):
    return cage(*request.param)


def pixels(organisation):
    y, x = np.mgrid[:organisation.resolution.height, :organisation.resolution.width]
    return x.ravel(), y.ravel()


def owners_by_hand(organisation):
    """Walk the backplane: units are numbered anew in each node, and belong to the last element
    passed in it, -1 to nobody."""
    owners, units, element, last = [], [], -1, -1
    for card in organisation.configuration.cards.rstrip("F"):
        if card == "P":
            element += 1
            last = element
        elif card == "M":
            units.append(last)
        else:
            owners.append(units)
            units, last = [], -1
    return owners


def test_its_name_and_what_it_merges(organisation):
    merge = organisation.configuration.merge
    assert organisation.name == NAMES[merge] and organisation.merges
    assert organisation.nodes == organisation.configuration.cards.count(merge)
    assert organisation.fault is None and not organisation.refused


def test_domains_are_numbered_in_their_nodes(organisation):
    owners = owners_by_hand(organisation)
    assert organisation.owners.tolist() == owners
    assert organisation.node_units == tuple(map(len, owners))
    assert organisation.owned_units == sum(owner >= 0 for units in owners for owner in units)
    assert len(organisation.domains) == organisation.configuration.cards.count("P")
    for element, (node, first, units) in enumerate(organisation.domains):
        assert owners[node][first:first + units] == [element] * units
    nodes = [domain.node for domain in organisation.domains]
    assert nodes == sorted(nodes) and set(nodes) == set(range(organisation.nodes))


def test_every_node_keeps_every_pixel_in_the_same_place(organisation):
    x, y = pixels(organisation)
    unit, word = organisation.unit(x, y), organisation.word(x, y)
    assert unit.max() < organisation.units and word.max() < organisation.words
    assert len(set(zip(unit.tolist(), word.tolist(), strict=True))) == len(x)
    np.testing.assert_array_equal(organisation.pixel(unit, word), (x, y))
    alone = organisation_of(MachineConfiguration(
        "P" + "M" * organisation.units, 19, 13, fraction_bits=16,
        words=organisation.configuration.words))
    assert organisation.resolution == alone.resolution
    if organisation.configuration.block == 1:
        np.testing.assert_array_equal(unit, alone.unit(x, y))
        np.testing.assert_array_equal(word, alone.word(x, y))


def test_a_pixel_is_owned_where_every_node_draws_it(organisation):
    x, y = pixels(organisation)
    unit = organisation.unit(x, y)
    owned = np.all([np.array(owners)[unit] >= 0 for owners in owners_by_hand(organisation)],
                   axis=0)
    np.testing.assert_array_equal(organisation.owned_pixels.ravel(), owned)
    assert owned.all() == (not organisation.configuration.allow_orphans)


def test_blocks_cut_up_what_each_node_owns(organisation):
    x, y = pixels(organisation)
    unit = organisation.unit(x, y)
    found = np.full((organisation.nodes, len(x)), -1)
    node_of = [domain.node for domain in organisation.domains]
    elements = [block.element for block in organisation.blocks]
    assert elements == sorted(elements)
    for block in organisation.blocks:
        column, row = x >> block.square_bits, y >> block.square_bits
        offset = np.array([block.x_offset_of(index) for index in row.tolist()])
        inside = (((row - block.y_offset) & ((1 << block.y_bits) - 1)) == 0) & (
            ((column - offset) & ((1 << block.x_bits) - 1)) == 0)
        of_node = found[node_of[block.element]]
        assert (of_node[inside] == -1).all(), "no pixel in two blocks of a node"
        of_node[inside] = block.element
    for node, owners in enumerate(owners_by_hand(organisation)):
        np.testing.assert_array_equal(found[node], np.array(owners)[unit])


def test_the_scan_tile_repeats_over_the_picture(organisation):
    tile, group = organisation.scan_tile, organisation.scan_group
    x, y = pixels(organisation)
    scanned = organisation
    if organisation.configuration.snoops:  # a cage of its frame units, at the nodes' resolution
        width, height, *_ = organisation.resolution
        scanned = organisation_of(MachineConfiguration("PMM", width, height, fraction_bits=16))
    np.testing.assert_array_equal(scanned.unit(x, y),
                                  tile[y % tile.shape[0], x % tile.shape[1]])
    reads = np.bincount(tile[0, ::group], minlength=scanned.units)
    assert reads.max() * -(-organisation.resolution.width // tile.shape[1]) >= (
        organisation.scan_reads_per_line) > 0


@pytest.mark.parametrize(("merge", "scanned"), [
    ("C", [True] * 3), ("T", [True, False, False]), ("S", [False] * 3)])
def test_which_nodes_are_scanned(merge, scanned):
    organisation = cage("cut up differently", merge)
    assert [organisation.is_scanned(node) for node in range(3)] == scanned


def known(organisation):
    """A depth for each pixel at the cage's resolution, all different."""
    width, height, *_ = organisation.resolution
    return 1000 * np.arange(height)[:, np.newaxis] + np.arange(width)


def read_back_by_hand(organisation, image):
    """What docs/command-words.md says comes back of a picture."""
    if organisation.configuration.merge == "C":
        return [image[y >> organisation.resolution.y_shift, x >> organisation.resolution.x_shift]
                for y in range(organisation.configuration.height)
                for x in range(organisation.configuration.width)]
    x, y = pixels(organisation)
    place = {(unit, word): image[row, column] for unit, word, column, row in zip(
        organisation.unit(x, y).tolist(), organisation.word(x, y).tolist(), x, y, strict=True)}
    padding = -5
    owners = owners_by_hand(organisation)

    def of_node(node, farther):
        return [place.get((unit, word), padding) + farther
                for unit, owner in enumerate(owners[node]) if owner >= 0
                for word in range(organisation.words)]

    if organisation.configuration.merge == "T":
        return of_node(0, 0)
    nearest = organisation.nodes // 2  # the others are farther everywhere
    return [depth for node in range(organisation.nodes)
            for depth in of_node(node, 7 * abs(node - nearest))]


def test_depths_go_where_their_pixels_are(organisation):
    image = known(organisation)
    depths = read_back_by_hand(organisation, image)
    assert len(depths) == organisation.depths_read_back
    read = organisation.depth_image(depths)
    assert read.dtype == np.int64
    np.testing.assert_array_equal(read, np.where(organisation.owned_pixels, image, -1))


@pytest.mark.parametrize("merge", NAMES)
def test_a_coarser_cage_shows_each_pixel_several_times(merge):
    organisation = cage("coarser", merge)
    assert organisation.resolution == (10, 7, 1, 1)
    # A chain is read by the scan's pixels, a tree by node 0's words, a bus by those of all.
    assert organisation.depths_read_back == {"C": 19 * 13, "T": 10 * 7, "S": 3 * 10 * 7}[merge]
    video = organisation.video(known(organisation))
    assert video.shape == (13, 19) and video[12, 18] == 6009
    assert organisation.video_pixel(18, 12) == (9, 6)


@pytest.mark.parametrize("merge", NAMES)
@pytest.mark.parametrize("packet", [1, 3, "contiguous"])
def test_shares_are_the_configurations(merge, packet):
    shares = cage("cut up differently", merge, packet=packet).shares(list_of(50))
    assert shares == Shares(nodes=3, triangles=50, packet=packet)


ORPHANS = {"allow_orphans": True, "words": 250}


@pytest.mark.parametrize("merge", NAMES)
@pytest.mark.parametrize(("fields", "fault"), [
    ({"cards": "PMM{merge} PMM{merge}"}, None),
    ({"cards": "PMM{merge} MPM{merge}"} | ORPHANS, None),
    ({"cards": "PMM{merge} PMMM{merge}"} | ORPHANS, Fault.UNITS_UNSUPPORTED),
    ({"cards": "PMMM{merge} PMMM{merge}"} | ORPHANS, Fault.UNITS_UNSUPPORTED),
    # Of both the number of units is told.
    ({"cards": "PMM{merge} PMMM{merge}"} | ORPHANS | {"words": 70}, Fault.UNITS_UNSUPPORTED),
    # Where the memory of the smaller node holds less of the picture.
    ({"cards": "PMM{merge} PM{merge}"} | ORPHANS | {"words": 130}, Fault.NODES_DIFFER),
    # In squares every element must have as many units as the cards were built for.
    ({"cards": "2x(PMM){merge} PMMMM{merge}", "block": 4} | ORPHANS, Fault.UNITS_UNSUPPORTED),
    ({"cards": "2x(PMM){merge} PMMMM{merge}"} | ORPHANS, None),
])
def test_which_cages_draw_nothing(merge, fields, fault):
    organisation = cage("four alike", merge, **fields)
    assert organisation.fault == fault
    assert organisation.refused == (fault is not None)
    assert [domain.node for domain in organisation.domains] == [
        node for node, cards in enumerate(organisation.configuration.node_cards)
        for card in cards if card == "P"]


def test_steps_of_merging():
    assert [cage("cut up differently", merge).merge_steps for merge in "CTS"] == [0, 2, 3]
    assert [cage("one node", merge).merge_steps for merge in "CTS"] == [0, 0, 1]


@pytest.mark.parametrize(("frame_units", "fault"), [
    ("F", None), ("FF", None), ("FFF", Fault.UNITS_UNSUPPORTED), ("FFFF", None),
    ("FFFFFF", Fault.UNITS_UNSUPPORTED)])
def test_frame_units_that_cannot_be(frame_units, fault):
    for name in ("four alike", "coarser"):
        assert cage(name, "S", allow_orphans=True, frame_units=frame_units).fault == fault
    # Of what is wrong with nodes and with frame units the number of these is told.
    differ = cage("four alike", "S", cards="PMM{merge} PM{merge}", words=130, allow_orphans=True,
                  frame_units=frame_units)
    assert differ.fault == (fault or Fault.NODES_DIFFER)


def test_frame_units_that_do_not_hold_the_picture():
    """As if such boards had been put in: those of the configuration hold all of it."""
    for words, own, fault in ((0, 133, None), (0, 132, Fault.UNITS_UNSUPPORTED),
                              (70, 40, None), (70, 39, Fault.UNITS_UNSUPPORTED)):
        configuration = MachineConfiguration("3x(PMS)FF", 19, 13, fraction_bits=16, words=words)
        assert configuration.frame.words == 133
        vars(configuration)["frame"] = replace(configuration.frame, words=own)
        assert SnoopedNodes(configuration).fault == fault
