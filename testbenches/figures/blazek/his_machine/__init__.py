"""His machine: an event model of the iPSC/2's host and nodes, and what each method takes on it."""
