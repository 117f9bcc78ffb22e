"""Clocks of processing elements that pass objects on: each makes and draws what meets its regions.

An element has a queue of objects, a reader and a set-up of its own, so elements do not wait for one
another; drawing never waits for forwarding.  Each is followed by itself, with the objects that it
draws in the order in which the host sends them; an object comes a clock after the one before it,
and a clock later for each neighbour that it passes.  In the machine those that come round overtake
one another, which moves no more work from one element to another.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from .....golden.cycles.broadcast import NodeQueues, SetupTiming
from .....golden.cycles.element_latencies import NEVER, PIPELINE
from .....golden.cycles.objects.object_setup import ObjectSetUp
from .....golden.cycles.regions.region_work import RegionWork
from .....golden.objects.forwarding import forwarded_objects
from .....golden.objects.object_words import made_of_objects
from .....golden.organisations.dealt_regions import DealtRegions
from .....golden.organisations.organisation_of import organisation_of
from .....golden.specification.configuration import MachineConfiguration
from .....golden.specification.display_list import DisplayList


def forwarded_clocks(configuration: MachineConfiguration, display_list: DisplayList,
                     timing: SetupTiming) -> list[float]:
    """Until all elements are done, were each object the last; no object is clipped."""
    listed = made_of_objects(display_list)
    organisation = organisation_of(configuration)
    assert isinstance(organisation, DealtRegions)
    work = RegionWork(organisation, listed, PIPELINE)
    forwarded = forwarded_objects(configuration, listed)
    queues = [NodeQueues([element], configuration.fifo_depth, PIPELINE)
              for element in work.elements]
    setups = [ObjectSetUp(timing) for _ in queues]
    first = np.cumsum(listed.counts) - listed.counts
    ends = np.searchsorted(listed.object_of[work.primitive], np.arange(len(first) + 1)).tolist()
    places = (work.primitive - first[listed.object_of[work.primitive]]).tolist()
    triangles = iter(work)
    done, finished = NEVER, []
    for number, (begin, end) in enumerate(pairwise(ends)):
        own = np.flatnonzero(forwarded.drawn[number]).tolist()
        source = int(forwarded.source[number])
        for element in own:
            setup = setups[element]
            setup.take(max(number + abs(element - source), setup.room))
        for place in places[begin:end]:
            costs = {element: (walk, cost) for element, walk, cost in next(triangles)}
            for element in own:
                queue, setup = queues[element], setups[element]
                setup.leaves(queue.send(setup.arrival(place)))
                if element in costs:
                    queue.take(0, *costs[element])
        for element in own:
            setups[element].end(int(listed.counts[number]))
        done = max([done, *(queues[element].finished for element in own)])
        finished.append(done)
    return finished
