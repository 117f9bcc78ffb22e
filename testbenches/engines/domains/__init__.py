"""Models of cages with many equal domains: what is equal is translated and compiled once."""
