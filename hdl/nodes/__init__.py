"""Merge cards: what ends a node, has its number, and passes on its share of the triangles."""
