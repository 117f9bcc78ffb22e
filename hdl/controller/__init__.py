"""The central broadcast controller: boots the cage, announces triangles, swaps pictures."""
