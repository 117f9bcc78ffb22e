"""The video scan generator."""
