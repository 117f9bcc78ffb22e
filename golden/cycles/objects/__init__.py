"""How long a machine takes that makes the triangles of objects itself."""
