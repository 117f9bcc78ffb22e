"""The machine as a compiled model's main program drives it: a register before each input.

Verilator evaluates the logic behind a model's inputs whenever it evaluates anything, at both
edges of the clock, for it cannot know what its caller has changed.  Behind registers there is
none: 16x(PMM) takes a tenth fewer instructions a clock.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ...golden.specification.activity import ACTIVITY_BITS
from ...golden.specification.commands import (
    RESPONSE_KIND_BITS,
    RESPONSE_VALUE_BITS,
    WORD_BITS,
    command_words,
)
from ...golden.specification.configuration import MachineConfiguration

#: Of the wrapper's module, and of the class that Verilator makes of it.
TOP = "model"

_RESPONSE_BITS = RESPONSE_KIND_BITS + RESPONSE_VALUE_BITS

_OUTPUTS = {"commands__ready": 1, "responses__valid": 1, "responses__payload": _RESPONSE_BITS,
            "pins__pixel": 1, "pins__active": 1, "pins__vertical_sync": 1,
            "pins__red": 8, "pins__green": 8, "pins__blue": 8}


def model_wrapper(configuration: MachineConfiguration) -> str:
    """The Verilog module ``model``: ``machine`` with its ports, and registers.

    Before the first clock edge a register has what its input has when the model is evaluated
    first.  ``activity`` is there for every machine, 0 for one that is not observed.
    """
    inputs = _inputs(configuration)
    return _module(configuration, {name: f"{name}_now" for name in inputs}, {}, [
        line for name, width in inputs.items() for line in (
            f"  reg [{width - 1}:0] {name}_now;", f"  initial {name}_now = {name};",
            f"  always @(posedge clk) {name}_now <= {name};")])


def shell_wrapper(configuration: MachineConfiguration, more: Mapping[str, str]) -> str:
    """The same for a machine that holds no state: without registers, but with the ports ``more``,
    declarations by name."""
    return _module(configuration, {name: name for name in _inputs(configuration)}, more, [])


def _inputs(configuration: MachineConfiguration) -> dict[str, int]:
    return {"rst": 1, "commands__valid": 1, "responses__ready": 1,
            "commands__payload": WORD_BITS * command_words(configuration)}


def _module(configuration: MachineConfiguration, inputs: Mapping[str, str],
            more: Mapping[str, str], body: Iterable[str]) -> str:
    """``inputs``: what each input of the machine is connected to."""
    elements = _observed(configuration)
    wired = _OUTPUTS | ({"activity": ACTIVITY_BITS * elements} if elements else {})
    outputs = {"activity": 1} | wired
    return "\n".join([
        f"module {TOP}(", ",\n".join([
            "  input clk",
            *(f"  input [{width - 1}:0] {name}"
              for name, width in _inputs(configuration).items()),
            *(f"  output [{width - 1}:0] {name}" for name, width in outputs.items()),
            *(f"  {declaration}" for declaration in more.values())]), ");",
        *body, *(f"  assign {name} = 0;" for name in outputs if name not in wired),
        "  machine machine(", ",\n".join([
            "    .clk(clk)", *(f"    .{name}({signal})" for name, signal in inputs.items()),
            *(f"    .{name}({name})" for name in (*wired, *more))]), "  );", "endmodule"]) + "\n"


def machine_numbers(configuration: MachineConfiguration) -> str:
    """The header with the machine's ``MachineNumbers``, in their order."""
    numbers = (command_words(configuration), configuration.width, configuration.height,
               int(configuration.timing.vertical_sync_positive), _observed(configuration))
    return f"constexpr MachineNumbers NUMBERS{{{', '.join(map(str, numbers))}}};\n"


def _observed(configuration: MachineConfiguration) -> int:
    return configuration.processing_elements if configuration.observe else 0
