"""Scene files: a scene in words, a definition a line (Blazek 1991, figure 9)."""
