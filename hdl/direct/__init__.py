"""The direct merge: every fragment to the memory unit that has its pixel, whoever drew it."""
