"""PLY: its header, the rows of its elements, and the mesh that they make."""
