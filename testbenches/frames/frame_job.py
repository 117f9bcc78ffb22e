"""One frame as a job for an engine: the commands, and how much comes back."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...golden.cycles.frame_clocks import most_frame_clocks
from ...golden.objects.object_words import frame_words, made_of_objects, mesh_words
from ...golden.organisations.organisation_of import organisation_of
from ...golden.planning.scene_needs import fitted
from ...golden.reference import triangle_words
from ...golden.reference.triangle_setup import in_finer_words, prepare
from ...golden.specification import commands
from ...golden.specification.commands import Opcode
from ...golden.specification.configuration import MachineConfiguration
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from ..engines.engine import Job
from .conversation import responses_owed
from .region_host import region_readings, table_commands


def frame_commands(configuration: MachineConfiguration, display_list: DisplayList,
                   fraction_bits: int | None = None, *,
                   table: NDArray[np.int64] | None = None) -> list[int]:
    """Frame start, triangles, frame end; where nodes have list memories, these are loaded first,
    and drawn in the triangles' place; before the frame the ``table`` by which regions are dealt
    out, unless it is that of the frame before; where the machine makes triangles of objects, its
    meshes are loaded first, and objects come in the triangles' place.

    Triangles come in the order in which nodes share them.
    Where the machine has no set-up of its own the host does it here, at the resolution that the
    machine reports.  With ``fraction_bits``, fewer than the machine's, the host does it with planes
    rounded to these: the machine then draws the picture of one that has no more, value for value
    and clock for clock, if its words have the integer bits for the greater error.  Raises
    ``InputError`` for a list that is too wide for the machine, and for a machine that draws
    nothing.  Lists of a machine that sets up take vertices alone, so what the host has prepared
    goes round them.
    """
    fault = organisation_of(configuration).fault
    if fault is not None:
        raise InputError(f"cards: {configuration.cards}: such a machine boots and draws nothing, "
                         f"fault {int(fault)} ({fault.name}); put as many memory units into each "
                         "node, a power of two")
    dealing = [] if table is None else table_commands(configuration, table)
    if configuration.objects is not None and fraction_bits is None:
        return [*dealing, *object_commands(configuration, fitted(configuration, display_list))]
    triangles = _triangle_words(configuration, display_list, fraction_bits)
    start, end = commands.frame_start(display_list.background), commands.command(Opcode.FRAME_END)
    vertices = configuration.setup == "hardware"
    if not configuration.list_words or (vertices and fraction_bits is not None):
        return [*dealing, start, *triangles, end]
    clear, draw = (commands.command(opcode) for opcode in (Opcode.CLEAR_LISTS, Opcode.DRAW_LISTS))
    loads = [commands.with_opcode(word, Opcode.LOAD) for word in triangles]
    return [clear, *loads, start, draw, end]


def object_commands(configuration: MachineConfiguration, display_list: DisplayList) -> list[int]:
    """All meshes, after others are forgotten, and a frame of objects."""
    meshes = mesh_words(configuration, made_of_objects(display_list).objects)
    return [commands.command(Opcode.CLEAR_LISTS), *meshes,
            commands.frame_start(display_list.background),
            *frame_words(configuration, display_list), commands.command(Opcode.FRAME_END)]


def _triangle_words(configuration: MachineConfiguration, display_list: DisplayList,
                    fraction_bits: int | None) -> Sequence[int]:
    """A command for each triangle, in the order in which the host sends them."""
    fitting = fitted(configuration, display_list)
    shares = organisation_of(configuration).shares(display_list)
    share = triangle_words.NO_SHARE
    if configuration.node_bits:
        share = {"node": shares.node, "round": shares.round}
    elif configuration.keeps_list_order:  # all elements have them in the list's order
        share = {"round": np.zeros(display_list.triangles, np.int64)}
    if configuration.setup == "hardware" and fraction_bits is None:
        words = triangle_words.triangles(configuration, fitting, share)
        return list(words[shares.host_order])
    own = configuration.fraction_bits
    prepared = prepare(fitting,
                       fraction_bits=own if fraction_bits is None else fraction_bits,
                       shading=configuration.shading,
                       **organisation_of(configuration).resolution.shifts)
    prepared = in_finer_words(prepared, own)
    words = triangle_words.prepared_triangles(configuration, prepared, share)
    return list(words[np.argsort(shares.host_place[prepared.primitive])])


def frame_job(
    configuration: MachineConfiguration,
    display_list: DisplayList,
    *,
    memory_seed: int | None = None,
    stall_seed: int | None = None,
    waveform: Path | None = None,
    fraction_bits: int | None = None,
    table: NDArray[np.int64] | None = None,
) -> Job:
    """Everything an engine needs to run one frame with depths and counters read back."""
    words = [*frame_commands(configuration, display_list, fraction_bits, table=table),
             commands.command(Opcode.READ_DEPTH), commands.command(Opcode.READ_COUNTERS),
             *region_readings(configuration)]
    return Job(
        configuration=configuration,
        commands=words,
        responses=responses_owed(organisation_of(configuration), words),
        memory_seed=memory_seed,
        stall_seed=stall_seed,
        waveform=waveform,
        maximum_cycles=most_frame_clocks(configuration, max(len(words), display_list.triangles)),
    )
