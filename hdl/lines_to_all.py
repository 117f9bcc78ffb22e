"""Lines that run from one board to many, with the wired answers: connections only."""

from collections.abc import Sequence
from functools import reduce
from operator import and_, or_

from amaranth.hdl import *

__all__ = [
    "connect_broadcast",
    "connect_pictures",
    "connect_regions",
    "connect_scan",
    "connect_senders",
]


def connect_broadcast(part: Module, lines, receivers: Sequence) -> None:
    """``BroadcastLines`` to each receiver's; ready and done: wired and."""
    part.d.comb += [
        lines.ready.eq(reduce(and_, (receiver.ready for receiver in receivers), C(1))),
        lines.done.eq(reduce(and_, (receiver.done for receiver in receivers), C(1))),
    ]
    for receiver in receivers:
        part.d.comb += [receiver.strobe.eq(lines.strobe), receiver.packet.eq(lines.packet)]


def connect_pictures(part: Module, lines, units: Sequence, *, front=None) -> None:
    """``PictureLines`` to each memory unit; swept: wired and.

    ``front``: for each unit its own, in place of that of ``lines``.
    """
    part.d.comb += lines.swept.eq(reduce(and_, (unit.pictures.swept for unit in units), C(1)))
    for place, unit in enumerate(units):
        part.d.comb += unit.pictures.front.eq(lines.front if front is None else front[place])
        part.d.comb += [getattr(unit.pictures, name).eq(getattr(lines, name))
                        for name in ("depth_tag", "initialise", "sweep")]
        part.d.comb += [tag.eq(source) for tag, source in zip(
            unit.pictures.color_tag, lines.color_tag, strict=True)]


def connect_regions(part: Module, lines, receivers: Sequence, *, table=None) -> None:
    """``RegionLines`` to each receiver's.

    ``table``: the one in use there, in place of that of ``lines``.
    """
    for receiver in receivers:
        part.d.comb += [getattr(receiver, name).eq(getattr(lines, name))
                        for name in lines.signature.members if name != "table"]
        part.d.comb += receiver.table.eq(lines.table if table is None else table)


def connect_scan(part: Module, lines, units: Sequence) -> None:
    """``ScanLines`` to each memory unit; the answers: wired or."""
    answers = [name for name in ("video", "drawn", "rank") if name in lines.signature.members]
    part.d.comb += [getattr(lines, name).eq(reduce(or_, (getattr(unit.scan, name)
                                                         for unit in units), C(0)))
                    for name in answers]
    for unit in units:
        part.d.comb += [unit.scan.fetch.eq(lines.fetch), unit.scan.show.eq(lines.show)]


def connect_senders(part: Module, lines, units: Sequence) -> None:
    """``SendLines`` to each memory unit of a node; settled: wired and, the rest wired or."""
    answers = [unit.merge for unit in units]
    part.d.comb += lines.settled.eq(reduce(and_, (answer.settled for answer in answers), C(1)))
    part.d.comb += [
        Value.cast(getattr(lines, name)).eq(
            reduce(or_, (Value.cast(getattr(answer, name)) for answer in answers), C(0)))
        for name in ("valid", "pixel", "more")]
    for answer in answers:
        part.d.comb += [getattr(answer, name).eq(getattr(lines, name))
                        for name in ("start", "unit", "ready")]
