"""Experiments with objects of which the machine makes triangles."""
