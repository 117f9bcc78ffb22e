"""A cocotb bench for the exported Verilog, to take home (docs/simulate-the-verilog.md).

``bench`` is the cocotb test; it runs inside Icarus or Verilator.  The checks beside it
(``stream_check``, ``pin_check``, ``conversation_check``, ``scan_check``) know the documents, not
the simulator.  ``engine`` builds, starts and hears the simulator from outside; ``__main__`` is the
command ``python -m cardcage.testbenches.cocotb_bench``.
"""
