"""What each triangle costs the processing elements that regions are dealt out to."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...organisations.dealt_regions import DealtRegions
from ...specification.display_list import DisplayList
from ..element_latencies import Pipeline
from ..node_work import ElementWork, NodeWork
from .large_boxes import LargeBoxes
from .region_element import RegionElement, TriangleCost
from .region_spans import region_spans


class RegionWork(NodeWork):
    """The triangles of a display list, the regions dealt out as ``organisation`` has them; the list
    ``after`` was drawn before it, likewise."""

    def __init__(self, organisation: DealtRegions, display_list: DisplayList, pipeline: Pipeline,
                 after: DisplayList | None = None, begin: int | None = None,
                 scanned: DealtRegions | None = None) -> None:
        super().__init__(organisation, display_list, 0, pipeline, after, begin, scanned)
        self._dealt = organisation
        self.elements = [RegionElement(ports) for ports in self._ports.elements]

    def __iter__(self) -> Iterator[list[ElementWork]]:
        elements = len(self.elements)
        boxes = LargeBoxes(self._dealt, self._triangles)
        for spans in region_spans(self._triangles, self._dealt):
            self._bound += [np.bincount(spans.visit_element, spans.visit_rows, elements),
                            np.bincount(spans.element, spans.length, elements)]
            entries, leaving = spans.entries()
            accesses: list[Any] = [None] * len(spans.visit_rows)
            for visit, cost in zip(leaving.tolist(), self._ports.costs(entries, spans),
                                   strict=True):
                accesses[visit] = cost
            following = np.zeros(len(spans.visit_rows), np.int64)
            following[leaving] = entries.walk - 1 - entries.offset[entries.first[1:] - 1]
            visits = list(zip(spans.visit_rows.tolist(), following.tolist(), accesses,
                              strict=True))
            bands = boxes.bands(spans)
            work: list[list[ElementWork]] = [[] for _ in range(spans.end - spans.begin)]
            ends = np.flatnonzero(spans.visit_ends)
            first = 0
            for last, triangle, element in zip(
                    ends.tolist(), spans.visit_triangle[ends].tolist(),
                    spans.visit_element[ends].tolist(), strict=True):
                # The element says itself when it can take the next one.
                work[triangle].append((element, 0, TriangleCost(
                    bands.get((triangle, element)), visits[first:last + 1])))
                first = last + 1
            yield from work
