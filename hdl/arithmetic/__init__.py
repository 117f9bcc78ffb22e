"""What several boards compute with: division, multiplication, narrowings, delays."""
