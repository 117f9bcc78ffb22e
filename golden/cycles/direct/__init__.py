"""Clocks of a cage whose processing elements have no pixels: a simulation of its queues."""
