"""Fields of a configuration that belong together: what is checked of them, and what follows."""
