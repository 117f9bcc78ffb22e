"""How many clocks machines take whose processing elements draw regions of the screen."""
