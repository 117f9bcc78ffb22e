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
