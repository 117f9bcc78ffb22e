"""Regions of the screen that are dealt out to processing elements: what is checked of a
configuration that has them, and what follows."""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property
from typing import get_args

from ..errors import InputError
from ..interlace import Interlace
from ..ranges import MAXIMUM_WORDS, check_whole
from ..regions import (
    Balance,
    Balancer,
    Regions,
    check_region_counts,
    default_slots,
    regions_of,
)
from ..widths import Widths
from .making import Objects


class DealingFields(Widths):
    """The fields ``regions``, ``slots``, ``balance`` and ``balancer``."""

    slots: int
    skew: bool
    balance: Balance
    balancer: Balancer
    maximum_units: int
    objects: Objects | None

    @property
    @abstractmethod
    def interlace(self) -> Interlace:
        """Of the pixels of a region over its processing element's units."""

    def _check_dealing(self) -> None:
        """What only machines have that deal regions out, and of these not all."""
        for name, known in (("balance", get_args(Balance)), ("balancer", get_args(Balancer))):
            if getattr(self, name) not in known:
                raise InputError(f"{name}: {getattr(self, name)!r} is none of {', '.join(known)}")
        if self.regions is None:
            for name, default in (("slots", 0), ("balance", "clocks"), ("balancer", "host")):
                if getattr(self, name) != default:
                    raise InputError(f"{name}: is for machines that deal regions out; give regions "
                                     "as well, or leave it out")
        elif (self.balance, self.balancer) == ("static", "hardware"):
            raise InputError("balancer: the hardware packs by what is counted, and static counts "
                             "nothing; take balance triangles or clocks")

    def _check_regions(self) -> int:
        """The slots of each processing element; ``InputError`` where regions cannot be dealt."""
        assert self.regions is not None
        check_region_counts(self.regions)
        regions, elements = self.dealt_regions, self.processing_elements
        if self.merge is not None:
            raise InputError(f"regions: {self.cards} has nodes, which share the triangles; take a "
                             "cage of one node, such as 4x(PMM)")
        for name, default in (("block", 1), ("skew", False), ("lines", False)):
            if getattr(self, name) != default:
                raise InputError(f"{name}: is settled by the regions; leave it out")
        inside = self.interlace
        if max(inside.unit_mask("x") >> regions.x_bits, inside.unit_mask("y") >> regions.y_bits):
            wide, high = (1 << inside.unit_mask(axis).bit_length() for axis in "xy")
            raise InputError(f"regions: {1 << regions.x_bits}x{1 << regions.y_bits} pixels do not "
                             f"spread over {inside.units} memory units; take {wide}x{high} or more")
        # Whoever passes objects on keeps the table of the boot: no element gets another region.
        default = (regions.even_share(elements) if self.objects == "elements" else
                   default_slots(regions.count, elements))
        slots = self.slots or default
        check_whole("slots", slots, 1, regions.count)
        if slots * elements < regions.count:
            raise InputError(f"slots: {slots} in each of {elements} processing elements do not "
                             f"hold {regions.count} regions; take {regions.even_share(elements)} "
                             "at least")
        if slots << self.slot_bits > MAXIMUM_WORDS:
            raise InputError(f"slots: {slots} need {slots << self.slot_bits} words in each memory "
                             f"unit, at most {MAXIMUM_WORDS}; add memory units or processing "
                             "elements")
        if self.words not in (0, slots << self.slot_bits):  # as it is in a copy
            raise InputError("words: is settled by the regions; leave it out")
        return slots

    @cached_property
    def dealt_regions(self) -> Regions:
        """The regions, where there are any."""
        assert self.regions is not None
        return regions_of(self.width, self.height, *self.regions)

    @property
    def slot_bits(self) -> int:
        """Log2 of the words that a region takes in each unit of its processing element; there a
        pixel's address is its slot, then its address among these."""
        regions = self.dealt_regions
        return regions.x_bits + regions.y_bits - self.share_bits

    @property
    def element_bits(self) -> int:
        """Bits of the number of a processing element that regions are dealt to, or of one more
        than there can be."""
        return (self.maximum_units >> self.share_bits).bit_length()

    @property
    def table_bits(self) -> int:
        """Bits of a slot of a processing element."""
        return (self.slots - 1).bit_length()
