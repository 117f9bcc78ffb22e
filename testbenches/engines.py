"""The simulation engines by name."""

from __future__ import annotations

from ..golden.errors import InputError
from .engine import Engine

#: Takes the first of ``ENGINES``: the fastest there is.
AUTO = "auto"


def _pysim() -> Engine:
    from .pysim_engine import PysimEngine  # loads Amaranth: only those who simulate wait for it

    return PysimEngine()


#: What makes each engine, the default first.
ENGINES = {"pysim": _pysim}


def make_engine(name: str = AUTO) -> Engine:
    """The engine of that name; ``InputError`` for an unknown one."""
    if name == AUTO:
        name = next(iter(ENGINES))
    if name not in ENGINES:
        raise InputError(f"engine: {name!r} is none of {', '.join([AUTO, *ENGINES])}")
    return ENGINES[name]()
