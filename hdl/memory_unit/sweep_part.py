"""The part of a board with pixels that takes old tags out of its memory."""

from amaranth.hdl import *
from amaranth.lib import wiring

from .memory_access import part_answer
from .tag_sweep import TagSweep
from .word_parts import Part

__all__ = ["add_sweep"]

#: Address bits that tell whether a write may go to the word that is swept: a false alarm in 16.
COMPARED_BITS = 4


def add_sweep(m: Module, unit: wiring.PureInterface, *, words: int, parts: tuple[Part, ...],
              current: Value) -> None:
    """Put a ``TagSweep`` into ``m``, the module of ``unit``, a board with ``memory`` and
    ``pictures``; ``current``: the parts of the word just read that are of this frame."""
    m.submodules.tag_sweep = sweep = TagSweep(words=words, parts=len(parts))
    access, pictures = unit.memory.access, unit.pictures
    m.d.comb += [
        sweep.start.eq(pictures.sweep),
        sweep.initialise.eq(pictures.initialise),
        pictures.swept.eq(sweep.idle),
        access.sweep.eq(sweep.sweep),
        access.erase.eq(sweep.erase),
        access.sweep_address.eq(sweep.address),
        sweep.busy.eq(access.sweep_busy),
        sweep.scan.eq(access.scan),
        sweep.stale.eq(Cat(part_answer(access, part).tag.any() for part in parts) & ~current),
    ]
    near = (access.write_address ^ sweep.address)[:COMPARED_BITS] == 0
    m.d.comb += sweep.overwritten.eq(access.write & ~access.write_busy & near)
