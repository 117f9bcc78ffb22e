"""From every processing element to every memory unit."""

from functools import reduce
from operator import or_

from amaranth.hdl import *
from amaranth.lib import data, fifo, stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import Queue
from ...golden.specification.queues import FRAGMENTS_OF_ELEMENT
from ..backplane.fragment_lines import unit_fragment_layout
from ..rasteriser.interpolator import fragment_layout
from .fragment_queue import FragmentQueue
from .unit_feed import UnitFeed

__all__ = ["Crossbar"]


class Crossbar(wiring.Component):
    """Takes a fragment a clock from each processing element, and gives each unit one a clock.

    ::

        element ─▶ queues ══╗
        element ─▶ queues ══╬══▶ UnitFeed ─▶ unit
        element ─▶ queues ══╝

    An element has a queue for each unit: only a full one holds it up, and what goes to different
    units does not wait for one another.  Or it has one queue, whose head goes to its unit, and
    waits for it in front of all others: a part of the hardware, and of the throughput.

    Fragments of one element for one unit keep their order.  Each unit takes those of the elements
    in turn (``RoundRobin``), so none that waits there sees more than one of each other element
    before it.

    Latency: ``latency`` clocks, where nothing waits.  Throughput: a fragment a clock from each
    element and to each unit, as far as they do not want the same ones.

    Parameters
    ----------
    elements, units: int, positive
        Of each how many there are at most.
    queue: Queue
        Fragments that can wait for each unit, or ``"element"``.
    id_bits, address_bits, depth_bits: int, positive
        As of ``MemoryBus``.

    Members
    -------
    elements: In(stream of fragment_layout) [elements]
    units: Out(stream of unit_fragment_layout) [units]
    busy: Out(1)
        It holds a fragment.

    Denali, in Cox & Hanrahan 1993, section 4.  Raises ``ValueError`` for a number out of range.
    """

    latency = FragmentQueue.latency + UnitFeed.latency - 1

    def __init__(self, *, elements: int, units: int, queue: Queue, id_bits: int,
                 address_bits: int, depth_bits: int):
        if elements < 1:
            raise ValueError(f"elements must be positive, not {elements!r}")
        if queue != "element" and queue < 1:
            raise ValueError(f"queue must be positive or 'element', not {queue!r}")
        if not 1 <= units < 1 << id_bits:
            raise ValueError(f"units must be 1 to {(1 << id_bits) - 1}, not {units!r}")
        bits = {"address_bits": address_bits, "depth_bits": depth_bits}
        self._shape = shape = unit_fragment_layout(**bits)
        self.queue = queue
        self._feeds = [UnitFeed(elements=elements, shape=shape) for _ in range(units)]
        super().__init__({
            "elements": In(stream.Signature(fragment_layout(id_bits=id_bits, **bits))
                           ).array(elements),
            "units": Out(stream.Signature(shape)).array(units),
            "busy": Out(1),
        })

    def elaborate(self, platform):
        m = Module()
        feeds, busy = self._feeds, []
        for number, feed in enumerate(feeds):
            m.submodules[f"unit_{number}"] = feed
            wiring.connect(m, feed.fragments, wiring.flipped(self.units[number]))
            busy.append(feed.busy)
        add = self._add_one_queue if self.queue == "element" else self._add_queues
        for number, fragments in enumerate(self.elements):
            busy += add(m, number, fragments)
        m.d.comb += self.busy.eq(reduce(or_, busy))
        return m

    def _add_queues(self, m, element, fragments):
        """A queue for each unit.  Returns which of them hold something."""
        waiting = []
        for unit, feed in enumerate(self._feeds):
            queue = FragmentQueue(depth=self.queue, shape=self._shape)
            m.submodules[f"queue_{element}_{unit}"] = queue
            here = fragments.payload.unit == unit
            m.d.comb += [
                *_without_unit(queue.fragments.payload, fragments.payload),
                queue.fragments.valid.eq(fragments.valid & here),
                feed.waiting[element].eq(queue.waiting),
                queue.grant.eq(feed.grant[element]),
                feed.given[element].eq(queue.given),
                queue.taken.eq(feed.taken[element]),
            ]
            with m.If(here):
                m.d.comb += fragments.ready.eq(queue.fragments.ready)
            waiting.append(queue.waiting)
        return waiting

    def _add_one_queue(self, m, element, fragments):
        """One queue for all units.  Returns whether it holds something."""
        unit = fragments.payload.unit
        queue = FragmentQueue(depth=FRAGMENTS_OF_ELEMENT, shape=self._shape)
        targets = fifo.SyncFIFO(width=len(unit), depth=FRAGMENTS_OF_ELEMENT)
        m.submodules[f"queue_{element}"] = queue
        m.submodules[f"targets_{element}"] = targets
        grants, taken = (Cat(getattr(feed, name)[element] for feed in self._feeds)
                         for name in ("grant", "taken"))
        # What is granted and not taken keeps the next one from being granted, by another unit.
        given, free = Signal(name=f"given_{element}"), Signal(name=f"free_{element}")
        m.d.comb += [
            free.eq(~given | queue.taken),
            *_without_unit(queue.fragments.payload, fragments.payload),
            queue.fragments.valid.eq(fragments.valid),
            fragments.ready.eq(queue.fragments.ready),
            targets.w_data.eq(unit),
            targets.w_en.eq(fragments.valid & fragments.ready),
            targets.r_en.eq(queue.grant),
            queue.grant.eq(grants.any()),
            queue.taken.eq(taken.any()),
        ]
        with m.If(free):
            m.d.sync += given.eq(queue.grant)
        for number, feed in enumerate(self._feeds):
            m.d.comb += [
                feed.waiting[element].eq(queue.waiting & free & (targets.r_data == number)),
                feed.given[element].eq(queue.given),
            ]
        return [queue.waiting]


def _without_unit(into: data.View, fragment: data.View) -> list:
    return [into[name].eq(fragment[name]) for name, _ in into.shape()]
