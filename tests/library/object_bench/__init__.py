"""What tests of machines that take objects share."""
