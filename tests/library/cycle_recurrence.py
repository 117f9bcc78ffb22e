"""The recurrence of the cycle model with two ports, span by span, queue by queue: what its arrays
are compared with."""

from __future__ import annotations

from collections import Counter

import numpy as np
from cycle_lists import owner

from cardcage.golden.cycles.broadcast import SetupTiming
from cardcage.golden.cycles.element_latencies import Pipeline
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.reference.exact import fragments
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.sampling_grid import Grid

NEVER = -10**9

#: Clocks from the command to draw lists to the first triangle.
LISTS = 2


def walked_by_hand(configuration: MachineConfiguration, listed: DisplayList, pipeline: Pipeline):
    """For each triangle and element: None where its box misses the element, else the clocks of the
    walk and, clocks after its load, every row's pixels; None in place of pixels at an open end."""
    triangles = Triangles.of(listed, Grid.of(listed))
    drawn = fragments(listed)
    owners = np.array([owner(configuration, unit) for unit in range(configuration.units)])
    covered = Counter(zip(drawn.primitive.tolist(), configuration.interlace.unit(
        drawn.x, drawn.y).tolist(), drawn.y.tolist(), strict=True))
    blocks = organisation_of(configuration).blocks
    units = configuration.interlace.unit(*np.meshgrid(np.arange(listed.width),
                                                      np.arange(listed.height)))
    by_block = [  # the units whose pixels have its offset from a multiple of its stride
        {int(unit) for unit in np.unique(units[block.y_offset::1 << block.y_bits << block.shifted,
                                               block.x_offset::1 << block.x_bits])}
        for block in blocks]
    work = []
    for place, primitive in enumerate(triangles.primitive.tolist()):
        box = units[triangles.top[place]:triangles.bottom[place],
                    triangles.left[place]:triangles.right[place]]
        of_triangle = []
        for element in range(configuration.processing_elements):
            mine = [units for block, units in zip(blocks, by_block, strict=True)
                    if block.element == element]
            if len(mine) == 1 and element not in owners[box]:
                of_triangle.append(None)
                continue
            clock = pipeline.first_row if len(mine) > 1 else 0
            rows = []
            for number, block in enumerate(mine):
                if number:
                    clock += pipeline.block
                owned = [y for y in range(triangles.top[place], triangles.bottom[place])
                         if set(units[y].tolist()) & block]
                for y in owned:
                    rows.append((clock, sum(covered[primitive, unit, y] for unit in block)))
                    clock += 1
                clock += not owned
            if not rows or rows[-1][0] < clock - 1 or not rows[-1][1]:
                rows.append((clock - 1, None))
            walk = clock + (pipeline.again if len(mine) > 1 else 0)
            of_triangle.append((walk, [row for row in rows if row[1] != 0]))
        work.append(of_triangle)
    return triangles, work


def shared_out(configuration: MachineConfiguration, listed: DisplayList, pipeline: Pipeline):
    """(place among all that the host sends, node, of each of the node's elements what
    ``walked_by_hand`` says) of each triangle, in the order in which the host sends them."""
    organisation = organisation_of(configuration)
    shares = organisation.shares(listed)
    places = shares.host_order.tolist()
    found = []
    for node, alone in enumerate(organisation.each):
        own = shares.of_node(node)
        triangles, work = walked_by_hand(alone.configuration, listed.chosen(own), pipeline)
        found += [(places.index(primitive), node, kept) for primitive, kept in zip(
            own[triangles.primitive].tolist(), work, strict=True)]
    return sorted(found, key=lambda triangle: triangle[0])


class Queues:
    """The elements of one node."""

    def __init__(self, work, pipeline: Pipeline, depth: int) -> None:
        self.pipeline, self.depth = pipeline, depth
        self.elements = range(len(work[0]) if work else 0)
        # Of each element's spans, known beforehand.
        self.clocks = [[1 if count is None else count for kept in work if kept[element]
                        for _, count in kept[element][1]] for element in self.elements]
        self.load, self.free = ([NEVER for _ in self.elements] for _ in range(2))
        self.number = [0 for _ in self.elements]
        self.freed, self.taken = ([[] for _ in self.elements] for _ in range(2))
        self.sent = LISTS - 1

    def ready(self, now):
        return all(sum(time <= now - 2 for time in self.taken[element])
                   - sum(time <= now for time in self.freed[element]) < self.depth - 1
                   for element in self.elements)

    def take(self, now, kept):
        pipeline, free = self.pipeline, self.free
        for element in self.elements:
            if kept[element] is None:
                continue
            walk, rows = kept[element]
            self.taken[element].append(now)
            begin = max(self.load[element], now + pipeline.queue)
            for clock, _ in rows:
                span = self.clocks[element][self.number[element]]
                free[element] = max(free[element], begin + pipeline.latency + clock) + span
                self.number[element] += 1
            done = self.clocks[element][:self.number[element]]

            def back(spans, done=done, end=free[element]):
                return end - max(spans, sum(done[-1 - spans:])) if len(done) > spans else NEVER

            self.load[element] = max(begin + walk, back(pipeline.spans_ahead) - pipeline.lead)
            self.freed[element].append(1 + free[element] - pipeline.valued)


def written_out(configuration: MachineConfiguration, listed: DisplayList, pipeline: Pipeline,
                setup: SetupTiming | None = None):
    """When the machine would be done, were each triangle the last, in the order in which the host
    sends them."""
    sequence = shared_out(configuration, listed, pipeline)
    nodes = [Queues([kept for _, of, kept in sequence if of == node], pipeline,
                    configuration.fifo_depth) for node in range(configuration.nodes)]
    entered, sent, finished, offered = [], [], [], -1
    for number, (place, node, kept) in enumerate(sequence):
        now = sent[-1] + 1 if sent else 0
        if setup is not None:
            offered += place - (sequence[number - 1][0] if number else -1)
            if number >= setup.waiting:
                offered = max(offered, entered[number - setup.waiting])
            entered.append(max(offered, entered[-1] + setup.interval if number else NEVER,
                               sent[number - setup.inside] if number >= setup.inside else NEVER))
            now = max(now, entered[-1] + setup.latency,
                      sent[-1] + setup.leaving if sent else NEVER)
        while not nodes[node].ready(now):
            now += 1
        sent.append(now)
        nodes[node].take(now, kept)
        finished.append(_finished(nodes))
    return finished


def written_out_lists(configuration: MachineConfiguration, listed: DisplayList,
                      pipeline: Pipeline):
    """The same of nodes that draw lists of their own, when all triangles have been drawn."""
    sequence = shared_out(configuration, listed, pipeline)
    nodes = [Queues([kept for _, of, kept in sequence if of == node], pipeline,
                    configuration.fifo_depth) for node in range(configuration.nodes)]
    for _, node, kept in sequence:
        queues = nodes[node]
        queues.sent += 1
        while not queues.ready(queues.sent):
            queues.sent += 1
        queues.take(queues.sent, kept)
    return _finished(nodes)


def _finished(nodes):
    return max(max(queues.free, default=NEVER) + queues.pipeline.finish for queues in nodes)
