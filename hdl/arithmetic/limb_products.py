"""Wide numbers times short counts, by an FPGA's multipliers."""

from collections.abc import Sequence

from amaranth.hdl import *

from .delay import delayed

__all__ = ["LIMB_BITS", "limb_products", "side_by_side"]

#: Operand bits of a multiplier block of an FPGA (MULT18X18D of the ECP5).
LIMB_BITS = 18


def limb_products(m: Module, factor: Value, count: Value, *, advance, name: str) -> list[Value]:
    """``factor`` · ``count`` limb by limb, lowest first, from multipliers that end in registers.

    The products belong ``LIMB_BITS`` apart; of the last one only bits inside ``factor`` are kept.
    """
    return [delayed(m, (factor[offset:offset + LIMB_BITS] * count)[:len(factor) - offset], 1,
                    f"{name}_{offset}", enable=advance)
            for offset in range(0, len(factor), LIMB_BITS)]


def side_by_side(limbs: Sequence[Value]) -> list[Value]:
    """The limbs in their places, in one word for the even ones and one for the odd ones.

    None may be longer than two places, so those of a word do not overlap: there are as few words
    left to add.
    """
    words = []
    for first in (0, 1):
        parts = []
        place = 0
        for number, limb in list(enumerate(limbs))[first::2]:
            offset = number * LIMB_BITS
            assert len(limb) <= 2 * LIMB_BITS
            parts += [Const(0, offset - place), limb]
            place = offset + len(limb)
        if parts:
            words.append(Cat(*parts))
    return words
