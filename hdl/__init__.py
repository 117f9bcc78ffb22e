"""What the machine is: the cards of the cage, in Amaranth."""
