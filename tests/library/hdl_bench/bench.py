"""A bench in one loop over the clocks, made of agents."""

import gc
import warnings

import pytest
from amaranth.hdl import Module, UnusedElaboratable
from amaranth.sim import Simulator


class Agent:
    """One thing around a component.  In every clock ``drive`` sets inputs, agent after agent, and
    when all have settled ``sample`` looks, just before the clock edge."""

    #: The simulation goes on until every agent says so.
    finished = True

    def drive(self, ctx):
        pass

    def sample(self, ctx):
        pass


class Watch(Agent):
    """Calls ``function(ctx, clock)`` before every clock edge; asks for at least ``clocks``."""

    def __init__(self, function, clocks=0):
        self._function = function
        self._clocks = clocks
        self._clock = 0

    @property
    def finished(self):
        return self._clock >= self._clocks

    def sample(self, ctx):
        self._function(ctx, self._clock)
        self._clock += 1


class Drive(Agent):
    """Calls ``function(ctx, clock)`` at the beginning of every clock, to set inputs."""

    def __init__(self, function, clocks=0):
        self._function = function
        self._clocks = clocks
        self._clock = 0

    @property
    def finished(self):
        return self._clock >= self._clocks

    def drive(self, ctx):
        self._function(ctx, self._clock)
        self._clock += 1


class Until(Agent):
    """Goes on until ``count()`` has reached ``wanted``."""

    def __init__(self, count, wanted):
        self._count = count
        self._wanted = wanted

    @property
    def finished(self):
        return self._count() >= self._wanted


def simulate(component, *agents, limit=20_000, after=0):
    """Clock ``component`` until every agent is finished and ``after`` clocks more.

    Returns the clocks it took.  ``AssertionError`` beyond ``limit``: it hangs.
    """
    simulator = Simulator(component)
    simulator.add_clock(1e-6)
    elapsed = None

    async def bench(ctx):
        nonlocal elapsed
        left = after
        for clock in range(limit):
            for agent in agents:
                agent.drive(ctx)
            for agent in agents:
                agent.sample(ctx)
            await ctx.tick()
            if all(agent.finished for agent in agents):
                if left == 0:
                    elapsed = clock + 1
                    return
                left -= 1
        waiting = [type(agent).__name__ for agent in agents if not agent.finished]
        raise AssertionError(f"no end after {limit} clocks: {', '.join(waiting)} not finished")

    simulator.add_testbench(bench)
    simulator.run()
    return elapsed


def evaluate(component, steps):
    """Run ``steps(ctx)`` once on a combinational ``component``."""
    module = Module()
    module.submodules.dut = component
    simulator = Simulator(module)

    async def bench(ctx):
        steps(ctx)

    simulator.add_testbench(bench)
    simulator.run()


def rejects(component, match, **arguments):
    """``component(**arguments)`` raises a ``ValueError`` whose message ``match``es.

    Amaranth warns when a component that was begun is not used; here that is the point.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusedElaboratable)
        with pytest.raises(ValueError, match=match) as raised:
            component(**arguments)
        del raised
        gc.collect()


class Service(Agent):
    """Pulses ``start`` ``rounds`` times, each after the last ``done`` and a pause.

    ``started``, ``ended`` list the clocks.  ``done`` is asserted to come once for every start;
    ``at_done(ctx)`` looks around then.
    """

    def __init__(self, dut, rounds=1, pause=lambda: 0, at_done=lambda ctx: None):
        self._dut = dut
        self._rounds = rounds
        self._pause = pause
        self._wait = pause()
        self._at_done = at_done
        self._clock = 0
        self.started, self.ended = [], []

    @property
    def finished(self):
        return len(self.ended) == self._rounds

    def drive(self, ctx):
        idle = len(self.started) == len(self.ended) < self._rounds
        go = idle and self._wait == 0
        if idle and self._wait:
            self._wait -= 1
        ctx.set(self._dut.start, go)
        if go:
            self.started.append(self._clock)

    def sample(self, ctx):
        if ctx.get(self._dut.done):
            assert len(self.ended) < len(self.started), f"clock {self._clock}: done, not started"
            assert self.started[-1] < self._clock
            self.ended.append(self._clock)
            self._wait = self._pause()
            self._at_done(ctx)
        self._clock += 1

    @property
    def clocks(self):
        """From each start to its done, the clock of the start not counted."""
        return [end - start for start, end in zip(self.started, self.ended, strict=True)]
