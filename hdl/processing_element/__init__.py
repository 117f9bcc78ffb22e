"""The processing element: what it is told, its domain, and its parts put together."""
