"""A cage whose elements share all units, clock by clock, one queue and one fragment at a time: what
the arrays of the cycle model are compared with."""

from __future__ import annotations

from collections import deque

from cardcage.golden.cycles.element_latencies import Pipeline
from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.reference.coverage import Triangles
from cardcage.golden.reference.exact import fragments
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.golden.specification.sampling_grid import Grid

#: Fragments in the one queue of an element.
ONE_QUEUE = 4


class Element:
    """Rows to walk, slots to draw: a slot is a fragment's unit, or None for an end without any."""

    def __init__(self, rows, pipeline: Pipeline, places: int) -> None:
        self.rows, self.pipeline, self.places = rows, pipeline, places
        self.slots = [slot for triangle in rows for row in triangle for slot in row]
        self.begins, self.ends, count = [], [], 0  # of rows that leave the walker; of triangles
        for triangle in rows:
            for row in triangle:
                if row:
                    self.begins.append(count)
                count += len(row)
            self.ends.append(count)
        self.sent: list[int] = []
        self.found: list[int] = []
        self.last_found: list[int] = []  # of each triangle its last row
        self.triangle, self.row, self.drawn, self.freed = 0, None, 0, 0

    @property
    def arrived(self):
        """Slots of rows that were found long enough ago, by the clock before ``now``."""
        return self._arrived

    def arrive(self, now):
        count = sum(time + self.pipeline.latency <= now for time in self.found)
        self._arrived = self.begins[count] if count < len(self.begins) else len(self.slots)

    def walk(self, now):
        if self.row is None:
            if self.triangle == len(self.sent) or (
                    now < self.sent[self.triangle] + self.pipeline.queue):
                return
            self.row = 0
        row = self.rows[self.triangle][self.row]
        if row:
            back = len(self.found) - self.pipeline.spans_ahead
            if back >= 0 and self.begins[back] - self.drawn > self.pipeline.lead:
                return
            self.found.append(now)
        self.row += 1
        if self.row == len(self.rows[self.triangle]):
            self.last_found.append(self.found[-1])
            self.triangle, self.row = self.triangle + 1, None

    def free(self, now):
        """One more triangle's place, where its last fragment is about to be drawn."""
        valued = self.pipeline.valued
        if self.freed < len(self.last_found) and (
                self.ends[self.freed] - self.drawn < valued - 1
                and self.last_found[self.freed] + self.pipeline.latency + 2 - valued <= now):
            self.freed += 1

    def ready(self, now):
        shown = sum(time < now - 1 for time in self.sent)
        return shown - self.freed <= self.places


def rows_of(configuration: MachineConfiguration, listed: DisplayList, node: int):
    """Of each of its triangles that may cover a pixel, row by row, the units of its pixels."""
    organisation = organisation_of(configuration)
    own = listed.chosen(organisation.shares(listed).of_node(node))
    triangles, drawn = Triangles.of(own, Grid.of(own)), fragments(own)
    found = []
    for place, primitive in enumerate(triangles.primitive.tolist()):
        rows = []
        for y in range(int(triangles.top[place]), int(triangles.bottom[place])):
            here = (drawn.primitive == primitive) & (drawn.y == y)
            rows.append([(organisation.unit(int(x), y), place) for x in sorted(drawn.x[here])])
        if not rows[-1]:
            rows[-1] = [(None, place)]
        found.append(rows)
    return own, triangles, found


def clocks_by_hand(configuration: MachineConfiguration, listed: DisplayList, pipeline: Pipeline, *,
                   retained: bool = False):
    """The last clock in which something of each triangle is taken, by (node, triangle)."""
    shares = organisation_of(configuration).shares(listed)
    elements, kept = [], []
    for node in range(configuration.nodes):
        _, triangles, rows = rows_of(configuration, listed, node)
        elements.append(Element(rows, pipeline, configuration.fifo_depth - 2))
        kept += [(int(shares.host_place[number]), node)
                 for number in shares.of_node(node)[triangles.primitive].tolist()]
    sending = [node for _, node in sorted(kept)]
    one = configuration.queue == "element"
    queues = [[deque() for _ in range(1 if one else configuration.units)] for _ in elements]
    depth = ONE_QUEUE if one else configuration.queue
    turns = [0] * configuration.units  # whose it is first
    taken: dict = {}
    now = 0
    while any(element.drawn < len(element.slots) for element in elements) or any(
            queue for own in queues for queue in own):
        grants = []
        for unit in range(configuration.units):
            for ahead in range(len(elements)):
                node = (turns[unit] + ahead) % len(elements)
                queue = queues[node][0 if one else unit]
                if queue and queue[0][0] == unit:
                    grants.append((node, queue))
                    turns[unit] = (node + 1) % len(elements)
                    break
        puts = []
        for node, element in enumerate(elements):
            element.arrive(now)
            if element.drawn < element.arrived:
                unit, place = element.slots[element.drawn]
                if unit is None:
                    taken[node, place] = now
                    element.drawn += 1
                elif len(queues[node][0 if one else unit]) < depth:
                    puts.append((queues[node][0 if one else unit], (unit, place)))
                    element.drawn += 1
        for node, queue in grants:
            taken[node, queue.popleft()[1]] = now
        for queue, fragment in puts:
            queue.append(fragment)
        for element in elements:
            element.walk(now)
        for element in elements:
            element.free(now)
        if retained:
            for element in elements:
                if now >= 2 and len(element.sent) < len(element.rows) and element.ready(now):
                    element.sent.append(now)
        elif sending and elements[sending[0]].ready(now):
            elements[sending.pop(0)].sent.append(now)
        now += 1
    return taken
