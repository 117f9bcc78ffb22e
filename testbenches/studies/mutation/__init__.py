"""Programs that are wrong in a single point: how they are made, and how their tests are run."""
