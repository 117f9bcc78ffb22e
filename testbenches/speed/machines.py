"""The machines that ``cardcage bench`` measures: what differs between them, multiplied out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from ...golden.planning.on_screen_widths import on_screen_widths
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.regions import Balance
from ..machine_options import SETUPS, SetupChoice
from .cases import DEPTH_BITS, SIZE, SUB_BITS

CLOCKS_PER_PIXEL = 4

@dataclass(frozen=True)
class MachineAxes:
    """What to vary; every combination is a machine.

    ``elements``  processing elements
    ``units``     memory units of each
    ``ports``     of each memory unit
    ``setups``    keys of ``machine_options.SETUPS``
    ``blocks``    pixels a side that neighbour in one processing element; 1 is the interlace of 1979
    ``skew``      units of a processing element alternate along its rows, too: all machines, none,
                  or None: those whose units have one port, where blocks are of one pixel
    ``lines``     whether processing elements have whole lines in turn, in place of blocks of one
                  pixel
    ``fifos``     triangles that a processing element can hold in waiting
    ``regions``   columns and rows of regions of the screen that are dealt out to processing
                  elements, by what the same picture costs them; None interlaces pixels
    ``balances``  what is counted of regions
    """

    elements: Sequence[int] = (1, 16)
    units: Sequence[int] = (2,)
    ports: Sequence[int] = (2,)
    setups: Sequence[SetupChoice] = ("host",)
    blocks: Sequence[int] = (1,)
    skew: bool | None = None
    lines: Sequence[bool] = (False,)
    fifos: Sequence[int] = (MachineConfiguration.fifo_depth,)
    regions: Sequence[tuple[int, int] | None] = (None,)
    balances: Sequence[Balance] = (MachineConfiguration.balance,)


#: The machines of ``cardcage bench --all``.
ALL_MACHINES = MachineAxes(
    elements=(1, 4, 16), units=(1, 2), ports=(1, 2), setups=tuple(SETUPS),
    blocks=(1, 4))


@dataclass(frozen=True)
class BenchMachine:
    """A machine, exact for any triangle on the screen, and what the table calls it."""

    elements: int
    units: int
    ports: int
    setup: SetupChoice
    block: int
    skew: bool
    fifo: int
    configuration: MachineConfiguration
    regions: tuple[int, int] | None = None
    lines: bool = False

    @property
    def label(self) -> str:
        cards = f"{self.elements}x(P{'M' * self.units})"
        words = [cards, f"{self.ports} port{'s' * (self.ports > 1)}",
                 "set-up by the host" if self.setup == "host" else f"{self.setup} set-up"]
        if self.block > 1:
            words.append(f"blocks of {self.block}")
        if self.skew:
            words.append("skewed")
        if self.lines:
            words.append("lines in turn")
        if self.fifo != MachineConfiguration.fifo_depth:
            words.append(f"FIFO of {self.fifo}")
        if self.regions is not None:
            columns, rows = self.regions
            words.append(f"{columns}x{rows} regions, {self.configuration.balance}")
        return ", ".join(words)


def bench_machines(axes: MachineAxes) -> list[BenchMachine]:
    """Every combination of ``axes``.  Raises ``InputError`` where there is no such machine."""
    return [_machine(*chosen) for chosen in product(
        axes.elements, axes.units, axes.ports, axes.setups, axes.blocks, (axes.skew,),
        axes.fifos, [(regions, balance) for regions in axes.regions
                     for balance in (axes.balances if regions else axes.balances[:1])],
        axes.lines)]


def varied(machines: Sequence[BenchMachine]) -> list[str]:
    """The numbers in which they differ, first what a plot is drawn along."""
    return [name for name in ("fifo", "block", "elements")
            if len({getattr(machine, name) for machine in machines}) > 1]


def beside_interlace(machines: Sequence[BenchMachine]) -> bool:
    """Some deal regions out, others interlace pixels."""
    return len({machine.regions is None for machine in machines}) == 2


def _machine(elements: int, units: int, ports: int, setup: SetupChoice, block: int,
             skew: bool | None, fifo: int,
             dealing: tuple[tuple[int, int] | None, Balance], lines: bool) -> BenchMachine:
    regions, balance = dealing
    if skew is None:
        skew = ports == 1 and units > 1 and block == 1 and regions is None and not lines
    dealt: dict[str, Any] = {} if regions is None else {"regions": regions, "balance": balance}
    configuration = MachineConfiguration(
        cards=f"{elements}x(P{'M' * units})", width=SIZE, height=SIZE, sub_bits=SUB_BITS,
        depth_bits=DEPTH_BITS, shading="flat", clocks_per_pixel=CLOCKS_PER_PIXEL, fifo_depth=fifo,
        observe=True,  # costs no clock
        memory_ports=ports, block=block, skew=skew, lines=lines, **SETUPS[setup], **dealt,
        **on_screen_widths(SIZE, SIZE, SUB_BITS))
    return BenchMachine(elements, units, ports, setup, block, skew, fifo, configuration, regions,
                        lines)
