"""The machine in Amaranth's own simulator."""

from __future__ import annotations

import random
import time
from contextlib import nullcontext
from typing import Any

import numpy as np
from amaranth.hdl import Cat, ClockDomain, Const, Module, Shape, Value
from amaranth.sim import Simulator

from ...golden.specification.commands import ResponseKind
from ...hdl.machine import Machine
from .activity_record import ActivityWatch
from .engine import EngineRun, Job, Progress
from .host_pauses import Pace
from .video_monitor import VideoMonitor

#: Cycles between two calls of the progress function.
PROGRESS_CYCLES = 256


class PysimEngine:
    """Runs anywhere Python does, and writes waveforms; a few thousand cycles a second."""

    name = "pysim"

    def run(self, job: Job, progress: Progress | None = None) -> EngineRun:
        return _Run(job, progress, Machine(configuration=job.configuration)).simulate()


class _Run:
    """One simulation: a host that sends, a host that receives, a screen."""

    def __init__(self, job: Job, progress: Progress | None, machine: Machine) -> None:
        self.job = job
        self.machine = machine
        self.domain = ClockDomain("sync")
        self.progress = progress
        self.monitor = VideoMonitor(job.configuration)
        self.responses: list[tuple[ResponseKind, int, int]] = []
        self.commands = list(job.commands)
        self.accepted: list[int] = []
        self.resets = list(reversed(job.resets))  # the next one is the last
        # Since the last reset: the words sent, and how many responses had come before it.
        self.sent = 0
        self.outdated = 0
        self.shown_cycle: int | None = None
        self.cycle = 0
        self.watch = (ActivityWatch(job.configuration.processing_elements)
                      if job.configuration.observe else None)

    def simulate(self) -> EngineRun:
        simulator = Simulator(self._with_reset() if self.resets else self.machine)
        simulator.add_clock(1e-6)
        simulator.add_testbench(self._bench)
        began = time.perf_counter()
        recording = (simulator.write_vcd(str(self.job.waveform)) if self.job.waveform
                     else nullcontext())
        with recording:
            simulator.run()
        return EngineRun(self.responses, self.monitor.scans, self.cycle,
                         time.perf_counter() - began, engine=PysimEngine.name,
                         accepted=np.array(self.accepted, np.int64),
                         activity=self.watch.records if self.watch else ())

    def _with_reset(self) -> Module:
        """The machine in a clock domain whose reset is at hand."""
        m = Module()
        m.domains.sync = self.domain
        m.submodules.machine = self.machine
        return m

    def _scramble(self, ctx: Any) -> None:
        """Every memory word random, as after power-on."""
        source = random.Random(self.job.memory_seed)
        for storage in self.machine.storages:
            words = storage.data
            width = Shape.cast(words.shape).width
            for address in range(words.depth):
                ctx.set(Value.cast(words[address]), source.getrandbits(width))

    async def _bench(self, ctx: Any) -> None:
        """Host and screen in one loop over the clocks: several benches would cost more time."""
        if self.job.memory_seed is not None:
            self._scramble(ctx)
        commands, responses, pins = (self.machine.commands, self.machine.responses,
                                     self.machine.pins)
        send = Pace(self.job.stall_seed, salt=0)
        receive = Pace(self.job.stall_seed, salt=1)

        def next_word() -> None:
            if self.sent == len(self.commands):
                send.stop()
            else:
                ctx.set(commands.payload, self.commands[self.sent])
                send.go()

        def reset_if(at: int) -> None:
            if self.resets:
                ctx.set(self.domain.rst, self.resets[-1].cycle == at)

        reset_if(1)
        next_word()
        receive.go()
        ctx.set(commands.valid, send.high)
        ctx.set(responses.ready, receive.high)
        samples = ctx.tick().sample(
            commands.ready, responses.valid, responses.payload, pins.pixel, pins.active,
            pins.vertical_sync, Cat(pins.red, pins.green, pins.blue), self._activity_lines())
        async for (_, _, taken, given, response, is_pixel, active, in_sync, color,
                   activity) in samples:
            self.cycle += 1
            offered, open_ = send.high, receive.high
            if self.watch is not None:
                self.watch.clock(
                    self.cycle, activity,
                    self.commands[self.sent] if taken and offered else None,
                    response.kind if given and open_ else None)
            if taken and offered:
                self.accepted.append(self.cycle)
                self.sent += 1
                next_word()
            else:
                send.wait()
            if given and open_:
                self._receive(response)
                receive.go()
            else:
                receive.wait()
            if is_pixel:
                self.monitor.sample(self.cycle, active, in_sync, color)
                if self._finished():
                    return
            if self.resets:
                if self.resets[-1].cycle == self.cycle:
                    ctx.set(self.domain.rst, 0)
                    self._forget()
                    next_word()
                reset_if(self.cycle + 1)
            if send.high != offered:  # setting a signal costs time, even to what it is
                ctx.set(commands.valid, send.high)
            if receive.high != open_:
                ctx.set(responses.ready, receive.high)
            if self.cycle % PROGRESS_CYCLES == 0:
                self._report()

    def _forget(self) -> None:
        """This clock was a reset: what was sent and received before is of no account."""
        self.sent = self.resets.pop().command
        self.outdated = len(self.responses)
        self.shown_cycle = None
        self.monitor.restart()

    def _activity_lines(self) -> Value:
        return Value.cast(self.machine.activity) if self.watch else Const(0)

    def _receive(self, response: Any) -> None:
        kind = ResponseKind(response.kind)
        self.responses.append((kind, response.value, self.cycle))
        if kind == ResponseKind.FRAME_SHOWN:
            self.shown_cycle = self.cycle

    def _report(self) -> None:
        if self.progress is not None:
            self.progress(self.cycle, len(self.responses))
        if self.job.maximum_cycles is not None and self.cycle > self.job.maximum_cycles:
            raise TimeoutError(
                f"no end after {self.cycle} cycles: {self.sent} of "
                f"{len(self.commands)} commands taken, {self._received} of "
                f"{self.job.responses} responses")

    @property
    def _received(self) -> int:
        return len(self.responses) - self.outdated

    def _finished(self) -> bool:
        if (self.resets or self.sent < len(self.commands)
                or self._received < self.job.responses):
            return False
        if self.shown_cycle is None:
            return True
        return bool(self.monitor.scans) and self.monitor.scans[-1].cycle > self.shown_cycle
