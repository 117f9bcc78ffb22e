"""The machine as files for other people's tools: Verilog, its description, lint rules."""
