"""Nodes that each draw some of the triangles: their pictures, and how one comes of them."""
