"""A unit that never waits: jobs started at any time, results that come so many clocks later."""

import random

from amaranth.hdl import Shape, Value

from .bench import Agent


class Starts(Agent):
    """Raises ``start`` with each of ``jobs`` at the inputs of ``dut``, ``gap()`` clocks apart.

    A job is a dict by the inputs' names, all of them in ``inputs``.  What a job does not say is
    random, and so is everything between jobs.  ``clocks`` lists when each was started.
    """

    def __init__(self, dut, start, inputs, jobs, gap, seed):
        self._inputs = {name: getattr(dut, name) for name in inputs}
        assert all(set(job) <= set(inputs) for job in jobs)
        self._start = start
        self._jobs = list(jobs)
        self._gap = gap
        self._random = random.Random(f"anything {seed}")
        self._clock = 0
        self._next = 0
        self.clocks = []

    @property
    def finished(self):
        return len(self.clocks) == len(self._jobs)

    def _anything(self, signal):
        shape = Shape.cast(Value.cast(signal).shape())
        value = self._random.getrandbits(shape.width)
        return value - (value >> shape.width - 1 << shape.width) if shape.signed else value

    def drive(self, ctx):
        go = not self.finished and self._clock >= self._next
        job = self._jobs[len(self.clocks)] if go else {}
        ctx.set(self._start, go)
        for name, signal in self._inputs.items():
            ctx.set(signal, job[name] if name in job else self._anything(signal))
        if go:
            self.clocks.append(self._clock)
            self._next = self._clock + self._gap()
        self._clock += 1


class Results(Agent):
    """Whenever ``done`` is high, ``result`` goes into ``values`` and the clock into ``clocks``."""

    def __init__(self, done, result, expected):
        self._done = done
        self._result = result
        self._expected = expected
        self._clock = 0
        self.values, self.clocks = [], []

    @property
    def finished(self):
        return len(self.values) >= self._expected

    def sample(self, ctx):
        if ctx.get(self._done):
            self.values.append(ctx.get(self._result))
            self.clocks.append(self._clock)
        self._clock += 1
