"""Many points, on all cores or many machines, each kept as it is found."""
