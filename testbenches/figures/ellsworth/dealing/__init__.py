"""How evenly regions are dealt out, frame by frame of a model that turns."""
