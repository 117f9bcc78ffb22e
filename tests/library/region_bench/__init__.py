"""What tests of machines that deal regions out share."""
