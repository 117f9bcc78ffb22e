"""Narrowings by name, as ``golden.specification.fixed_point`` has them; each gives an Amaranth
expression.

Formats are plain ``Value`` shapes: integer bits above, ``fraction_bits`` below.
"""

from amaranth.hdl import *

__all__ = ["floor_shift", "saturate", "to_signed", "wrap"]


def wrap(value: Value, bits: int) -> Value:
    """``value`` modulo ``2**bits``."""
    value = Value.cast(value)
    return value[:bits] if len(value) >= bits else Cat(value, value[-1].replicate(bits - len(value))
                                                       if value.shape().signed
                                                       else Const(0, bits - len(value)))


def to_signed(value: Value, bits: int) -> Value:
    """The low ``bits`` bits read as two's complement."""
    return wrap(value, bits).as_signed()


def floor_shift(value: Value, fraction_bits: int) -> Value:
    """floor(value / 2**fraction_bits): the fraction bits are dropped."""
    return value >> fraction_bits


def saturate(value: Value, low: int, high: int) -> Value:
    """``value`` held to ``[low, high]``, both ends included; ``low`` is not negative, and the
    result unsigned and just wide enough for ``high``."""
    # Either end is what is held to it: < or <=, > or >= are the same.
    width = len(Const(high))
    return Mux(value < low, Const(low, width), Mux(value > high, Const(high, width), value))[:width]
