"""What runs between the boards: connectors, words, the ID chain, the response chain."""
