"""The simulation engines by name."""

from __future__ import annotations

from dataclasses import replace

from ...golden.specification.errors import InputError
from .engine import Engine, EngineRun, Job, Progress
from .verilator_tool import ToolMissingError

#: Verilator where it works, else pysim.
AUTO = "auto"


def _pysim() -> Engine:
    from .pysim_engine import PysimEngine  # loads Amaranth: only those who simulate wait for it

    return PysimEngine()


def _verilator() -> Engine:
    from .verilator_engine import VerilatorEngine

    return VerilatorEngine()


#: What makes each engine, the fastest first.  The last one works everywhere, and writes waveforms.
ENGINES = {"verilator": _verilator, "pysim": _pysim}
ENGINE_NAMES = tuple(ENGINES)


class AutoEngine:
    """The fastest engine that works here; says so where that is not the first."""

    name = AUTO

    def run(self, job: Job, progress: Progress | None = None) -> EngineRun:
        notes: list[str] = []
        *fast, last = ENGINES
        for name in fast if job.waveform is None else []:
            try:
                return ENGINES[name]().run(job, progress)
            except ToolMissingError as missing:
                notes.append(f"{missing}; simulated with {last}, some hundred times slower")
        return replace(ENGINES[last]().run(job, progress), notes=tuple(notes))


def make_engine(name: str = AUTO) -> Engine:
    """The engine of that name; ``InputError`` for an unknown one, or one that cannot run here."""
    if name == AUTO:
        return AutoEngine()
    if name not in ENGINES:
        raise InputError(f"engine: {name!r} is none of {', '.join([AUTO, *ENGINES])}")
    try:
        return ENGINES[name]()
    except ToolMissingError as missing:
        raise InputError(f"--engine {name}: {missing}; or use --engine pysim") from None
