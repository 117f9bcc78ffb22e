"""Which assignment of the triangles to the nodes makes a frame shortest."""
