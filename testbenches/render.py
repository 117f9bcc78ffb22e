"""Draw a scene on a simulated machine, compare the frame with the golden picture, report."""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..golden.cycles.frame_clocks import predict_frame
from ..golden.scene_display_list import SceneDisplayList
from ..golden.specification.configuration import MachineConfiguration
from ..golden.specification.errors import InputError
from .engines.choose_engine import AUTO
from .engines.engine import Progress
from .frames.compare import compare
from .frames.node_counts import (
    count_differences,
    golden_traffic,
    node_figures,
    unit_differences,
)
from .frames.object_figures import object_figures
from .frames.region_figures import region_figures, sent_table
from .frames.rendering import Rendering
from .frames.responses import Simulation
from .frames.setup_timing import setup_timing
from .frames.simulation import simulate_frame
from .frames.wrong_counts import wrong_counts
from .machine_options import MachineOptions, machine_for_scene, resolution_warnings
from .support.atomic_output import atomic_file, atomic_folder, output_errors
from .support.machine_error import MachineError

#: Pretty, and some 20 seconds in the slowest engine.
DEFAULT_SCENE = "teapot:tessellation=3"


@dataclass(frozen=True)
class RenderOptions(MachineOptions):
    """What can be asked of a rendering: a machine, and how to simulate it.

    ``engine``            a name of ``engines.ENGINES`` or ``auto``
    ``random_memory``     seed of the memories' contents before boot; None: zero
    """

    engine: str = AUTO
    random_memory: int | None = None


@dataclass(frozen=True)
class RenderJob:
    """A scene and a machine, checked and ready to be simulated; see ``prepare_render``."""

    scene: SceneDisplayList
    configuration: MachineConfiguration
    options: RenderOptions
    command_line: str | None
    warnings: tuple[str, ...]
    began: float

    def expected_cycles(self) -> int:
        """About what the simulation takes: for the progress bar."""
        return predict_frame(self.configuration, self.scene.display_list,
                             setup_timing(self.configuration)).total

    def run(self, out: Path | None = None, waveform: Path | None = None,
            progress: Progress | None = None) -> Rendering:
        """Simulate, compare, and write the report to the folder ``out`` and a VCD to ``waveform``.

        Where these cannot be written is found out first.  Raises ``InputError`` for that, and
        ``MachineError`` where the machine does not deliver a frame; then no report is written,
        but the waveform is.
        """
        with ExitStack() as recordings:
            recording = None
            if waveform is not None:
                if self.options.engine == "verilator":
                    raise InputError("--waveform: the verilator engine records none; use --engine "
                                     "pysim")
                recording = recordings.enter_context(atomic_file(waveform, "--waveform"))
                recordings.enter_context(output_errors(waveform, "--waveform"))
            try:
                return self._reported(out, recording, progress)
            except MachineError as error:
                failure = error  # leave normally: the waveform shows how it came to this
        raise failure

    def _reported(self, out: Path | None, recording: Path | None,
                  progress: Progress | None) -> Rendering:
        if out is None:
            return self._judged(self._simulated(recording, progress))
        from .reports.frame_report import REPORT_FILES, write_report  # charts take a second to load

        with atomic_folder(out, REPORT_FILES) as folder:
            rendering = self._judged(self._simulated(recording, progress))
            rendering = replace(rendering, report=out / "report.html")
            with output_errors(out, "--out"):
                write_report(rendering, folder)
        return rendering

    def _simulated(self, recording: Path | None, progress: Progress | None) -> Simulation:
        observed = replace(self.configuration, observe=True)  # costs no clock
        return simulate_frame(observed, self.scene.display_list, engine=self.options.engine,
                              memory_seed=self.options.random_memory, waveform=recording,
                              progress=progress, table=sent_table(
                                  self.configuration, self.options.policy(self.configuration)))

    def _judged(self, simulation: Simulation) -> Rendering:
        configuration, display_list = self.configuration, self.scene.display_list
        comparison = compare(configuration, display_list, simulation)
        traffic = golden_traffic(configuration, display_list, simulation)
        warnings = [*self.warnings, *simulation.notes]
        if simulation.owned < simulation.total:
            warnings.append(f"{simulation.total - simulation.owned} of {simulation.total} memory "
                            "units belong to no processing element; their pixels are not compared")
        wrong = []
        if traffic is not None:
            nodes = node_figures(configuration, display_list, simulation, traffic)
            wrong += [*count_differences(nodes), *unit_differences(simulation, traffic)]
        regions = region_figures(configuration, display_list, simulation,
                                 policy=self.options.policy(configuration))
        objects = object_figures(configuration, display_list, simulation)
        wrong += wrong_counts(regions, objects)
        return Rendering(
            scene=self.scene,
            configuration=configuration,
            simulation=simulation,
            comparison=comparison,
            command_line=self.command_line,
            warnings=(*warnings, *wrong),
            wall_seconds=time.perf_counter() - self.began,
            traffic=traffic,
            regions=regions,
            objects=objects,
            wrong_counts=tuple(wrong),
        )


def prepare_render(scene: str | Path = DEFAULT_SCENE, options: RenderOptions | None = None,
                   command_line: str | None = None) -> RenderJob:
    """Load the scene and choose the machine.  Raises ``InputError`` for whatever cannot be used."""
    began = time.perf_counter()
    options = options or RenderOptions()
    loaded, configuration = machine_for_scene(scene, options)
    return RenderJob(
        scene=loaded,
        configuration=configuration,
        options=options,
        command_line=command_line,
        warnings=(*loaded.notes, *resolution_warnings(configuration)),
        began=began,
    )


def render(scene: str | Path = DEFAULT_SCENE, *, out: str | Path | None = None,
           waveform: str | Path | None = None, progress: Progress | None = None,
           **options: Any) -> Rendering:
    """Draw a scene on a simulated machine and compare every pixel with the golden model.

    ``scene``     a mesh file, a saved display list (``.npz``), ``hard:NAME`` or a built-in scene
    ``out``       folder of the report; None writes none
    ``waveform``  a VCD file of every signal; None writes none
    ``progress``  is called now and then with the cycles and the responses so far
    ``options``   the fields of ``RenderOptions`` and ``MachineOptions``: ``cards``, ``size``,
                  ``engine`` and the others that the command line has

    Raises ``InputError`` for whatever cannot be used or written, ``MachineError`` where the
    machine delivers no frame.  A frame that differs is no exception: see ``comparison``.

    >>> import cardcage
    >>> rendering = cardcage.render("tetra:depth=0", cards="PM", size=(16, 16), engine="pysim")
    >>> rendering.comparison.equal, rendering.comparison.pixels_compared
    (True, 256)
    """
    job = prepare_render(scene, RenderOptions(**options))
    return job.run(None if out is None else Path(out),
                   None if waveform is None else Path(waveform), progress)
