"""Simulators, drivers, monitors, comparison, reports and the command line."""
