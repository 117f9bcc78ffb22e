"""The configuration of a machine: what it derives, what it refuses, the presets."""

from dataclasses import replace

import pytest

from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.ranges import MAXIMUM_WORDS
from cardcage.golden.specification.video_timing import STANDARD_TIMINGS, VideoTiming, compact_timing

GOOD = {"cards": "PMMPMM", "width": 16, "height": 8}


@pytest.mark.parametrize(("field", "values"), {
    "width": [0, -1, 4097, 1.5, "16", None],
    "height": [0, -8, 4097, 8.0],
    "sub_bits": [0, 9, -1],
    "depth_bits": [1, 33, 0],
    "fraction_bits": [-1, 65, 2.0, "exact"],
    "words": [-1, MAXIMUM_WORDS + 1],
    "maximum_units": [-1, 3, 4097],
    "fifo_depth": [0, 1, 4097],
    "block": [0, -1, 3, 12, 33, 64, 2.0],
    "clocks_per_pixel": [0, 1, 257],
    "shading": ["phong", "", None],
    "cards": ["", "P", "M", "MPM", "PMMM", "PMZ", "2x(PM"],
    "timing": [compact_timing(8, 16), compact_timing(16, 9)],
    "coordinate_bits": [-1, 15, 7.0],
    "edge_column_bits": [-1, 8],
    "edge_height_bits": [-1, 15],
    "edge_fraction_bits": [-1, 18],
    "depth_integer_bits": [-1, 65, None],
    "channel_integer_bits": [-1, 65],
}.items())
def test_bad_fields(field, values):
    for value in values:
        with pytest.raises(InputError, match=field.split("_")[0]) as raised:
            MachineConfiguration(**GOOD | {field: value})
        assert "\n" not in str(raised.value)


@pytest.mark.parametrize(("field", "values"), {
    "width": [1, 4096], "height": [1, 4096], "sub_bits": [1, 8], "depth_bits": [2, 32],
    "fraction_bits": [0, 64], "words": [1, MAXIMUM_WORDS], "maximum_units": [4, 4096],
    "fifo_depth": [2, 4096], "block": [1, 32], "clocks_per_pixel": [2, 256],
    "shading": ["flat", "gouraud"],
}.items())
def test_the_ends_of_every_range(field, values):
    for value in values:
        changes = {field: value}
        if field in ("width", "height"):
            changes["words"] = 64
        assert getattr(MachineConfiguration(**GOOD | changes), field) == value


def test_a_picture_larger_than_the_memory_of_the_units():
    with pytest.raises(InputError, match=r"size: 4096x4096 needs .* words"):
        MachineConfiguration("PM", 4096, 4096)
    # With the words said it is drawn coarser instead.
    assert MachineConfiguration("PM", 4096, 4096, words=MAXIMUM_WORDS).interlace.width == 1024


def test_what_follows_from_the_cards():
    configuration = MachineConfiguration("2x(P 2xM)", 16, 9)
    assert configuration.cards == "PMMPMM"
    assert (configuration.units, configuration.processing_elements) == (4, 2)
    assert configuration.words == 8 * 5
    assert configuration.maximum_units == 4
    # The total itself must fit the lines.
    assert configuration.id_bits == 3
    assert (configuration.x_bits, configuration.y_bits) == (5, 4)
    assert configuration.address_bits == 6
    assert configuration.timing == compact_timing(16, 9)
    assert configuration.cycles_per_scan == 20 * 12 * 4
    assert configuration.depth_background == 2**24 - 1


def test_the_most_units_widen_the_lines_only():
    configuration = MachineConfiguration("PM", 16, 8, words=16, maximum_units=16)
    assert configuration.id_bits == 5
    assert [interlace.units for interlace in configuration.interlaces()] == [1, 2, 4, 8, 16]
    assert [interlace.words <= 16 for interlace in configuration.interlaces()] == [True] * 5
    assert configuration.interlace == configuration.interlaces()[0]
    assert MachineConfiguration("PM", 1, 1, maximum_units=7).id_bits == 3
    assert [interlace.units for interlace in
            MachineConfiguration("PM", 4, 4, maximum_units=7).interlaces()] == [1, 2, 4]


def test_squares_follow_the_cards():
    configuration = MachineConfiguration("4x(PMM)", 32, 32, block=8)
    assert (configuration.square_bits, configuration.share_bits) == (3, 1)
    assert configuration.interlace.bit_order == (("x", 3), ("y", 3), ("x", 0))
    assert configuration.words == 16 * 16 / 2
    assert (configuration.interlace.pitch, MachineConfiguration("4x(PMM)", 32, 32).interlace.pitch
            ) == (8, 16)
    # A cage must hold one processing element's share at least.
    more = MachineConfiguration("PMM", 32, 32, block=8, maximum_units=8)
    assert [interlace.units for interlace in more.interlaces()] == [2, 4, 8]
    # Pixel by pixel a share does not matter.
    assert MachineConfiguration("4x(PMM)", 32, 32).share_bits == 0


@pytest.mark.parametrize(("cards", "block", "message"), [
    ("PMMMPM", 4, "want as many memory units behind each processing element, not 1 and 3; change"),
    ("PPMM", 4, "not 0 and 2"),
    ("PMMMMMMMM", 2, "squares of 2x2 pixels do not spread over 8 memory units; make them larger"),
    ("PM", 6, "must be a power of two, such as 1, 4 or 32, not 6"),
])
def test_squares_want_equal_shares(cards, block, message):
    with pytest.raises(InputError, match=f"^block: .*{message}"):
        MachineConfiguration(cards, 16, 16, block=block)
    assert MachineConfiguration(cards, 16, 16).block == 1


def test_squares_are_not_skewed():
    with pytest.raises(InputError, match=r"^skew: in squares of 4x4 pixels .* leave it out"):
        MachineConfiguration("2x(PMM)", 16, 16, block=4, skew=True)
    skewed = MachineConfiguration("2x(PMM)", 16, 16, skew=True)
    assert skewed.interlace.skew_bit == 1
    assert [interlace.skew_bit for interlace in skewed.interlaces()] == [None, 0, 1]


def test_lines_follow_the_cards():
    configuration = MachineConfiguration("4x(PMM)", 32, 32, lines=True)
    assert configuration.share_bits == 1 and configuration.aligned_domains
    assert configuration.interlace.bit_order == (("y", 1), ("y", 0), ("x", 0))
    more = MachineConfiguration("PMM", 32, 32, lines=True, maximum_units=8)
    assert [interlace.units for interlace in more.interlaces()] == [2, 4, 8]


@pytest.mark.parametrize(("fields", "message"), [
    ({"cards": "PMMPM PM"}, "lines: .* want as many memory units each, not 1 and 2; change"),
    ({"cards": "3x(PMM)"}, "lines: 3 processing elements .* --regions 1x16$"),
    ({"cards": "6x(PM)", "height": 1025}, "lines: 6 .*; take a power of two, such as 4 or 8$"),
    ({"block": 2}, "block: .*; leave it out, or leave out lines"),
    ({"skew": True}, "skew: .*; leave it out, or leave out lines"),
    ({"regions": (1, 16)}, "lines: is settled by the regions"),
    ({"cards": "2xPD2xM"}, "lines: behind a direct merge .* leave it out"),
])
def test_lines_want_equal_shares_and_nothing_else(fields, message):
    with pytest.raises(InputError, match=f"^{message}") as raised:
        MachineConfiguration(**{"cards": "2x(PMM)", "width": 16, "height": 16, "lines": True}
                             | fields)
    assert "\n" not in str(raised.value)


def test_one_word_still_has_an_address():
    assert MachineConfiguration("PM", 1, 1).words == 1
    assert MachineConfiguration("PM", 1, 1).address_bits == 1


def test_orphans_only_on_request():
    with pytest.raises(InputError, match="nobody"):
        MachineConfiguration("MPM", 4, 4)
    assert MachineConfiguration("MPM", 4, 4, allow_orphans=True).units == 2


def test_timing_of_the_size():
    assert MachineConfiguration("PM", 640, 480).timing == STANDARD_TIMINGS[640, 480]
    own = VideoTiming(8, 1, 2, 3, 4, 5, 6, 7)
    assert MachineConfiguration("PM", 8, 4, timing=own).timing is own


def test_widths_hold_the_precision_contract():
    """Coordinates with their guard band, carried words with two guard bits at least."""
    configuration = MachineConfiguration("PM", 512, 512, fraction_bits=9)
    assert configuration.coordinate_bits == 9 + 2 + 8
    assert configuration.edge_column_bits == 9 + 2 + 1
    assert configuration.edge_height_bits == 19
    assert configuration.depth_plane_bits == 24 + 2 + 9
    assert configuration.channel_plane_bits >= 8 + 2 + 9
    # From 2**F > 2 * 1023 on values stay where they are: no guard, no sign.
    for fraction_bits, guard in ((10, 2), (11, 0), (40, 0)):
        finer = replace(configuration, fraction_bits=fraction_bits)
        assert finer.stays_in_range == (guard == 0)
        assert finer.depth_plane_bits == 24 + guard + fraction_bits
        assert finer.channel_plane_bits == 8 + guard + fraction_bits
    assert not configuration.edges_on_screen
    assert replace(configuration, edge_column_bits=10).edges_on_screen
    assert not replace(configuration, edge_column_bits=11).edges_on_screen


@pytest.mark.parametrize("formats", [
    {"width": 16, "height": 16}, {"width": 97, "height": 61, "sub_bits": 3},
    {"width": 1, "height": 1}, {"width": 4096, "height": 4096, "words": 64}])
def test_default_fraction_bits_are_for_the_largest_triangle_on_the_screen(formats):
    machine = MachineConfiguration("PM", **formats)
    width, height = machine.width << machine.sub_bits, machine.height << machine.sub_bits
    reach = machine.width + machine.height - 2
    assert machine.fraction_bits == (width * height * (1 + reach)).bit_length()
    assert machine == MachineConfiguration("PM", **formats, fraction_bits=None)
    assert machine == MachineConfiguration("PM", **formats, fraction_bits=machine.fraction_bits)
    # It is a number from then on, which a change of other fields keeps.
    assert replace(machine, depth_bits=9).fraction_bits == machine.fraction_bits


def test_narrower_words():
    """Each follows what it is told; what it is not told holds every triangle."""
    wide = MachineConfiguration(**GOOD, fraction_bits=16)
    assert (wide.coordinate_bits, wide.edge_column_bits, wide.edge_height_bits) == (14, 7, 14)
    assert wide.edge_fraction_bits == 17  # 16383 * 8 < 2**17
    narrow = MachineConfiguration(**GOOD, fraction_bits=16, edge_height_bits=5,
                                  depth_integer_bits=9, channel_integer_bits=3)
    assert narrow.edge_fraction_bits == 8  # 31 * 8 < 2**8
    assert narrow.edge_word_bits == 7 + 8
    assert (narrow.depth_plane_bits, narrow.channel_plane_bits) == (9 + 16, 3 + 16)
    assert replace(narrow, fraction_bits=2).depth_plane_bits == 9 + 2
    assert replace(wide, fraction_bits=2).depth_plane_bits < wide.depth_plane_bits


@pytest.mark.parametrize(("fields", "message"), [
    ({"cards": "PMCPMT"}, r"^cards: .*C \(chain merge\) and T \(tree merge\) .*; take merge cards"),
    ({"cards": "PMCPM"}, r"^cards: .*the last node is not ended; put C \(chain merge\)"),
    ({"cards": "PMCPMMC"}, "^cards: nodes of 1 and 2 memory units .*; give all nodes as many"),
    ({"cards": "65x(PMT)"}, "^cards: 65 nodes, at most 64; take fewer, with more"),
    ({"packet": 0}, "^packet: 0 is not a whole number from 1 to [0-9]+, nor contiguous, nor work$"),
    ({"packet": "most"}, "^packet: 'most' is not a whole .* [0-9]+, nor contiguous, nor work$"),
    ({"order_bits": 17}, "^order_bits: 17 is not a whole number from 0 to 16$"),
    ({"list_words": -1}, "^list_words: -1 is not a whole number from 0 to 1048576$"),
    ({"maximum_nodes": 2}, "^maximum_nodes: the node lines carry 2, the cage holds 3 nodes; leave"),
    ({"maximum_nodes": 65}, "^maximum_nodes: 65 is not a whole number from 0 to 64$"),
    *(({"cards": "PMPM", name: 4},
       f"^{name}: 4 is for cages of nodes, and PMPM has no merge card; end its nodes with one, "
       r"as in 2x\(PMMC\), or leave it out$")
      for name in ("order_bits", "list_words", "maximum_nodes")),
    ({"cards": "3x(PMS)F", "tag_bits": 2}, "^tag_bits: 2 is too few where a picture .*; take 3"),
    ({"cards": "PPPDMM", "order_bits": 1}, "^order_bits: 1 does not hold .* 3 nodes; take 2 at le"),
    ({"cards": "PPPDMM", "queue": 5}, "^queue: 5 is not a whole number from 2 to 4, nor element$"),
    ({"cards": "PPPDMM", "queue": "none"}, "^queue: 'none' is not a whole .*, nor element$"),
    ({"cards": "PPPDMM", "skew": True}, "^skew: behind a direct merge .*; leave it out$"),
    ({"cards": "PPPDMM", "block": 4}, "^block: behind a direct merge .*; leave it out$"),
])
def test_nodes_that_are_refused(fields, message):
    with pytest.raises(InputError, match=message) as raised:
        MachineConfiguration(**{"cards": "3x(PMC)", "width": 16, "height": 8} | fields)
    assert "\n" not in str(raised.value)


def test_what_follows_from_nodes():
    machine = MachineConfiguration("4x(PMMC)", 16, 8)
    assert (machine.merge, machine.nodes, machine.node_cards) == ("C", 4, ["PMM"] * 4)
    # Each node holds the whole picture, and its elements are numbered in it.
    assert (machine.units, machine.maximum_units, machine.words) == (2, 2, 64)
    assert (machine.processing_elements, machine.maximum_nodes) == (4, 4)
    # The total itself must fit the lines.
    assert machine.node_bits == 3
    assert MachineConfiguration("PMMC", 16, 8, maximum_nodes=64).node_bits == 7
    assert MachineConfiguration("64x(PMT)", 16, 8).nodes == 64
    # A pixel keeps its round beside the depth, unless nobody asks for it.
    assert (machine.order_bits, machine.rank_bits) == (16, 24 + 16)
    for fields in ({"packet": "contiguous"}, {"cards": "PMMC"}, {"order_bits": 0}):
        free = MachineConfiguration(**{"cards": "4x(PMMC)", "width": 16, "height": 8} | fields)
        assert (free.order_bits, free.rank_bits) == (0, 24)
    alone = MachineConfiguration("PMM", 16, 8)
    assert (alone.merge, alone.nodes, alone.node_bits, alone.order_bits) == (None, 1, 0, 0)


def test_what_follows_from_snooping():
    machine = MachineConfiguration("3x(PMMS)FFFF", 20, 8)
    assert (machine.nodes, machine.units, machine.frame_units) == (3, 2, 4)
    assert (machine.words, machine.frame.units, machine.frame.words) == (80, 4, 40)
    assert machine.frame.interlace.width == 20 and machine.id_bits == 3
    assert machine.snoops and machine.keeps_two_depths and not machine.scans_rank


def test_what_follows_from_a_direct_merge():
    machine = MachineConfiguration("5x(P)D8x(M)", 20, 8)
    assert (machine.nodes, machine.units, machine.processing_elements) == (5, 8, 5)
    assert (machine.words, machine.interlace.diagonal) == (3 * 8, True)
    # An order is the round and, below it, the node.
    assert (machine.order_bits, machine.node_order_bits, machine.round_bits) == (16, 3, 13)
    once = MachineConfiguration("5x(P)D8x(M)", 20, 8, packet="contiguous")
    assert (once.order_bits, once.round_bits) == (3, 0)
    free = MachineConfiguration("5x(P)D8x(M)", 20, 8, order_bits=0)
    assert (free.rank_bits, free.round_bits) == (24, 0)


def test_presets():
    assert set(PRESETS) == {"tiny", "small", "paper"}
    paper = MachineConfiguration(**PRESETS["paper"])
    assert (paper.processing_elements, paper.units, paper.width, paper.height) == (4, 16, 512, 512)
    assert paper.cards == "PMMMM" * 4
    assert MachineConfiguration(**PRESETS["tiny"]).units == 1
    assert MachineConfiguration(**PRESETS["small"], fifo_depth=3).fifo_depth == 3


def test_it_is_frozen():
    with pytest.raises(AttributeError):
        MachineConfiguration(**GOOD).width = 3
