"""A frame through a simulated machine: the job, its responses, the comparison with golden."""
