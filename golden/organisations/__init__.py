"""How cages share the work: who draws what, where each pixel lies, who shows it."""
