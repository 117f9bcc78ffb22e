"""glTF 2.0: its document and buffers, its accessors, its nodes, and the mesh that they make."""
