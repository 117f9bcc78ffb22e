"""Built-in scenes, each written from its public definition."""
