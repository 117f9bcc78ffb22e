"""What a processing element does where regions of the screen are dealt out (Ellsworth 1994)."""
