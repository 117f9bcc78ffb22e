"""Runs a tool of YoWASP, which is WebAssembly, with more stack than it has by itself.

Yosys visits the logic of a module from gate to gate, one call within another.  Of a crossbar for
sixteen elements that is deeper than the stack of 2 MB that there is without this.  The part of its
stack that yosys keeps in its own memory stays as it is: some 1,500 gates one behind another.

A program of its own: ``deep_stack.py PACKAGE FUNCTION ARGUMENT ...``, with the tool's exit status.
"""

import importlib
import sys
import threading
from typing import Any

#: Bytes; only what is used of them is taken.
STACK = 256 << 20
#: Of the thread, which holds more than that.
THREAD = STACK + (16 << 20)


def deepen() -> None:
    """All machines of ``wasmtime`` made from now on have ``STACK``; where its version does not
    know how, they are as they were."""
    wasmtime: Any = importlib.import_module("wasmtime")
    # The one limit may not be above the other, which only the bindings of wasmtime can change.
    bindings = importlib.import_module("wasmtime._bindings")
    allow = getattr(bindings, "wasmtime_config_async_stack_size_set", None)
    plain = wasmtime.Config

    def deeper() -> Any:
        config = plain()
        if allow is not None:
            allow(config.ptr(), STACK)
            config.max_wasm_stack = STACK
        return config

    wasmtime.Config = deeper
    threading.stack_size(THREAD)


def main() -> None:
    package, function, *arguments = sys.argv[1:]
    deepen()
    sys.exit(getattr(importlib.import_module(package), function)(arguments))


if __name__ == "__main__":
    main()
