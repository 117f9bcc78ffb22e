"""Figures that the atlas fits to."""
