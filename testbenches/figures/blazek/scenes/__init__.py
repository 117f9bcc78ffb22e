"""Spheres of one size at random places, and what of each lies in which part of the screen."""
