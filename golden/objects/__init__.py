"""Objects of which the machine makes triangles: what a host says, and what is made where."""
