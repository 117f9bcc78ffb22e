"""What a host must not send, sent for minutes: ``python -m testbenches.studies.word_fuzz``."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import click

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.testbenches.engines.choose_engine import make_engine
from cardcage.testbenches.engines.engine import Engine, EngineRun

from .stray_words import check_trial, make_trial

#: Machine → its fields; without width and height those that ``plan`` chooses for its scene.
MACHINES: dict[str, dict[str, Any]] = {
    "PM": {"cards": "PM", "width": 4, "height": 4},
    "PMPM": {"cards": "PMPM", "width": 8, "height": 8},
    "PMPMMM": {"cards": "PMPMMM", "width": 8, "height": 8, "fifo_depth": 2},
    "4x(PM)": {"cards": "4x(PM)", "width": 8, "height": 8},
    "not square": {"cards": "PPMMMPM", "width": 6, "height": 5, "shading": "flat"},
    "coarser": {"cards": "PMM", "width": 9, "height": 7, "words": 10},
    "squares": {"cards": "2x(PMM)", "width": 9, "height": 8, "block": 2},
    "lines": {"cards": "2x(PMM)", "width": 7, "height": 8, "lines": True},
    "skew": {"cards": "2x(PMM)", "width": 8, "height": 8, "skew": True},
    "two ports": {"cards": "MMPMPM", "width": 8, "height": 8, "memory_ports": 2,
                  "allow_orphans": True},
    "set-up": {"cards": "PMPM", "width": 8, "height": 8, "setup": "hardware",
               "setup_interval": 8},
    "chain": {"cards": "2x(PMC)", "width": 6, "height": 5},
    "tree": {"cards": "2x(PMT)", "width": 8, "height": 4, "shading": "flat"},
    "bus": {"cards": "2x(PMS)F", "width": 6, "height": 5, "tag_bits": 3},
    "regions": {"cards": "3x(PM)", "width": 8, "height": 8, "regions": (4, 4)},
    "regions, hardware": {"cards": "2x(PMM)", "width": 9, "height": 7, "regions": (3, 2),
                          "balancer": "hardware", "shading": "flat"},
    "objects": {"cards": "2x(PMC)", "setup": "hardware", "setup_interval": 8, "objects": "nodes"},
    "objects passed on": {"cards": "3x(PM)", "setup": "hardware", "setup_interval": 8,
                          "objects": "elements", "regions": (2, 4), "balance": "static"},
    "planned": {"cards": "2x(PM)"},
    "planned squares": {"cards": "4x(PM)", "block": 2},
    "larger": {"cards": "PMMPMM", "width": 48, "height": 40},
    "larger set-up": {"cards": "PMMMPM", "width": 33, "height": 30, "setup": "hardware"},
}

#: Those that are worth compiling; pysim is quicker for the others, model and all.
LARGER = ("larger", "larger set-up", "objects", "objects passed on")


@cache
def machine(name: str) -> tuple[MachineConfiguration, tuple[DisplayList, ...]]:
    """A machine of ``MACHINES`` and the good frames it draws."""
    fields: dict[str, Any] = {"clocks_per_pixel": 2, **MACHINES[name]}
    if "objects" in fields:
        only = make_display_list("three_cubes", width=8, height=8).display_list
        return plan(only, packet=1, **fields).configuration, (only,)
    if "width" not in fields:
        only = make_display_list("tetra:depth=1", width=8, height=8).display_list
        planned = plan(only, **fields).configuration
        # A bit more than the scene needs: edges may leave the screen, but only to the right.
        return replace(planned, edge_column_bits=planned.x_bits), (only,)
    size = {side: fields[side] for side in ("width", "height")}
    options: dict[str, Any] = {"shading": "flat"} if "shading" in fields else {}
    lists = tuple(make_display_list(f"random:n={n},size={side},seed={n}", **size,
                                    **options).display_list
                  for n, side in ((6, 3), (3, 7)))
    return MachineConfiguration(**fields), lists


def run_trial(name: str, seed: int, engine: Engine, *, resets: int = 2, rounds: int = 2,
              stray: int = 40) -> EngineRun:
    """One trial on the machine ``name``; ``AssertionError`` or ``TimeoutError`` where it fails."""
    configuration, lists = machine(name)
    trial = make_trial(configuration, lists, seed, resets=resets, rounds=rounds, stray=stray)
    run = engine.run(trial.job)
    check_trial(trial, run)
    return run


@click.command()
@click.option("--minutes", type=click.FloatRange(0, min_open=True), default=1.0,
              show_default=True)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True,
              help="The first; each round over the machines takes the next.")
@click.option("--machine", "names", type=click.Choice(list(MACHINES)), multiple=True,
              help="May be given several times.  [default: all]")
@click.option("--engine", "chosen", type=click.Choice(["verilator", "pysim"]),
              help="[default: verilator for the larger machines]")
def main(minutes: float, seed: int, names: Sequence[str], chosen: str | None) -> None:
    """Random words, good ones with a bit flipped, frames cut short, and resets at any clock; then
    good frames, which must be exact, and the machine must answer every word in bounded time.

    Exit status 1 where one is not: the line says the seed, with which to go on or try again.

    \b
    Examples:
      python -m testbenches.studies.word_fuzz --minutes 10
      python -m testbenches.studies.word_fuzz --seed 7 --machine PMPM
    """
    began, trials, clocks, words = time.monotonic(), Counter[str](), 0, 0
    first = seed
    while time.monotonic() - began < 60 * minutes:
        for name in names or MACHINES:
            engine = make_engine(chosen or ("verilator" if name in LARGER else "pysim"))
            try:
                run = run_trial(name, seed, engine)
            except (AssertionError, TimeoutError) as error:
                click.echo(f"seed {seed}, machine {name}: {error}", err=True)
                sys.exit(1)
            trials[name] += 1
            clocks += run.cycles
            words += 0 if run.accepted is None else len(run.accepted)
        seed += 1
        click.echo(f"seed {seed - 1}: {trials.total():,} trials, {words:,} words, "
                   f"{clocks:,} clocks")
    click.echo(f"seeds {first} to {seed - 1} on {len(trials)} machines: {trials.total():,} "
               f"trials, {words:,} words, {clocks:,} clocks; every good frame exact; "
               f"go on with --seed {seed}")


if __name__ == "__main__":
    main(prog_name="python -m testbenches.studies.word_fuzz")
