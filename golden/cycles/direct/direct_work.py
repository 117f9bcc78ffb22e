"""A display list on a cage whose elements have no pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...specification.configuration import MachineConfiguration
from ...specification.display_list import DisplayList
from ..broadcast import SetUp
from ..element_latencies import Pipeline
from .crossbar import Crossbar
from .direct_clocks import (
    ControllersBroadcast,
    Elements,
    ListBroadcasts,
    direct_clocks,
)
from .element_streams import element_streams, joined
from .unit_ports import OnePortUnits, TwoPortUnits, UnitPorts

Float64 = NDArray[np.float64]
Int64 = NDArray[np.int64]

#: From when an element has a fragment until its unit looks at it, where nothing is in the way; all
#: that waits is followed as if it took a clock.
CROSSBAR_LATENCY = 3


class DirectWork:
    """The triangles of a display list, element after element; ``after`` was drawn before it.
    ``begin``: as of ``predict_cycles``.

    ``primitive``  int64 (n,): which of the list may cover a pixel
    ``bound``      float64 (elements,): as of ``NodeWork``
    """

    def __init__(self, configuration: MachineConfiguration, display_list: DisplayList,
                 pipeline: Pipeline, after: DisplayList | None = None,
                 begin: int | None = None) -> None:
        self._configuration, self._pipeline = configuration, pipeline
        one_port = configuration.memory_ports == 1
        self._streams, self._firsts = joined([
            element_streams(configuration, display_list, node, pipeline, one_port)
            for node in range(configuration.nodes)])
        self.primitive = self._streams.primitive
        self._ports: UnitPorts = (OnePortUnits(configuration, self._streams, after, begin)
                                  if one_port else TwoPortUnits(configuration.units))

    @property
    def bound(self) -> Float64:
        triangle, _, _, fragment = self._firsts
        walk = np.concatenate([[0], np.cumsum(self._streams.walk)])
        return np.asarray(np.maximum(np.diff(walk[triangle]), np.diff(fragment)), np.float64)

    def drawn(self, nodes: Int64, setup: SetUp | None, retained: bool) -> Float64:
        """float64 (n,): when the machine would be done with each triangle, were there no other
        left; once.  ``nodes``: of the triangles in the order in which they are sent, unless they
        are ``retained``."""
        elements = Elements(self._streams, self._firsts, self._configuration.fifo_depth,
                            self._pipeline)
        crossbar = Crossbar(self._configuration, self._streams, self._firsts[3])
        broadcast = ListBroadcasts() if retained else ControllersBroadcast(nodes, setup)
        return direct_clocks(elements, self._streams, crossbar, self._ports,
                             broadcast) + self._pipeline.finish + CROSSBAR_LATENCY

    @property
    def port_bound(self) -> float:
        """Clocks that the busiest unit needs at least for what it has been sent."""
        return self._ports.bound
