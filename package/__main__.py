"""``python -m cardcage`` is the command line."""

from __future__ import annotations

from .testbenches.command_line.cli import main

if __name__ == "__main__":
    main(prog_name="cardcage")
