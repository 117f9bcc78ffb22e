"""A crossbar in Python, clock by clock, and all the states that it can come into."""

from itertools import product
from typing import NamedTuple


class State(NamedTuple):
    """What a crossbar holds; a fragment is (unit, whatever tells it from others).

    ``queues``   of each element its queues, each the fragments that wait
    ``given``    of each element and queue the fragment that is granted, or None
    ``chosen``   of each unit the element whose fragment comes next, or None
    ``offered``  of each unit what it is offered, or None
    ``last``     of each unit the element that was granted last
    """

    queues: tuple
    given: tuple
    chosen: tuple
    offered: tuple
    last: tuple


class CrossbarModel:
    """``elements`` and ``units``; ``depth`` fragments can wait in each queue, of which an element
    has one for each unit, or, ``shared``, one."""

    def __init__(self, elements, units, depth, *, shared=False):
        self.elements, self.units, self.depth, self.shared = elements, units, depth, shared
        self.lanes = 1 if shared else units

    @property
    def start(self):
        lanes = range(self.lanes)
        return State(tuple(tuple(() for _ in lanes) for _ in range(self.elements)),
                     tuple(tuple(None for _ in lanes) for _ in range(self.elements)),
                     (None,) * self.units, (None,) * self.units, (self.elements - 1,) * self.units)

    def _lane(self, unit):
        return 0 if self.shared else unit

    def takes(self, state, element, unit):
        """The element's fragment for the unit is taken in this clock."""
        return len(state.queues[element][self._lane(unit)]) < self.depth

    def moves(self, state, unit, ready):
        return state.offered[unit] is None or bool(ready[unit])

    def asks(self, state, element, unit, ready):
        """The element has something that the unit can be given next."""
        lane = self._lane(unit)
        queue, given = state.queues[element][lane], state.given[element][lane]
        return bool(queue) and queue[0][0] == unit and (
            given is None or self.moves(state, given[0], ready))

    def granted(self, state, unit, ready):
        """The element that the unit grants in this clock, or None."""
        if not self.moves(state, unit, ready):
            return None
        return next((element for element in self._in_turn(state.last[unit])
                     if self.asks(state, element, unit, ready)), None)

    def _in_turn(self, last):
        return [(last + 1 + place) % self.elements for place in range(self.elements)]

    def step(self, state, offers, ready):
        """The next state.  ``offers``: of each element a fragment or None; ``ready``: of each
        unit."""
        queues = [list(own) for own in state.queues]
        given = [list(own) for own in state.given]
        chosen, offered, last = list(state.chosen), list(state.offered), list(state.last)
        for unit in range(self.units):
            if self.moves(state, unit, ready):
                lane, before = self._lane(unit), state.chosen[unit]
                offered[unit] = None if before is None else state.given[before][lane]
                if before is not None:
                    given[before][lane] = None
        for unit in range(self.units):
            if self.moves(state, unit, ready):
                chosen[unit] = element = self.granted(state, unit, ready)
                if element is not None:
                    lane, last[unit] = self._lane(unit), element
                    given[element][lane], *rest = queues[element][lane]
                    queues[element][lane] = tuple(rest)
        for element, fragment in enumerate(offers):
            if fragment is not None and self.takes(state, element, fragment[0]):
                lane = self._lane(fragment[0])
                queues[element][lane] = (*queues[element][lane], fragment)
        return State(tuple(map(tuple, queues)), tuple(map(tuple, given)), tuple(chosen),
                     tuple(offered), tuple(last))

    def inputs(self):
        """All that can come in a clock, fragments told apart by their unit alone."""
        offers = [None, *((unit,) for unit in range(self.units))]
        return [(offer, ready) for offer in product(offers, repeat=self.elements)
                for ready in product((0, 1), repeat=self.units)]

    def explored(self):
        """Of each state that can be reached: the next one for each of the ``inputs``."""
        following, inputs = {}, self.inputs()
        waiting = [self.start]
        while waiting:
            state = waiting.pop()
            if state not in following:
                following[state] = [self.step(state, *each) for each in inputs]
                waiting += following[state]
        return following
