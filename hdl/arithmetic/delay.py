"""Values that keep pace with a pipeline beside them."""

from amaranth.hdl import *

__all__ = ["delayed"]


def delayed(m: Module, value, clocks: int, name: str, *, reset_less: bool = True, enable=1):
    """``value`` as it was ``clocks`` clocks ago, through registers ``name_1``, ``name_2``, …

    Only clocks in which ``enable`` is high count.  What says whether other values count has to
    be reset: ``reset_less=False``.
    """
    for clock in range(clocks):
        register = Signal.like(value, name=f"{name}_{clock + 1}", reset_less=reset_less)
        with m.If(enable):
            m.d.sync += register.eq(value)
        value = register
    return value
