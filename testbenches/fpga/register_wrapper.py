"""Registers around a component, so that each of its paths begins and ends in one on the chip."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

#: Names of the modules.
BENCH = "bench"
RAM_PORTS = "ram_ports"

_BENCH = """
// {top} between registers: inputs are shifted in, outputs are folded into a shifted word.
module {bench}(input clk, input rst, input serial_in, output serial_out);
  reg [{input_top}:0] inputs;
  reg [{output_top}:0] held, folded;
  reg reset;
  wire [{output_top}:0] outputs;
  always @(posedge clk) begin
    inputs <= {{inputs, serial_in}};
    reset <= rst;
    held <= outputs;
    folded <= held ^ {{folded, 1'b0}};
  end
  assign serial_out = folded[{output_top}];
  {top} dut(.clk(clk), .rst(reset){connections});
endmodule
"""

#: Registers in the place of a RAM that is not on the chip (``outside_ram``): whatever goes into it
#: ends in a register, what it reads comes from one.  A hierarchy of its own, since a register that
#: holds what another does would otherwise be left out.
RAM_PORTS_VERILOG = f"""
(* keep_hierarchy *)
module {RAM_PORTS} #(parameter INPUTS = 1, parameter DATA = 1) (
  input clk,
  input [INPUTS-1:0] inputs,
  output reg [DATA-1:0] data
);
  reg [INPUTS-1:0] held, folded;
  always @(posedge clk) begin
    held <= inputs;
    folded <= held ^ {{folded, 1'b0}};
    data <= folded[INPUTS-1 -: DATA];
  end
endmodule
"""


def bench_verilog(name: str, ports: Sequence[Any]) -> str:
    """A module ``BENCH`` around the module ``name``, whose ports besides ``clk`` and ``rst`` are
    ``ports`` (``testbenches.export.verilog.Port``)."""
    places = {"input": 0, "output": 0}
    connections = []
    for port in ports:
        # Escaped, since a name may be one of Verilog's own words.
        connections.append(f", .\\{port.name} ({port.direction}s[{places[port.direction]}+:"
                           f"{port.width}])")
        places[port.direction] += port.width
    return _BENCH.format(top=name, bench=BENCH, input_top=places["input"] - 1,
                         output_top=places["output"] - 1, connections="".join(connections))
