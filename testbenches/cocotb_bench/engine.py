"""The exported Verilog in a Verilog simulator, driven by cocotb."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import weakref
from pathlib import Path
from typing import Any

from ...golden.specification.commands import ResponseKind
from ...golden.specification.errors import InputError
from ..engines.engine import EngineRun, Job, Progress
from ..engines.verilator_tool import ToolMissingError
from ..export.verilog import machine_verilog
from .exchange import FOLDER_VARIABLE, read_outcome, read_progress, write_job
from .simulators import Simulator, find_simulator
from .violation import ProtocolError

#: Seconds between two looks at the progress.
_POLL_SECONDS = 0.1


class CocotbEngine:
    """Builds the Verilog once per text and keeps it as long as the engine lives.

    ``verilog`` replaces the export of the job's configuration.  With Icarus every memory is
    unknown at power-on, whatever the job's ``memory_seed``; with Verilator it is as the job says.
    Waveforms are those of the simulator: ``.fst`` from Icarus, ``.vcd`` from Verilator.

    Raises ``ToolMissingError`` where cocotb or the simulator is missing or fails, or cannot build
    the Verilog, ``ProtocolError`` where the machine breaks a documented rule, ``TimeoutError``
    where it hangs, ``OSError`` where the system has no room for its files.
    """

    def __init__(self, simulator: str = "verilator", verilog: str | None = None) -> None:
        self.name = "cocotb"
        self._simulator = find_simulator(simulator)
        self._verilog = verilog
        self._folder = tempfile.mkdtemp(prefix="cardcage-cocotb-")
        weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        self._built: dict[tuple[str, bool], Path] = {}

    def run(self, job: Job, progress: Progress | None = None) -> EngineRun:
        waves = job.waveform is not None
        if job.waveform is not None and job.waveform.suffix != self._simulator.wave_suffix:
            raise InputError(f"{job.waveform}: {self._simulator.name} writes waveforms as "
                             f"{self._simulator.wave_suffix}")
        began = time.perf_counter()
        verilog = self._verilog or machine_verilog(job.configuration)
        fresh = (verilog, waves) not in self._built
        if fresh:
            self._built[verilog, waves] = self._build(verilog, waves)
        build_folder = self._built[verilog, waves]
        built = time.perf_counter()
        with tempfile.TemporaryDirectory(dir=self._folder) as name:
            run = self._simulate(job, Path(name), build_folder, progress)
        return EngineRun(run.responses, run.scans, run.cycles, time.perf_counter() - built,
                         build_seconds=built - began if fresh else 0.0, engine=self._described)

    @property
    def _described(self) -> str:
        return f"{self.name} on {self._simulator.name}"

    def _build(self, verilog: str, waves: bool) -> Path:
        folder = Path(tempfile.mkdtemp(dir=self._folder))
        source = folder / "machine.v"
        source.write_text(verilog, encoding="utf-8")
        status, log = _child(self._simulator, folder, {
            "action": "build", "verilog": str(source), "build_folder": str(folder / "build"),
            "arguments": list(self._simulator.build_arguments), "waves": waves})
        if status:
            raise ToolMissingError(f"{self._simulator.name} cannot build the Verilog: "
                              f"{_first_error(log)}")
        return folder / "build"

    def _simulate(self, job: Job, folder: Path, build_folder: Path,
                  progress: Progress | None) -> EngineRun:
        write_job(folder, job)
        status, log = _child(self._simulator, folder, {
            "action": "test", "folder": str(folder), "build_folder": str(build_folder),
            "plus_arguments": self._simulator.plus_arguments(job.memory_seed),
            "waves": job.waveform is not None}, progress)
        if job.waveform is not None:
            for place in (folder / "dump.vcd", build_folder / "machine.fst"):
                if place.exists():
                    shutil.move(place, job.waveform)
        outcome = read_outcome(folder)
        if outcome is None:
            raise ToolMissingError(f"{self._simulator.name} ended with status {status} and no "
                                   f"result: {_first_error(log)}")
        if outcome.end == "violation":
            raise ProtocolError(outcome.message)
        if outcome.end == "timeout":
            raise TimeoutError(outcome.message)
        return EngineRun([(ResponseKind(kind), value, cycle)
                          for kind, value, cycle in outcome.responses],
                         outcome.scans, outcome.cycles, 0.0)


def _child(simulator: Simulator, folder: Path, request: dict[str, Any],
           progress: Progress | None = None) -> tuple[int, str]:
    """Run ``runner`` in ``folder``; its exit status and all it said."""
    described, log = folder / "request.json", folder / "log.txt"
    described.write_text(json.dumps(request | {"simulator": simulator.name}))
    with log.open("w") as output, subprocess.Popen(
            [sys.executable, "-m", f"{__package__}.runner", str(described)], cwd=folder,
            env=simulator.environment | {FOLDER_VARIABLE: str(folder)}, stdout=output,
            stderr=subprocess.STDOUT, start_new_session=True) as process:
        try:
            while process.poll() is None:
                try:
                    process.wait(_POLL_SECONDS)
                except subprocess.TimeoutExpired:
                    seen = read_progress(folder)
                    if seen is not None and progress is not None:
                        progress(*seen)
        except BaseException:
            # The simulator and the compilers are its children: end them all.
            os.killpg(process.pid, signal.SIGKILL)
            raise
    return process.returncode, log.read_text(errors="replace")


def _first_error(log: str) -> str:
    """The line that says most about why a tool gave up."""
    lines = [line.strip() for line in log.splitlines() if line.strip()]
    errors = [line for line in lines if "rror" in line] or lines[-1:]
    return errors[0] if errors else "it said nothing"
