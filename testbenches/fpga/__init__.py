"""Boards on a Lattice ECP5: synthesis, place and route, area and clock rate."""
