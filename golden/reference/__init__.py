"""What the right picture is: the exact reference and the datapath's bit-true model."""
