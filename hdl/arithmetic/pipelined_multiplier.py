"""Sums of wide products from the multipliers of an FPGA, a register behind every level."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from .limb_products import LIMB_BITS

__all__ = ["PipelinedMultiplier"]


def _limbs(bits):
    """Number of limbs of a signed number: all but the highest give up a bit for their sign, 0."""
    return max(1, -(-(bits - 1) // (LIMB_BITS - 1)))


class PipelinedMultiplier(wiring.Component):
    """a[0] · b[0] + a[1] · b[1] + …, of signed numbers.

    Each operand is cut into limbs that fit a multiplier block of an FPGA (``LIMB_BITS``);
    operands and products end in registers, and so does each level of the adders that put the
    products together.

    Latency: ``latency`` clocks.  Throughput: a sum a clock; nothing stalls.

    Parameters
    ----------
    a_bits, b_bits: int, positive
        Widths of the factors.
    pairs: int, positive
        Products in the sum.

    Members
    -------
    a: In(signed(a_bits)), b: In(signed(b_bits))
        Arrays of ``pairs`` factors.
    sum: Out(signed(sum_bits))
        The sum of the products.
    """

    def __init__(self, *, a_bits: int, b_bits: int, pairs: int = 1):
        for name, value in (("a_bits", a_bits), ("b_bits", b_bits), ("pairs", pairs)):
            if value < 1:
                raise ValueError(f"{name} must be positive, not {value}")
        self.a_bits = a_bits
        self.b_bits = b_bits
        self.pairs = pairs
        super().__init__({
            "a": In(signed(a_bits)).array(pairs),
            "b": In(signed(b_bits)).array(pairs),
            "sum": Out(signed(self.sum_bits)),
        })

    @property
    def sum_bits(self) -> int:
        """Enough for every sum."""
        return self.a_bits + self.b_bits + (self.pairs - 1).bit_length()

    @property
    def multipliers(self) -> int:
        """Multiplier blocks it takes."""
        return self.pairs * _limbs(self.a_bits) * _limbs(self.b_bits)

    @property
    def latency(self) -> int:
        """Clocks from the factors to their sum: operands, products, levels of adders."""
        return 2 + (self.multipliers - 1).bit_length()

    def elaborate(self, platform):
        m = Module()
        addends = []
        for pair in range(self.pairs):
            a = self._cut(m, self.a[pair], f"a_{pair}")
            b = self._cut(m, self.b[pair], f"b_{pair}")
            for i, (a_limb, a_offset) in enumerate(a):
                for j, (b_limb, b_offset) in enumerate(b):
                    product = Signal((a_limb * b_limb).shape(), name=f"product_{pair}_{i}_{j}",
                                     reset_less=True)
                    m.d.sync += product.eq(a_limb * b_limb)
                    addends.append(product.shift_left(a_offset + b_offset))
        level = 0
        while len(addends) > 1:
            level += 1
            sums = []
            for place in range(0, len(addends), 2):
                total = sum(addends[place + 1:place + 2], addends[place])
                register = Signal(total.shape(), name=f"sum_{level}_{place // 2}", reset_less=True)
                m.d.sync += register.eq(total)
                sums.append(register)
            addends = sums
        m.d.comb += self.sum.eq(addends[0])
        return m

    def _cut(self, m, factor, name):
        """Registers for the limbs of a factor, least significant first, and their offsets."""
        step = LIMB_BITS - 1
        limbs = []
        for limb in range(_limbs(len(factor))):
            part = factor[limb * step:(limb + 1) * step]  # without sign: a zero goes above it
            if limb == _limbs(len(factor)) - 1:
                part = factor[limb * step:].as_signed()
            register = Signal(signed(min(LIMB_BITS, len(part) + (not part.shape().signed))),
                              name=f"{name}_limb_{limb}", reset_less=True)
            m.d.sync += register.eq(part)
            limbs.append((register, limb * step))
        return limbs
