"""A cocotb bench for the exported Verilog, to take home (docs/simulate-the-verilog.md).

``frame_run`` is the cocotb test; it runs inside Icarus or Verilator.  The checks beside it
(``stream_check``, ``pin_check``, ``conversation_check``, ``scan_check``) know the documents, not
the simulator.  ``engine`` builds, starts and hears the simulator from outside; people start it as
``cardcage check-verilog``.
"""
