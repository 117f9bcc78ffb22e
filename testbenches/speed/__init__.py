"""Clocks of cases on machines, measured, predicted and beside the peers."""
