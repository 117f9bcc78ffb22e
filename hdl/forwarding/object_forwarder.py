"""Passes objects on to the neighbours, and keeps those that are its own to draw."""

from amaranth.hdl import *
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.queues import OBJECTS_PASSING, OBJECTS_WAITING
from ..backplane.region_lines import RegionLines
from .fair_merge import FairMerge
from .object_copies import ObjectCopies
from .own_run import OwnRun
from .reach import Routes, reaching_object_layout, routes

__all__ = ["ObjectForwarder"]

#: Where an object may go that comes from there.  What travels left never turns right.
WAYS = {"host": ("here", "before", "after"), "from_left": ("here", "after"),
        "from_right": ("here", "before")}

#: The output of each way.
OUTPUTS = {"here": "drawn", "before": "to_left", "after": "to_right"}


class ObjectForwarder(wiring.Component):
    """One processing element's part of two one-way channels.

    ::

                           host
                            │
        from_left ──▶ ┌─────▼─────┐ ──▶ to_right
                      │  to here  │
        to_left   ◀── └─────┬─────┘ ◀── from_right
                            ▼
                          drawn

    An object is drawn here if it meets a region of the element's own.  One from the host goes left
    as well if it meets a region of an earlier element, and right if it meets one of a later; one
    from the right goes on left as long as earlier elements need it, one from the left goes on
    right.  So every element that needs an object has it once, wherever the host gave it.

    *Nothing waits in a circle.*  Whoever takes ``drawn`` takes it within some time, whatever the
    channels do: drawing waits for nothing of them.  What is on its way to the left waits for the
    left neighbour's queue, which empties by drawing and by that neighbour's way to the left, and so
    on to the first element, which has none: each of them moves within some time, by induction from
    the left.  Likewise to the right.  What the host gives waits for these three, and none of them
    for it.  In each merge sources have turns, so none is passed over for ever.

    *Drawing does not wait for forwarding*: the copy to be drawn is taken as soon as there is room
    for it, whether or not the others have gone, and these likewise.  Only objects behind one that
    has not gone every way wait for it, in their queue; the other two queues go on meanwhile.

    Latency: two clocks from an object to each output.  Throughput: an object a clock at each.

    Parameters
    ----------
    object_bits: int, positive
        Of an object, besides the regions that it can meet.
    waiting, passing: int, positive
        Objects of the host that can wait; objects from each neighbour.

    Members
    -------
    regions: In(RegionLines), element: In(element_bits)
        A table in which elements ascend, before anything else; the number that it has in that.
    host, from_left, from_right: In(stream of reaching_object_layout)
    drawn, to_left, to_right: Out(stream of reaching_object_layout)
        The first element never passes anything left, the last one nothing right.
    busy: Out(1)
        It holds an object.

    Blazek 1991, chapter V, node initiated with object forwarding.  Raises ``ValueError`` when a
    number is not positive.
    """

    latency = 2

    def __init__(self, *, configuration: MachineConfiguration, object_bits: int,
                 waiting: int = OBJECTS_WAITING, passing: int = OBJECTS_PASSING):
        if object_bits < 1:
            raise ValueError(f"object_bits must be positive, not {object_bits!r}")
        self.configuration = configuration
        shape = reaching_object_layout(configuration, object_bits)
        depths = {"host": waiting, "from_left": passing, "from_right": passing}
        self._run = OwnRun(configuration=configuration)
        self._copies = {source: ObjectCopies(shape=shape, depth=depths[source], ways=ways)
                        for source, ways in WAYS.items()}
        self._merges = {way: FairMerge(shape=shape, sources=len(self._sources(way)))
                        for way in OUTPUTS}
        super().__init__({
            "regions": In(RegionLines(configuration)),
            "element": In(configuration.element_bits),
            **{source: In(stream.Signature(shape)) for source in WAYS},
            **{output: Out(stream.Signature(shape)) for output in OUTPUTS.values()},
            "busy": Out(1),
        })

    @staticmethod
    def _sources(way):
        """Those from which objects may go that way."""
        return [source for source, ways in WAYS.items() if way in ways]

    def elaborate(self, platform):
        m = Module()
        m.submodules.run = run = self._run
        wiring.connect(m, wiring.flipped(self.regions), run.regions)
        m.d.comb += run.element.eq(self.element)
        for source, copies in self._copies.items():
            m.submodules[f"{source}_copies"] = copies
            wiring.connect(m, wiring.flipped(getattr(self, source)), copies.objects)
            needs: Routes = routes(run.run, copies.first.reach)
            m.d.comb += copies.needs.eq(Cat(getattr(needs, way) for way in WAYS[source]))
        for way, merge in self._merges.items():
            m.submodules[f"{OUTPUTS[way]}_merge"] = merge
            for place, source in enumerate(self._sources(way)):
                wiring.connect(m, getattr(self._copies[source], way), merge.sources[place])
            wiring.connect(m, merge.objects, wiring.flipped(getattr(self, OUTPUTS[way])))
        m.d.comb += self.busy.eq(Cat(
            *(copies.busy for copies in self._copies.values()),
            *(merge.objects.valid for merge in self._merges.values())).any())
        return m
