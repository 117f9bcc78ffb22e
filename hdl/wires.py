"""Connections in modules of their own."""

from amaranth.hdl import *

__all__ = ["wires"]


def wires(m: Module, name: str) -> Module:
    """A new submodule ``name`` of ``m`` that holds nothing but connections.

    A simulator evaluates a module's combinational logic as a whole whenever one
    of its inputs changes; connections that change at different times simulate
    several times faster apart.
    """
    part = Module()
    m.submodules[name] = part
    return part
