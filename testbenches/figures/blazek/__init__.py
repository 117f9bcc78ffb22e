"""Figures 12 to 19 of Blazek (1991), redrawn for his machine and for ours."""
