"""Figures and tables of the papers, redrawn for our scenes and machines."""
