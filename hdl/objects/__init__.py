"""Triangles made of objects, which are meshes that the machine keeps, moved and coloured."""
