"""From a prepared triangle to fragments: rows, spans, pixels, depth and colour."""
