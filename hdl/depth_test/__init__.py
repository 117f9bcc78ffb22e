"""The Z-buffer comparison of a processing element, for memories of one port and of two."""
