"""What machine and golden models have to agree on: all of ``golden`` that ``hdl`` imports."""
