"""Objects that processing elements pass on to those who have regions that the objects meet."""
