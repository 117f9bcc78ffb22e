"""Triangle set-up in hardware: from vertices to edges and interpolants."""
