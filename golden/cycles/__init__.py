"""How many clocks a machine takes, by model instead of simulation."""
