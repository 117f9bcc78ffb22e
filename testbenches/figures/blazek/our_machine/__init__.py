"""Our machines: the same scenes with the same decompositions, in clocks."""
