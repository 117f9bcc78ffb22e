"""Reports of a frame: pages, charts, pictures."""
