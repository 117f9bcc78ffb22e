"""How exact pictures are: error bounds, and scenes against their unquantised selves."""
