"""The cocotb test: host and screen of a ``machine`` in Verilog, with every check on its pins.

Runs inside the simulator; the environment variable CARDCAGE_BENCH names the folder with the job
and for the outcome.  The clock falls, the host moves its signals, everything settles, and what
then stands on the ports is what the next rising edge takes: no simulator can disagree about the
order within a clock edge.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Literal

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, ReadOnly

from ...golden.specification import commands
from ...golden.specification.commands import Opcode, ResponseKind
from ...golden.specification.ranges import CHANNEL_BITS
from ..engines.engine import Job
from ..engines.host_pauses import Pace
from ..engines.video_monitor import VideoMonitor
from .conversation_check import ConversationCheck
from .exchange import FOLDER_VARIABLE, Outcome, read_job, write_outcome, write_progress
from .pin_check import PinCheck, Pins
from .scan_check import check_scans, masked, owned_pixels
from .stream_check import StreamCheck
from .violation import ProtocolError

RESET_CLOCKS = 3
PROGRESS_CYCLES = 1024

#: Clocks from a memory unit's read to the pins, and how long a pixel stays there, at most.
PIN_LATENCY = 4
_PIXELS_HELD = 2
_PORTS = (
    "clk", "rst", "commands__valid", "commands__ready", "commands__payload", "responses__valid",
    "responses__ready", "responses__payload", "pins__pixel", "pins__active",
    "pins__horizontal_sync", "pins__vertical_sync", "pins__red", "pins__green", "pins__blue")


@cocotb.test()
async def frame(dut: Any) -> None:
    """The job's commands pass, everything owed comes back, and no rule is broken on the way."""
    folder = Path(os.environ[FOLDER_VARIABLE])
    bench = _Bench(dut, read_job(folder), folder)

    def report(end: Literal["done", "violation", "timeout"], message: object = "") -> None:
        write_outcome(folder, Outcome(end, str(message), bench.cycle, bench.responses,
                                      bench.monitor.scans))

    try:
        await bench.run()
    except AssertionError as violation:  # of ours, or of the video monitor's
        report("violation", violation)
        raise
    except TimeoutError as timeout:
        report("timeout", timeout)
        raise
    report("done")


def _level(handle: Any) -> int | None:
    """A port's value; None where any of its bits is X or Z."""
    value = handle.value
    return int(value) if value.is_resolvable else None


class _Bench:
    """One simulation."""

    def __init__(self, dut: Any, job: Job, folder: Path) -> None:
        self.dut, self.job, self.folder = dut, job, folder
        self.monitor = VideoMonitor(job.configuration)
        self.responses: list[tuple[int, int, int]] = []
        self.cycle = 0
        self._sent = 0
        self._booted: int | None = None
        self._owned = owned_pixels(job.configuration)
        self._payload = 0
        self._all_ones = (1 << commands.command_bits(job.configuration)) - 1
        self._ended: list[int] = []
        self._shown: list[int] = []
        self._send, self._receive = Pace(job.stall_seed, 0), Pace(job.stall_seed, 1)
        self._stream = StreamCheck("responses")
        self._conversation = ConversationCheck(job.configuration, job.commands)
        self._pins = PinCheck(job.configuration)

    async def run(self) -> None:
        self._check_ports()
        dut = self.dut
        dut.rst.value = 1
        dut.commands__payload.value = 0
        dut.commands__valid.value = dut.responses__ready.value = 0
        Clock(dut.clk, 2, unit="ns").start()
        for _ in range(RESET_CLOCKS):
            await FallingEdge(dut.clk)
        dut.rst.value = 0
        self._offer()
        self._receive.go()
        while True:
            self._drive()
            await ReadOnly()
            self.cycle += 1
            self._exchange_words()
            if self._watch_pins() and self._finished():
                break
            if self.cycle % PROGRESS_CYCLES == 0:
                write_progress(self.folder, self.cycle, len(self.responses))
            if self.job.maximum_cycles is not None and self.cycle > self.job.maximum_cycles:
                raise TimeoutError(
                    f"no end after {self.cycle} cycles: {self._sent} of {len(self.job.commands)} "
                    f"commands taken, {len(self.responses)} of {self.job.responses} responses")
            await FallingEdge(dut.clk)
        if self._booted is not None:
            check_scans(masked(self.monitor.scans, self._owned), self._clear_from, self._ended,
                        self._shown)

    def _check_ports(self) -> None:
        for name in _PORTS:
            if not hasattr(self.dut, name):
                raise ProtocolError(f"the Verilog has no port {name}: it is no machine")
        expected = commands.command_bits(self.job.configuration)
        if len(self.dut.commands__payload) != expected:
            raise ProtocolError(
                f"the Verilog has commands of {len(self.dut.commands__payload)} bits, this "
                f"configuration of {expected}: they are of different machines")

    def _drive(self) -> None:
        dut = self.dut
        dut.commands__valid.value = self._send.high
        dut.responses__ready.value = self._receive.high
        if self._sent < len(self.job.commands):
            word = self.job.commands[self._sent]
            if self.job.stall_seed is not None and not self._send.high:
                word ^= self._all_ones  # nobody may look at it
            if word != self._payload:
                dut.commands__payload.value = self._payload = word

    def _offer(self) -> None:
        if self._sent < len(self.job.commands):
            self._send.go()
        else:
            self._send.stop()

    def _exchange_words(self) -> None:
        """What passes on the two streams at the coming edge."""
        dut = self.dut
        taken = _level(dut.commands__ready)
        if taken is None:
            raise ProtocolError(f"cycle {self.cycle}: commands: ready is unknown")
        valid = _level(dut.responses__valid)
        word = _level(dut.responses__payload) if valid else None
        given = self._stream.sample(self.cycle, valid, self._receive.high, word)
        if taken and self._send.high:
            self._conversation.command(self.cycle)
            if commands.opcode_of(self.job.commands[self._sent]) == Opcode.FRAME_END:
                self._ended.append(self.cycle)
            self._sent += 1
            self._offer()
        else:
            self._send.wait()
        if given:
            assert word is not None  # as the check of the stream found
            self._respond(*commands.unpack_response(word))
            self._receive.go()
        else:
            self._receive.wait()

    def _respond(self, kind: int, value: int) -> None:
        self._conversation.response(self.cycle, kind, value)
        self.responses.append((kind, value, self.cycle))
        if kind == ResponseKind.BOOTED:
            self._booted = self.cycle
        elif kind == ResponseKind.FRAME_SHOWN:
            self._shown.append(self.cycle)

    @property
    def _clear_from(self) -> int:
        """The cycle from which no pixel on the pins was read before the pictures were black."""
        assert self._booted is not None
        held = _PIXELS_HELD * self.job.configuration.clocks_per_pixel
        chain = self.job.configuration.nodes  # a pixel may pass so many merge cards
        return self._booted + PIN_LATENCY + chain + held

    def _watch_pins(self) -> bool:
        """Whether this was the first clock of a pixel."""
        dut = self.dut
        pixel = _level(dut.pins__pixel)
        channels = [_level(pin) for pin in (dut.pins__red, dut.pins__green, dut.pins__blue)]
        known = [level for level in channels if level is not None]
        color = None if len(known) < len(channels) else sum(
            level << CHANNEL_BITS * place for place, level in enumerate(known))
        pins = Pins(_level(dut.pins__active), _level(dut.pins__horizontal_sync),
                    _level(dut.pins__vertical_sync), color)
        self._pins.sample(self.cycle, pixel, pins)
        if pixel:
            assert pins.active is not None and pins.vertical_sync is not None  # so says the check
            if color is None:
                if (self._owned.all() and self._booted is not None
                        and self.cycle >= self._clear_from):
                    raise ProtocolError(f"cycle {self.cycle}: pins: a colour is unknown after "
                                            "the boot made the pictures black")
                color = 0
            self.monitor.sample(self.cycle, pins.active, pins.vertical_sync, color)
        return bool(pixel)

    def _finished(self) -> bool:
        if self._sent < len(self.job.commands) or len(self.responses) < self.job.responses:
            return False
        if not self._shown:
            return True
        return bool(self.monitor.scans) and self.monitor.scans[-1].cycle > self._shown[-1]
