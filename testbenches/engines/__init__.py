"""How the machine is simulated: engines by name, and what they record."""
