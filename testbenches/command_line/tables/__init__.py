"""What commands print: tables on a terminal, aligned lines and JSON elsewhere."""
