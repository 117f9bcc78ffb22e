"""The memory unit: a share of the pixels, its RAM, and the sweep of old tags."""
