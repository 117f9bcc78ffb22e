"""What a machine answered, understood: frames, as they left the machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...golden.organisations.organisation_of import organisation_of
from ...golden.specification.commands import ResponseKind, fault_text, response_fields
from ...golden.specification.configuration import MachineConfiguration
from ..engines.activity_record import ActivityRecord
from ..engines.engine import EngineRun, Scan
from ..support.machine_error import MachineError


@dataclass(frozen=True)
class Work:
    """What one processing element owns and did for the last frame, in its own count.

    ``first_unit``  in its node
    """

    node: int
    first_unit: int
    units: int
    fragments: int
    busy_cycles: int


@dataclass(frozen=True)
class Simulation:
    """One frame, as it left the machine.

    ``video``            uint8 (height, width, 3), highest resolution, from the video pins
    ``depth``            int64 (h, w) at the machine's resolution, read back through the controller;
                         -1 where the pixel's unit belongs to no processing element; None where
                         they were not read
    ``resolution``       width and height that the machine reported
    ``work``             one entry per processing element, left to right; empty, as are ``sent``,
                         ``taken`` and ``followed``, where counters were not read
    ``owned``, ``total`` memory units in some domain, memory units in the cage
    ``boot_cycles``      reset to ready
    ``draw_cycles``      frame start to the last processing element's done
    ``merge_cycles``     frame start to the merged picture; None where merge cards end no nodes
    ``sent``             pixels that each node's merge card sent, in its own count; where elements
                         have no pixels, their fragments
    ``taken``            fragments that each memory unit took from all processing elements, in its
                         own count; empty where it belongs to one
    ``followed``         those of them whose pixel a fragment just ahead of them was to change
    ``made``             triangles that each place made of objects, in its own count; empty where
                         none does
    ``dropped``          of these, and of those that came there as vertices, what set-up dropped
    ``forwarded``        objects that each processing element passed left, and right, in its own
                         count; empty where none does
    ``slot_counts``      int64 (elements, slots): what each processing element counted of its
                         regions; None where that was not read
    ``next_table``       int64 (regions,): the table that the machine has made for the next picture;
                         None likewise
    ``repeated_scans``   scans that began with the old picture since the frame start
    ``scans``            every whole scan, in order
    ``activity``         what the processing elements did meanwhile; None where nothing tells
    """

    video: NDArray[np.uint8]
    depth: NDArray[np.int64] | None
    resolution: tuple[int, int]
    work: Sequence[Work]
    owned: int
    total: int
    boot_cycles: int
    draw_cycles: int
    repeated_scans: int
    scans: Sequence[Scan]
    engine: str
    cycles: int
    seconds: float
    build_seconds: float = 0.0
    notes: tuple[str, ...] = ()
    activity: ActivityRecord | None = None
    merge_cycles: int | None = None
    sent: Sequence[int] = ()
    taken: Sequence[int] = ()
    followed: Sequence[int] = ()
    made: Sequence[int] = ()
    dropped: Sequence[int] = ()
    forwarded: Sequence[tuple[int, int]] = ()
    slot_counts: NDArray[np.int64] | None = None
    next_table: NDArray[np.int64] | None = None


#: In place of a read-back or a reading, of a frame of which nothing was read.
NOT_READ = -1


class Answers:
    """Everything a machine answered in a run, by what it means: its boot, frames one after another,
    and the counters, as often as they were read.

    ``frames``     how many were drawn
    ``fragments``  int64 (readings, elements): since each reading's frame start
    ``busy``       int64 (readings, elements): cycles, likewise
    ``sent``       int64 (readings, nodes): pixels, of cages whose nodes send any
    ``taken``      int64 (readings, units): fragments, of cages whose elements have all units
                   together
    ``followed``   int64 (readings, units): likewise
    ``made``       int64 (readings, places): triangles made of objects, where some are
    ``dropped``    int64 (readings, places): likewise, triangles that set-up dropped
    ``forwarded``  int64 (readings, elements, 2): objects passed left, and right, where some are
    ``slot_counts``  int64 (readings, elements, slots): what was counted of regions, as often as
                   that was read
    ``tables``     int64 (readings, regions): tables that the machine made, likewise

    Raises ``MachineError`` where the machine reports a fault, or a resolution that is not the
    configuration's.
    """

    def __init__(self, configuration: MachineConfiguration, run: EngineRun) -> None:
        self._organisation = organisation = organisation_of(configuration)
        self._run = run
        self._values: dict[ResponseKind, list[int]] = {kind: [] for kind in ResponseKind}
        self._cycles: dict[ResponseKind, list[int]] = {kind: [] for kind in ResponseKind}
        for kind, value, cycle in run.responses:
            self._values[kind].append(value)
            self._cycles[kind].append(cycle)
        for fault in self._fields(ResponseKind.ERROR):
            raise MachineError(f"the machine reports fault {fault_text(fault['fault'])}")
        [picture] = self._fields(ResponseKind.PICTURE)
        self._resolution = picture["width"], picture["height"]
        if self._resolution != organisation.resolution[:2]:
            raise MachineError("the machine draws {}x{}, expected {}x{}".format(
                *self._resolution, *organisation.resolution[:2]))
        self._domains = self._fields(ResponseKind.DOMAIN)
        if configuration.merges_directly:  # all have the same one
            self._domains *= configuration.processing_elements
        self.frames = len(self._values[ResponseKind.FRAME_DRAWN])
        self.fragments, self.busy = (
            np.array(self._values[kind], np.int64).reshape(-1, len(self._domains))
            for kind in (ResponseKind.FRAGMENTS, ResponseKind.BUSY))
        self.sent, self.taken, self.followed, self.made, self.dropped = (
            np.array(self._values[kind], np.int64).reshape(len(self.fragments), -1)
            for kind in (ResponseKind.SENT, ResponseKind.TAKEN, ResponseKind.FOLLOWED,
                         ResponseKind.MADE, ResponseKind.DROPPED))
        if configuration.merges_directly:
            self.sent = self.fragments
        passed = self._fields(ResponseKind.FORWARDED)
        self.forwarded = np.array([(each["left"], each["right"]) for each in passed], np.int64
                                  ).reshape(len(self.fragments), len(passed)
                                            // max(1, len(self.fragments)), 2)
        self.slot_counts = np.array(self._values[ResponseKind.REGION_COUNT], np.int64).reshape(
            -1, len(self._domains), configuration.slots or 1)
        self.tables = np.array(self._values[ResponseKind.TABLE_ENTRY], np.int64).reshape(
            -1, 1 if configuration.regions is None else configuration.dealt_regions.count)

    def _fields(self, kind: ResponseKind) -> list[dict[str, int]]:
        return [response_fields(kind, value) for value in self._values[kind]]

    def frame(self, number: int, reading: int, read_back: int | None = None, *,
              counted: int | None = None,
              table: NDArray[np.int64] | None = None) -> Simulation:
        """Frame ``number``, that was drawn by ``table``, or where that is None by the one with
        which the machine began.

        Its work is what that ``reading`` of the counters says, its activity the record that ends
        with the reading, if the engine keeps any; its depths are those of that ``read_back``, by
        default as if each frame's were read back once, or ``NOT_READ``, as ``reading`` may be.
        Counts of regions are those of reading ``counted`` of them, by default as if they were read
        as often as the counters; if they were read at all.
        """
        run, organisation = self._run, self._organisation
        shown = self._cycles[ResponseKind.FRAME_SHOWN][number]
        read = reading != NOT_READ
        counted = reading if counted is None else counted
        [units] = self._fields(ResponseKind.UNITS)
        return Simulation(
            video=next(scan.picture for scan in run.scans if scan.cycle > shown),
            depth=None if read_back == NOT_READ else self._depth(
                number if read_back is None else read_back, table),
            resolution=self._resolution,
            work=[Work(node, domain["first"], domain["units"], int(fragments), int(busy))
                  for (node, *_), domain, fragments, busy in zip(
                      organisation.domains, self._domains, self.fragments[reading],
                      self.busy[reading], strict=True)] if read else [],
            merge_cycles=self._values[ResponseKind.MERGED][number] if organisation.merges else None,
            sent=self.sent[reading].tolist() if read else [],
            taken=self.taken[reading].tolist() if read else [],
            followed=self.followed[reading].tolist() if read else [],
            made=self.made[reading].tolist() if read else [],
            dropped=self.dropped[reading].tolist() if read else [],
            forwarded=list(map(tuple, self.forwarded[reading].tolist())) if read else [],
            slot_counts=self.slot_counts[counted] if read and len(self.slot_counts) else None,
            next_table=self.tables[counted] if read and len(self.tables) else None,
            owned=units["owned"],
            total=units["total"],
            boot_cycles=self._values[ResponseKind.BOOTED][0],
            draw_cycles=self._values[ResponseKind.FRAME_DRAWN][number],
            repeated_scans=self._values[ResponseKind.FRAME_SHOWN][number],
            scans=run.scans,
            engine=run.engine,
            cycles=run.cycles,
            seconds=run.seconds,
            build_seconds=run.build_seconds,
            notes=run.notes,
            activity=run.activity[reading] if run.activity and read else None,
        )

    def _depth(self, read_back: int, table: NDArray[np.int64] | None) -> NDArray[np.int64]:
        words = self._organisation.depths_read_back
        begin = words * read_back
        return self._organisation.dealt(table).depth_image(
            self._values[ResponseKind.DEPTH][begin:begin + words])
