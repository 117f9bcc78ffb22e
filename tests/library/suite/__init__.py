"""What a run of the tests takes of all cases that there are."""
