"""Nodes that merge on a bus that all of them hear, and the frame units that are scanned."""
