"""The hard cases: small display lists that naive rasterisers draw wrong, with what is right."""
