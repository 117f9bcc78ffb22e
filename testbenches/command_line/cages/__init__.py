"""Commands that set several cages side by side."""
