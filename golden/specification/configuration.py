"""The configuration of one machine: every number that its hardware is built from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal

from .card_order import MAXIMUM_NODES, PROCESSING_ELEMENT, check_cards, check_merging, parse_cards
from .display_list import Shading, coordinate_bits
from .errors import InputError
from .fields.dealing import DealingFields
from .fields.making import NO_OBJECTS, MakingFields, Objects
from .fixed_point import MAX_FRACTION_BITS, on_screen_fraction_bits
from .interlace import (
    MAXIMUM_BLOCK,
    Interlace,
    check_diagonal,
    check_lines,
    check_squares,
    interlace_for,
)
from .ranges import FORMAT_RANGES, MAXIMUM_SIZE, MAXIMUM_WORDS, check_whole
from .regions import Balance, Balancer, RegionedPicture
from .video_timing import VideoTiming, video_timing
from .widths import edge_column_bits, edge_fraction_bits, edge_height_bits

MAXIMUM_SETUP_INTERVAL = 256  # more than any division has steps
MINIMUM_TAG_BITS = 2  # the pictures shown and drawn, the next one, and none
MAXIMUM_TAG_BITS = 6
SNOOP_TAG_BITS = 3  # the least where a picture is merged as well
MAXIMUM_ORDER_BITS = 16  # 65,536 rounds of a packet for each node

#: Triangles in a packet, or one packet for each node: of as many triangles, or of as much work.
Packet = int | Literal["contiguous", "work"]
ONE_PACKET_EACH = ("contiguous", "work")
MAXIMUM_PACKET = (1 << 31) - 1

#: Fragments that can wait from a processing element to each memory unit, or one queue for all.
Queue = int | Literal["element"]
QUEUE_RANGE = (2, 4)

#: Field → least and greatest value, besides ``FORMAT_RANGES``, where they depend on no other field.
RANGES = {
    "fraction_bits": (0, MAX_FRACTION_BITS),
    "words": (0, MAXIMUM_WORDS),
    "maximum_units": (0, MAXIMUM_SIZE),
    "fifo_depth": (2, 4096),
    "block": (1, MAXIMUM_BLOCK),
    "memory_ports": (1, 2),
    "tag_bits": (MINIMUM_TAG_BITS, MAXIMUM_TAG_BITS),
    "clocks_per_pixel": (2, 256),
    "setup_interval": (1, MAXIMUM_SETUP_INTERVAL),
    "depth_integer_bits": (0, 64),
    "channel_integer_bits": (0, 64),
    "maximum_nodes": (0, MAXIMUM_NODES),
    "order_bits": (0, MAXIMUM_ORDER_BITS),
    "list_words": (0, MAXIMUM_WORDS),
}


@dataclass(frozen=True)
class MachineConfiguration(MakingFields, DealingFields):
    """What the cards are built for.

    ``cards``             card order, left to right, spelled out or as ``4x(PMM)``
    ``width``, ``height`` the highest resolution, which commands and scan addresses use
    ``sub_bits``          sub-pixel bits of a vertex coordinate
    ``depth_bits``        bits of a stored depth
    ``fraction_bits``     fraction bits of the interpolants; None means as many as make every
                          triangle exact that has all its vertices on the screen
    ``shading``           ``"flat"`` builds no colour interpolators
    ``words``             words of each memory unit; 0 means what ``width`` by ``height`` needs
    ``maximum_units``     the largest number the ID lines carry; 0 means what a node of ``cards``
                          holds
    ``fifo_depth``        primitives a processing element can hold in waiting
    ``block``             side of the squares of pixels in which processing elements interlace, a
                          power of two; 1 interlaces all memory units pixel by pixel
    ``skew``              interlaced pixel by pixel, two units of a processing element alternate
                          along its rows, not only from row to row
    ``lines``             processing elements have whole lines in turn: of n elements element i has
                          the lines i, n + i and so on
    ``memory_ports``      of a memory unit: 1, shared by all, or 2, as FPGAs have them
    ``tag_bits``          of the frame's tag beside each depth and colour, which spares the clear
    ``clocks_per_pixel``  clocks a pixel lasts on the video output; one of them is the scan's slot
    ``timing``            blanking and sync of a scan; None means the standard one for the size
    ``allow_orphans``     accept memory units left of every processing element
    ``setup``             ``"host"``: the host sends prepared triangles; ``"hardware"``: the
                          controller also takes vertices and prepares them itself
    ``setup_interval``    clocks that set-up in hardware may take for a division: 1 is a stage for
                          each step, ``MAXIMUM_SETUP_INTERVAL`` one stage for all
    ``observe``           the machine also says, in each clock, what every processing element does

    Where there are nodes, that each draw a share of the triangles:

    ``packet``         triangles that follow one another in the list and go to one node; 1 is round
                       robin, ``"contiguous"`` gives each node one run of the list, of as many
                       triangles, ``"work"`` one of as much work (``organisations.shares``)
    ``order_bits``     beside a pixel's depth, which keep ties between nodes in the list's order:
                       its round, and where fragments meet in memory its node below it.  None means
                       as many as any list may need: for contiguous shares there are no rounds
    ``list_words``     triangles that the list memory of each node holds; 0 builds none
    ``maximum_nodes``  the largest number the node lines carry; 0 means what ``cards`` holds
    ``queue``          where nodes merge directly: fragments that can wait from each processing
                       element to each memory unit, or ``"element"``: one queue for all of them

    Where regions of the screen are dealt out to the processing elements of one node:

    ``regions``   columns and rows of them (``Regions``); None interlaces pixels instead
    ``slots``     regions that each processing element has room for; 0 means a quarter more than an
                  even share, or that share where ``objects`` are made in elements
    ``balance``   what a processing element counts of each of its regions, for the next picture's
                  table: ``"triangles"``, ``"clocks"``, or with ``"static"`` nothing
    ``balancer``  who makes that table of the counts: ``"host"``, or the controller, ``"hardware"``

    Where the host sends objects, which are meshes that the machine has, moved:

    ``objects``         where meshes are kept and an object's triangles are made (``Objects``); None
                        takes triangles only
    ``mesh_triangles``  triangles of all meshes that a mesh memory holds
    ``meshes``          how many meshes it can tell apart

    The rest is for a machine that is to draw less than every triangle of the guard band;
    ``plan`` says what a scene needs.  Where they are 0, every triangle fits.

    ``coordinate_bits``      of a signed vertex coordinate
    ``edge_column_bits``     of a column on an edge's own rows; signed, where there are more than
                             a column of the screen needs
    ``edge_height_bits``     of an edge's height, in sub-pixel units
    ``edge_fraction_bits``   of a carried edge: as many as make its column exact on every row
    ``depth_integer_bits``   of carried depth, its sign included where it has one
    ``channel_integer_bits`` of a carried colour channel, likewise

    Raises ``InputError`` where a number is out of range or the cards do not make a machine.

    >>> import cardcage
    >>> machine = cardcage.MachineConfiguration(cards="2x(PMM)", width=64, height=64)
    >>> machine.cards, machine.units, machine.words
    ('PMMPMM', 4, 1024)
    """

    cards: str
    width: int
    height: int
    sub_bits: int = 8
    depth_bits: int = 24
    fraction_bits: int = field(default=None)  # type: ignore[assignment]
    shading: Shading = "gouraud"
    words: int = 0
    maximum_units: int = 0
    fifo_depth: int = 16
    block: int = 1
    skew: bool = False
    lines: bool = False
    memory_ports: int = 1
    tag_bits: int = 4
    clocks_per_pixel: int = 4
    timing: VideoTiming = field(default=None)  # type: ignore[assignment]
    allow_orphans: bool = False
    setup: Literal["host", "hardware"] = "host"
    setup_interval: int = 1
    observe: bool = False
    coordinate_bits: int = 0
    edge_column_bits: int = 0
    edge_height_bits: int = 0
    edge_fraction_bits: int = 0
    depth_integer_bits: int = 0
    channel_integer_bits: int = 0
    packet: Packet = 1
    order_bits: int = field(default=None)  # type: ignore[assignment]
    list_words: int = 0
    maximum_nodes: int = 0
    queue: Queue = 4
    regions: tuple[int, int] | None = None
    slots: int = 0
    balance: Balance = "clocks"
    balancer: Balancer = "host"
    objects: Objects | None = None
    mesh_triangles: int = 0
    meshes: int = 0

    def __post_init__(self) -> None:
        def fix(name: str, value: Any) -> None:
            object.__setattr__(self, name, value)

        if not isinstance(self.cards, str):
            raise InputError(f"cards: {self.cards!r} is no card order; write one such as 2x(PMM)")
        fix("cards", parse_cards(self.cards))
        for name, low, high in FORMAT_RANGES:
            check_whole(name, getattr(self, name), low, high)
        if self.fraction_bits is None:
            fix("fraction_bits", on_screen_fraction_bits(self.width, self.height, self.sub_bits))
        self._check_packet()
        check_merging(self.cards)
        if self.maximum_nodes == 0:
            fix("maximum_nodes", self.nodes)
        if self.order_bits is None:
            shared = self.keeps_list_order or (
                self.nodes > 1 and self.packet not in ONE_PACKET_EACH)
            fix("order_bits", MAXIMUM_ORDER_BITS if shared else self.node_order_bits)
        for name, (low, high) in RANGES.items():
            check_whole(name, getattr(self, name), low, high)
        if self.shading not in ("flat", "gouraud"):
            raise InputError(f"shading: {self.shading!r} is neither flat nor gouraud")
        if self.setup not in ("host", "hardware"):
            raise InputError(f"setup: {self.setup!r} is neither host nor hardware")
        for name, most in self._widest().items():
            check_whole(name, getattr(self, name), 0, most)
            fix(name, getattr(self, name) or most)
        most = edge_fraction_bits(self.edge_height_bits, self.height)
        check_whole("edge_fraction_bits", self.edge_fraction_bits, 0, most)
        fix("edge_fraction_bits", self.edge_fraction_bits or most)
        if self.lines and not self.merges_directly:
            check_lines(self.node_cards[0].count(PROCESSING_ELEMENT), self.shares_of_units,
                        self.height, block=self.block, skew=self.skew, orphans=self.allow_orphans)
        if not self.allow_orphans:
            check_cards(self.cards, dealt=self.regions is not None)
        self._check_nodes()
        check_squares(self.block, self.shares_of_units, skew=self.skew,
                      orphans=self.allow_orphans)
        if self.merges_directly:
            check_diagonal(self.block, skew=self.skew, lines=self.lines)
        if self.regions is not None:
            fix("slots", self._check_regions())
            fix("words", self.slots << self.slot_bits)
        self._check_dealing()
        self._check_objects()
        if not self.words:
            full = Interlace(self.units.bit_length() - 1, self.width, self.height,
                             square_bits=self.square_bits, share_bits=self.share_bits,
                             skew=self.skew, diagonal=self.merges_directly, lines=self.lines)
            if full.words > MAXIMUM_WORDS:
                raise InputError(f"size: {self.width}x{self.height} needs {full.words} words in "
                                 f"each of {self.units} memory units, at most {MAXIMUM_WORDS}; "
                                 "add memory units or make the picture smaller")
            fix("words", full.words)
        if not self.maximum_units:
            fix("maximum_units", self.units)
        if self.maximum_units < self.units:
            raise InputError(f"maximum_units: the ID lines carry {self.maximum_units}, the cage "
                             f"holds {self.units} memory units")
        if self.timing is None:
            fix("timing", video_timing(self.width, self.height))
        if (self.timing.horizontal_active, self.timing.vertical_active) != (self.width,
                                                                            self.height):
            raise InputError(f"timing: shows {self.timing.horizontal_active}x"
                             f"{self.timing.vertical_active}, the machine draws "
                             f"{self.width}x{self.height}")

    def _check_packet(self) -> None:
        if self.packet in ONE_PACKET_EACH:
            return
        try:
            check_whole("packet", self.packet, 1, MAXIMUM_PACKET)
        except InputError as error:
            raise InputError(f"{error}, nor contiguous, nor work") from None

    def _check_nodes(self) -> None:
        if not self.nodes <= self.maximum_nodes:
            raise InputError(f"maximum_nodes: the node lines carry {self.maximum_nodes}, the cage "
                             f"holds {self.nodes} nodes; leave it out, or take {self.nodes}")
        if self.merge is None:
            for name, least in (("list_words", 0), ("order_bits", 0), ("maximum_nodes", 1)):
                if name == "order_bits" and self.keeps_list_order:
                    continue
                if getattr(self, name) != least:
                    raise InputError(f"{name}: {getattr(self, name)} is for cages of nodes, and "
                                     f"{self.cards} has no merge card; end its nodes with one, as "
                                     "in 2x(PMMC), or leave it out")
        if self.snoops and self.tag_bits < SNOOP_TAG_BITS:
            raise InputError(f"tag_bits: {self.tag_bits} is too few where a picture is merged "
                             f"while others are shown and drawn; take {SNOOP_TAG_BITS} at least")
        if self.merges_directly and 0 < self.order_bits < self.node_order_bits:
            raise InputError(f"order_bits: {self.order_bits} does not hold the number of one of "
                             f"{self.maximum_nodes} nodes; take {self.node_order_bits} at least, "
                             "or 0 where no two nodes tie")
        self._check_queue()

    def _check_queue(self) -> None:
        if self.queue == "element":
            return
        try:
            check_whole("queue", self.queue, *QUEUE_RANGE)
        except InputError as error:
            raise InputError(f"{error}, nor element") from None

    def _widest(self) -> dict[str, int]:
        """The widths at which every triangle of the guard band fits."""
        coordinate = coordinate_bits(self.width, self.height, self.sub_bits)
        return {
            "coordinate_bits": coordinate,
            "edge_column_bits": edge_column_bits(coordinate, self.sub_bits),
            "edge_height_bits": edge_height_bits(coordinate),
        }

    # Backplane

    @property
    def id_bits(self) -> int:
        """ID lines on the backplane: enough for the total, not only the last unit's number."""
        return max(self.maximum_units, self.frame_units).bit_length()

    @property
    def interlace(self) -> Interlace:
        """The interlace this cage settles on at boot; where regions are dealt out, of each region's
        pixels over its processing element's units: along its line, if it has only one."""
        if self.regions is not None:
            regions = self.dealt_regions
            line = regions.y_bits == 0
            return Interlace(self.share_bits, 1 << regions.x_bits, 1 << regions.y_bits,
                             share_bits=self.share_bits if line else 0, lines=line)
        return self._interlace_of(self.units)

    def pictures(self) -> Sequence[Interlace | RegionedPicture]:
        """What the machine draws, for every number of units with which it draws, fewest first."""
        if self.regions is None:
            return self.interlaces()
        fewest = -(-self.dealt_regions.count // self.slots)
        return [RegionedPicture(elements << self.share_bits, self.width, self.height)
                for elements in range(fewest, (self.maximum_units >> self.share_bits) + 1)]

    def interlaces(self) -> tuple[Interlace, ...]:
        """One for every number of units the cards must be ready for, fewest first."""
        return tuple(self._interlace_of(1 << bits) for bits in
                     range(self.share_bits, self.maximum_units.bit_length()))

    def _interlace_of(self, units: int) -> Interlace:
        return interlace_for(self.width, self.height, words=self.words, units=units,
                             square_bits=self.square_bits, share_bits=self.share_bits,
                             skew=self.skew, diagonal=self.merges_directly, lines=self.lines)

    @cached_property
    def frame(self) -> MachineConfiguration:
        """Of a cage of one node whose memory units are the frame units: these hold the picture as
        those would, one word for each of its pixels."""
        return replace(self, cards="P" + "M" * self.frame_units, words=0, maximum_units=0, block=1,
                       skew=False, lines=False, packet=1, order_bits=0, list_words=0,
                       maximum_nodes=0, allow_orphans=True, **NO_OBJECTS)

    @property
    def aligned_domains(self) -> bool:
        """Every domain that draws is one aligned block of units, a power of two of them."""
        return (self.block > 1 or self.lines or self.maximum_units <= 2
                or self.merges_directly)

    @property
    def cycles_per_scan(self) -> int:
        return self.timing.pixels * self.clocks_per_pixel
