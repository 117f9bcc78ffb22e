"""Nodes that each draw some of the triangles: which words of their pictures are drawn, and which of
two stays."""
