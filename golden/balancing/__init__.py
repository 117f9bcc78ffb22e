"""Which processing element gets which region of the screen, and what it costs."""
