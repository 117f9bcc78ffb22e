"""Mesh files: one reader per format, and what they share."""
