"""Which pixel belongs to whom, as each board computes it from what the backplane says."""
