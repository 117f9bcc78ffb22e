"""Experiments whose results stand in docs/; run from a clone, not installed."""
