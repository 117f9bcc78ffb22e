"""Clocks at the one port of memory units, which reads, writes and the scan share."""
