"""What every command needs: whole output or none, caches, interruption, text tables."""
